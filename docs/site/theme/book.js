// Of every page: formulas, tables that scroll by themselves, the menu of narrow windows, search. Nothing is asked of the network.
"use strict";
(() => {
  const root = document.currentScript ? document.currentScript.dataset.root : ".";
  const article = document.querySelector("article"), found = document.getElementById("found");

  for (const code of document.querySelectorAll("pre > code.language-math")) {
    const pre = code.parentElement;
    pre.classList.add("math");
    if (window.katex) window.katex.render(code.textContent, pre, { displayMode: true, throwOnError: false });
  }
  for (const table of document.querySelectorAll("article table")) {
    const frame = document.createElement("div");
    frame.className = "table";
    table.replaceWith(frame);
    frame.append(table);
  }

  const menu = document.getElementById("menu"), list = document.getElementById("list");
  menu.addEventListener("click", () => menu.setAttribute("aria-expanded", list.classList.toggle("open")));
  const here = list.querySelector("[aria-current]");
  if (here && here.offsetTop > window.innerHeight) here.scrollIntoView({ block: "center" });

  // ---- search: every section of every page that has all words, those with the words in their title first
  const field = document.getElementById("search");
  let pages = null;
  window.weir_pages = (index) => {
    pages = index.docs.map((d) => ({ to: d.location, title: d.title, text: d.text.replace(/\s+/g, " "), low: `${d.title} ${d.text}`.toLowerCase() }));
    const titles = new Map(pages.map((p) => [p.to, p.title]));
    for (const p of pages) if (p.to.includes("#") && titles.get(page_of(p)) !== p.title) p.page = titles.get(page_of(p));
    show();
  };
  const page_of = (p) => p.to.split("#")[0];
  const load = () => {
    if (pages || document.getElementById("index")) return;
    const script = document.createElement("script");
    script.id = "index";
    script.src = `${root}/search/index.js`;
    document.head.append(script);
  };
  const count = (text, word) => text.split(word).length - 1;
  const rank = (page, words) => {
    const title = page.title.toLowerCase();
    let sum = page.to.startsWith("files/") ? -5 : 0;
    for (const w of words) sum += (title.includes(w) ? 20 : 0) + (title.split(/[^\w]+/).includes(w) ? 20 : 0) + Math.min(5, count(page.low, w));
    return sum;
  };
  const marked = (text, words) => {
    const parts = document.createElement("span");
    const pattern = new RegExp(words.map((w) => w.replace(/[.*+?^${}()|[\]\\]/g, "\\$&")).join("|"), "gi");
    let at = 0;
    for (const hit of text.matchAll(pattern)) {
      parts.append(text.slice(at, hit.index));
      const mark = document.createElement("mark");
      mark.textContent = hit[0];
      parts.append(mark);
      at = hit.index + hit[0].length;
    }
    parts.append(text.slice(at));
    return parts;
  };
  const around = (page, words) => {
    const at = Math.max(0, page.text.toLowerCase().indexOf(words[0]) - 60);
    return (at > 0 ? "… " : "") + page.text.slice(at, at + 220) + (page.text.length > at + 220 ? " …" : "");
  };
  function show() {
    const words = field.value.toLowerCase().split(/\s+/).filter((w) => w.length > 1);
    found.hidden = words.length === 0;
    article.hidden = words.length > 0;
    if (words.length === 0 || !pages) return;
    const all = pages.filter((p) => words.every((w) => p.low.includes(w)));
    const sections = new Set(all.filter((p) => p.to.includes("#")).map(page_of));  // a page is named by its sections, where those say it
    const hits = all.filter((p) => p.to.includes("#") || !sections.has(p.to)).map((p) => [rank(p, words), p]).sort((a, b) => b[0] - a[0]).slice(0, 30);
    const ol = document.createElement("ol");
    for (const [, page] of hits) {
      const item = document.createElement("li"), a = document.createElement("a"), p = document.createElement("p");
      a.href = `${root}/${page.to}`;
      a.append(marked(page.page ? `${page.page} · ${page.title}` : page.title, words));
      p.append(marked(around(page, words), words));
      item.append(a, p);
      ol.append(item);
    }
    const head = document.createElement("h1");
    head.textContent = hits.length === 0 ? "Nothing is found" : `${hits.length === 30 ? "The first 30" : hits.length} found`;
    found.replaceChildren(head, ol);
  }
  field.addEventListener("focus", load);
  field.addEventListener("input", () => { load(); show(); });
  found.addEventListener("click", (e) => { if (e.target.closest("a")) field.value = "", show(); });
  field.addEventListener("keydown", (e) => { if (e.key === "Escape") field.value = "", show(); });
  const asked = new URLSearchParams(location.search).get("q");
  if (asked) field.value = asked, load(), show();
})();
