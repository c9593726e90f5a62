"""The book as one static site: python3 make.py FOLDER [--pages-only]

Gathers the pages of docs/ into FOLDER/source/pages, puts what comes from results/ in its place (between the marks `<!-- from results: NAME -->`
and `<!-- end -->`), copies the pictures, mathematics and files that pages point to, and lets mkdocs write FOLDER/site. The site
asks the network for nothing and opens from a disk.
"""
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys

here = pathlib.Path(__file__).resolve().parent
root = here.parents[1]
katex = pathlib.Path("/usr/share/javascript/katex")
link = re.compile(r"(!?)\[((?:[^\[\]]|\[[^\[\]]*\])*)\]\(([^()\s]+)\)")
code = re.compile(r"^```.*?^```[ \t]*$|`(?:[^`\n]|\n(?!\n))*`", re.M | re.S)
marked = re.compile(r"(<!-- from results: (\w+) -->\n).*?(<!-- end -->)", re.S)


# ---- what comes from results/

def cell(text):
    return str(text).replace("|", "\\|").replace("\n", " ")


def choosing(results):
    """Every published study of cost: its question, what to take, the settings that no other beats."""
    text = []
    for path in sorted((results / "cost/json").glob("*.json")):
        study = json.loads(path.read_text())
        text += [f"### {study['study']}", "", study["question"], "", f"![{study['error']} against time](../../results/cost/svg/{study['study']}.svg)", ""]
        text += [f"- {line}" for line in study["advice"]]
        front = [p for p in study["points"] if p["front"]]
        text += ["", "No other setting is both cheaper and more accurate than one of these:", "",
                 f"| setting | {study['error']} | {price(study)} | ms a step | MB |", "|---|---|---|---|---|"]
        text += [f"| {cell(p['name'])} | {p['error']:.4g} | {p['seconds_per_second']:.4g} | {p['ms_per_step']:.4g} | {p['bytes'] / 1e6:.3g} |" for p in front]
        text += ["", f"{study['machine']}, {study['threads']} thread(s), {study['size']} size, commit {study['commit']}."]
        if study["source"]:
            text[-1] += f" Compared with: {study['source']}."
        text += [""]
    return "\n".join(text)


def price(study):
    return "s a step" if study["price"] == "step" else "s per simulated s"


def limits(results):
    """Every published limit, solver by solver: a row for each thing that is pushed, with the methods that end alike together."""
    rows = {}
    for path in sorted((results / "stability").glob("*.json")):
        study = json.loads(path.read_text())
        for limit in study["limits"]:
            axis = (study["study"], limit["axis"], limit["hard_because"])
            ends = rows.setdefault(limit["solver"], {}).setdefault(limit["kind"], {}).setdefault(axis, {})
            ends.setdefault((last_good(limit), limit["broke"]), []).append(limit["method"])
    text = []
    for solver in sorted(rows):
        text += [f"### {solver}", ""]
        for kind, title in (("limit", "Pushed until something breaks"), ("guard", "A guard takes over, or refuses"), ("units", "The same scene in other units")):
            if kind not in rows[solver]:
                continue
            text += [f"**{title}**", "", "| what is pushed | last good | what broke first |", "|---|---|---|"]
            for (study, axis, why), ends in rows[solver][kind].items():
                what = f"**{cell(axis)}** ({study}): {cell(why)}"
                for (last, broke), methods in ends.items():
                    name = ", ".join(cell(m) for m in methods if m) + ": " if any(methods) else ""
                    text += [f"| {what} | {name}{cell(last)} | {cell(broke)} |"]
                    what = ""
            text += [""]
    return "\n".join(text)


def last_good(limit):
    more = [f"theory {limit['theory']:g}"] if limit.get("theory") else []
    more += [f"tests hold {limit['floor']:g}"] if limit["guarded"] else []
    return limit["last_stable_text"] + (f" ({', '.join(more)})" if more else "")


made = {"choosing": choosing, "limits": limits}


def with_results(text, results):
    def write(match):
        return match[1] + "\n" + made[match[2]](results) + "\n" + match[3]
    return marked.sub(write, text)


