"""The book as one static site: python3 make.py FOLDER [--pages-only]

Copies the pages of docs/ into FOLDER/source/pages. Inserts the tables from results/ between the marks `<!-- from results: NAME -->` and
`<!-- end -->`. Copies the pictures, KaTeX and the files to which pages link. mkdocs then writes FOLDER/site. The site opens from disk and needs no network.
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


# ---- tables from results/

def cell(text):
    return str(text).replace("|", "\\|").replace("\n", " ")


def choosing(results):
    """Every published cost study: its question, the recommendation, the configurations of the Pareto front."""
    text = []
    for path in sorted((results / "cost/json").glob("*.json")):
        study = json.loads(path.read_text())
        text += [f"### {study['study']}", "", study["question"], "", f"![{study['error']} against time](../../results/cost/svg/{study['study']}.svg)", ""]
        text += [f"- {line}" for line in study["advice"]]
        front = [p for p in study["points"] if p["front"]]
        text += ["", "No other setting is both cheaper and more accurate than one of these:", "",
                 f"| configuration | {study['error']} | {price(study)} | ms per step | MB |", "|---|---|---|---|---|"]
        text += [f"| {cell(p['name'])} | {p['error']:.4g} | {p['seconds_per_second']:.4g} | {p['ms_per_step']:.4g} | {p['bytes'] / 1e6:.3g} |" for p in front]
        text += ["", f"{study['machine']}, {study['threads']} thread(s), {study['size']} size, commit {study['commit']}."]
        if study["source"]:
            text[-1] += f" Compared with: {study['source']}."
        text += [""]
    return "\n".join(text)


def price(study):
    return "s per step" if study["price"] == "step" else "s per simulated s"


def limits(results):
    """Every published limit by solver: one row per axis; methods with the same limit share a row."""
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
        for kind, title in (("limit", "Raised until an invariant fails"), ("guard", "Guards: a substitute method, or a refusal"), ("units", "The same scene in other units")):
            if kind not in rows[solver]:
                continue
            text += [f"**{title}**", "", "| axis | last stable value | first failure |", "|---|---|---|"]
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
    more += [f"tests guarantee {limit['floor']:g}"] if limit["guarded"] else []
    return limit["last_stable_text"] + (f" ({', '.join(more)})" if more else "")


made = {"choosing": choosing, "limits": limits}


def with_results(text, results):
    def write(match):
        return match[1] + "\n" + made[match[2]](results) + "\n" + match[3]
    return marked.sub(write, text)


# ---- the pages

class Pages:
    """The pages of docs/ and the files to which they link, copied so that every link stays inside the site."""

    def __init__(self, into):
        self.into = into
        self.more = {}  # files outside docs/ to which pages link, by their path in the site

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
        for block in code.finditer(text):  # no links in code
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
                raise SystemExit(f"{source.relative_to(root)}: link to a missing file: {to}")
            moved = self.moved(file, mark == "!", follow)
            if moved is None:
                return label if mark else f"{label} (`{file.relative_to(root)}`)"
            where = pathlib.PurePath(os.path.relpath(moved, target.parent))
            keep = f"#{anchor}" if anchor and where.suffix == ".md" else ""
            return f"{mark}[{label}]({where}{keep})"
        return link.sub(place, text)

    def moved(self, file, is_picture, follow):
        """The path of a file in the site; None: it is not in the site."""
        inside = file.relative_to(root)
        if inside.parts[:1] == ("docs",) and inside.parts[1:2] not in (("example",), ("site",)):
            return self.into / pathlib.PurePath(*inside.parts[1:])
        if is_picture or inside == pathlib.PurePath("results/index.html"):
            place = self.into / inside
            place.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(file, place)
            return place
        if inside.parts[0] == "results":  # one file contains all its pages
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
        print("libjs-katex is not installed: formulas stay as TeX source", file=sys.stderr)
    return source


def main():
    folder = pathlib.Path(sys.argv[1]).resolve()
    source = make(folder)
    if "--pages-only" not in sys.argv:
        subprocess.run(["mkdocs", "build", "--quiet", "--strict", "--config-file", source / "mkdocs.yml", "--site-dir", folder / "site"], check=True)
        print(f"open {folder}/site/index.html")


if __name__ == "__main__":
    main()