# ---- the pages

class Pages:
    """The pages of docs/ and what they point to, copied so that every link stays inside the site."""

    def __init__(self, into):
        self.into = into
        self.more = {}  # files outside docs/ that pages of the book show, by their place in the site

    def write(self):
        for source in sorted((root / "docs").rglob("*")):
            inside = source.relative_to(root / "docs")
            if source.is_dir() or inside.parts[0] in ("site", "example"):
                continue
            target = self.into / inside
            target.parent.mkdir(parents=True, exist_ok=True)
            if source.suffix == ".md":
                target.write_text(self.page(source, target, follow=True))
            else:
                shutil.copyfile(source, target)
        while self.more:
            place, source = self.more.popitem()
            if place.exists():
                continue
            place.parent.mkdir(parents=True, exist_ok=True)
            place.write_text(self.page(source, place, follow=False) if source.suffix == ".md" else listing(source))

    def page(self, source, target, follow):
        text = with_results(source.read_text(), root / "results")
        parts, at = [], 0
        for block in code.finditer(text):  # what stands in code is no link
            parts += [self.links(text[at:block.start()], source, target, follow), block[0]]
            at = block.end()
        return "".join(parts + [self.links(text[at:], source, target, follow)])

    def links(self, text, source, target, follow):
        def place(match):
            mark, label, to = match[1], match[2], match[3]
            path, _, anchor = to.partition("#")
            if "://" in to or not path:
                return match[0]
            file = (source.parent / path).resolve()
            if not file.exists():
                raise SystemExit(f"{source.relative_to(root)}: there is no {to}")
            moved = self.moved(file, mark == "!", follow)
            if moved is None:
                return label if mark else f"{label} (`{file.relative_to(root)}`)"
            where = pathlib.PurePath(os.path.relpath(moved, target.parent))
            keep = f"#{anchor}" if anchor and where.suffix == ".md" else ""
            return f"{mark}[{label}]({where}{keep})"
        return link.sub(place, text)

    def moved(self, file, is_picture, follow):
        """Where the site has a file; None: nowhere."""
        inside = file.relative_to(root)
        if inside.parts[:1] == ("docs",) and inside.parts[1:2] not in (("example",), ("site",)):
            return self.into / pathlib.PurePath(*inside.parts[1:])
        if is_picture or inside == pathlib.PurePath("results/index.html"):
            place = self.into / inside
            place.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(file, place)
            return place
        if inside.parts[0] == "results":  # its pages are one file, which has everything
            return self.moved(root / "results/index.html", False, follow)
        if not follow or file.is_dir():
            return None
        place = self.into / "files" / (inside if file.suffix == ".md" else pathlib.PurePath(f"{inside}.md"))
        self.more[place] = file
        return place


def listing(source):
    return f"# {source.relative_to(root)}\n```text\n{source.read_text()}\n```\n"


def make(folder):
    source = folder / "source"
    shutil.rmtree(source, ignore_errors=True)
    (source / "pages").mkdir(parents=True)
    Pages(source / "pages").write()
    for name in ("mkdocs.yml", "hook.py"):
        shutil.copyfile(here / name, source / name)
    shutil.copytree(here / "theme", source / "theme")
    if katex.exists():
        math = source / "theme/katex"
        math.mkdir()
        for name in ("katex.min.css", "katex.min.js"):
            shutil.copyfile(katex / name, math / name)
        shutil.copytree(katex / "fonts", math / "fonts", ignore=lambda _, names: [n for n in names if not n.endswith(".woff2")])
    else:
        print("no libjs-katex here: formulas stay as they are written", file=sys.stderr)
    return source


def main():
    folder = pathlib.Path(sys.argv[1]).resolve()
    source = make(folder)
    if "--pages-only" not in sys.argv:
        subprocess.run(["mkdocs", "build", "--quiet", "--strict", "--config-file", source / "mkdocs.yml", "--site-dir", folder / "site"], check=True)
        print(f"open {folder}/site/index.html")


if __name__ == "__main__":
    main()
