"""The book does what it says: every command of its pages runs and prints what stands below it, every scene is read and stepped, every program
runs, sources for the tree compile, links and file names lead somewhere, and the site is made of it and asks the network for nothing.

A page is run in an empty folder that has the repository's cases/ and results/, in the order of its blocks:
  toml    its first line is a comment with the file's name, under which it is written
  sh      line by line, each ends with exit code 0 or with the one that its comment names
  python  as a program of its own
  text    lines that the block before has printed, in this order; ... stands for anything
  cpp     its first line is a comment with the file's name below solvers/; its syntax and types are checked
"""
import fnmatch
import html
import html.parser
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys

import pytest

root = pathlib.Path(__file__).resolve().parents[2]
pages = [root / "docs/index.md", *sorted((root / "docs/book").rglob("*.md"))]
linked = [root / "README.md", root / "CONTRIBUTING.md", *sorted((root / "docs").rglob("*.md"))]
fence = re.compile(r"^```(\w*)\n(.*?)^```[ \t]*$", re.M | re.S)


def name_of(page):
    return str(page.relative_to(root))


def blocks(page):
    return [(match[1], match[2]) for match in fence.finditer(page.read_text())]


def prose(page):
    return fence.sub("", page.read_text())


def first_line(text):
    return text.split("\n", 1)[0]


# ---- what runs

front_door = """#!/usr/bin/env bash
# stands for weir.sh, which would build first
grep -qE "^ +([a-z]+ \\| )*$1( \\| [a-z]+)*\\)" "{root}/weir.sh" || {{ echo "weir.sh has no command $1" >&2; exit 64; }}
exec weir "$@"
"""


@pytest.fixture
def desk(tmp_path, executable):
    """A folder that looks like a clone in which everything is built, and what a command there sees."""
    for name in ("cases", "results"):
        (tmp_path / name).symlink_to(root / name)
    (tmp_path / "weir.sh").write_text(front_door.format(root=root))
    (tmp_path / "weir.sh").chmod(0o755)
    (tmp_path / "bin").mkdir()
    (tmp_path / "bin/weir").symlink_to(executable)
    return tmp_path, {**os.environ, "PATH": f"{tmp_path / 'bin'}:{os.environ['PATH']}"}


def run(command, desk, expected=0):
    done = subprocess.run(command, cwd=desk[0], env=desk[1], text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=300)
    assert done.returncode == expected, f"{command}: exit code {done.returncode}\n{done.stdout}"
    return done.stdout


def run_lines(text, desk):
    printed = ""
    for line in text.splitlines():
        says = re.search(r"# exit code (\d)", line)
        printed += run(["bash", "-c", line], desk, int(says[1]) if says else 0)
    return printed


def compile_only(text, desk):
    """A file of the tree, by its types: whether what the page writes fits the headers as they are."""
    compiler = os.environ.get("WEIR_CXX", "c++")
    file = desk[0] / "page.cpp"
    file.write_text(text)
    return run([compiler, "-std=c++20", "-fsyntax-only", "-fopenmp-simd", "-Wall", "-Wextra", "-Werror", f"-I{root / 'solvers'}", str(file)], desk)


def expect(text, printed, where):
    lines = iter(printed.splitlines())
    for wanted in text.splitlines():
        pattern = "*".join(re.sub(r"([\[\]*?])", r"[\1]", part) for part in re.split(r" ?\.\.\. ?", wanted))
        assert any(fnmatch.fnmatchcase(line, pattern) for line in lines), f"{where}: no output has\n{wanted}\nbut\n{printed}"


@pytest.mark.parametrize("page", pages, ids=name_of)
def test_page(page, desk):
    """Every block of the page, in its order."""
    printed, scenes = "", []
    for kind, text in blocks(page):
        if kind == "sh":
            printed = run_lines(text, desk)
        elif kind == "python":
            printed = run([sys.executable, "-c", text], desk)
        elif kind == "text":
            expect(text, printed, name_of(page))
        elif kind == "toml":
            file = desk[0] / re.fullmatch(r"# ([\w/]+\.toml)", first_line(text))[1]
            file.parent.mkdir(exist_ok=True)
            file.write_text(text)
            scenes += [file] if re.search(r"^solver ", text, re.M) else []
        elif kind == "cpp":
            where = root / re.fullmatch(r"// (solvers/[\w/]+\.cpp)", first_line(text))[1]
            assert where.parents[1].is_dir() and not where.exists(), "a page shows how a file is added, not one that there is"
            compile_only(text, desk)
        else:
            assert kind == "math", f"{name_of(page)}: a block of {kind or 'nothing'} is not checked"
    for file in scenes:
        run([sys.executable, "-c", f"import weir; print(weir.Simulation({str(file)!r}).step().dt)"], desk)


def test_the_book_has_all_pages_that_its_contents_name():
    navigation = (root / "docs/site/mkdocs.yml").read_text()
    named = set(re.findall(r": ([\w/]+\.md)$", navigation, re.M))
    for page in pages:
        assert name_of(page).removeprefix("docs/") in named
    for solver in ("mac", "mac_water", "two_phase", "tallcell", "heightfield", "waves", "sph", "pbf", "heat", "bodies"):
        assert f"book/theory/{solver}.md" in named


# ---- links and names

def anchors(page):
    titles = re.findall(r"^#+ (.*)$", prose(page), re.M)
    return {re.sub(r"[^\w\- ]", "", title.lower()).strip().replace(" ", "-") for title in titles}


@pytest.mark.parametrize("page", linked, ids=name_of)
def test_links(page):
    """Of the text and its pictures; in code nothing is a link."""
    text = re.sub(r"`(?:[^`\n]|\n(?!\n))*`", "`", prose(page))
    for to in re.findall(r"\]\(([^()\s]+)\)", text):
        if "://" in to:
            continue
        path, _, anchor = to.partition("#")
        target = (page.parent / path).resolve() if path else page
        assert target.exists(), f"{name_of(page)}: {to}"
        if anchor and target.suffix == ".md" and "results" not in target.parts:
            assert anchor in anchors(target), f"{name_of(page)}: {to}"


@pytest.mark.parametrize("page", pages, ids=name_of)
def test_names_of_files(page):
    """What looks like a path of the repository is one; what a page adds itself is not looked for."""
    own = {first_line(text)[3:] for kind, text in blocks(page) if kind == "cpp"}
    own |= {str(pathlib.PurePath(name).parent) for name in own}
    for name in re.findall(r"`((?:app|cases|docs|python|results|solvers|tests|validation)(?:/[\w.]+)+/?)`", prose(page)):
        if "NAME" not in name and name not in own:
            assert (root / name).exists(), f"{name_of(page)}: {name}"


def test_names_of_commands(executable):
    """A `weir word --option` in the text is one that the program has."""
    helps = {}
    for page in pages:
        for words in re.findall(r"`(?:\./weir\.sh|weir) ([^`]*)`", prose(page)):
            command, *rest = words.split()
            if command in ("docs", "python", "test", "build", "package", "install"):
                assert f"  {command}" in (root / "weir.sh").read_text()
                continue
            if command not in helps:
                done = subprocess.run([executable, command, "--help"], capture_output=True, text=True)
                assert done.returncode == 0, f"{name_of(page)}: weir {command}"
                helps[command] = done.stdout
            for option in rest:
                if option.startswith("--"):
                    assert option in helps[command], f"{name_of(page)}: weir {words}"


# ---- the site

class Page(html.parser.HTMLParser):
    def __init__(self):
        super().__init__()
        self.to, self.ids = [], set()

    def handle_starttag(self, tag, attrs):
        for name, value in attrs:
            if name == "id":
                self.ids.add(value)
            if name in ("href", "src"):
                self.to.append((tag, value))


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    assert shutil.which("mkdocs"), "mkdocs of Debian is missing: ./weir.sh docs installs it"
    folder = tmp_path_factory.mktemp("book")
    subprocess.run([sys.executable, root / "docs/site/make.py", folder], check=True, env={**os.environ, "PYTHONDONTWRITEBYTECODE": "1"})
    return folder / "site"


def test_site(site):
    """Every link of every page stays inside the site and leads somewhere; nothing is loaded from elsewhere; search knows every page."""
    read = {}
    for file in site.rglob("*.html"):
        if "results" not in file.relative_to(site).parts:
            read[file] = Page()
            read[file].feed(file.read_text())
    assert len(read) > 25
    for file, page in read.items():
        for tag, to in page.to:
            if to.startswith(("http://", "https://", "mailto:")):
                assert tag == "a", f"{file.relative_to(site)} loads {to}"
                continue
            path, _, anchor = to.partition("#")
            target = (file.parent / path).resolve() if path else file
            assert target.is_file(), f"{file.relative_to(site)}: {to}"
            if anchor and target in read:
                assert anchor in read[target].ids, f"{file.relative_to(site)}: {to}"
    for style in site.rglob("*.css"):
        assert "http" not in style.read_text()
    index = (site / "search/index.js").read_text()
    for page in pages:
        assert name_of(page).removeprefix("docs/").replace(".md", ".html") in index


def test_the_site_has_what_the_results_say(site):
    """The pages that are made from results/ name every study, every setting of a front, every limit."""
    choosing, breaks = (site / "book/choosing.html").read_text(), (site / "book/breaks.html").read_text()
    for file in (root / "results/cost/json").glob("*.json"):
        study = json.loads(file.read_text())
        assert f">{study['study']}</h3>" in choosing
        for point in study["points"]:
            assert not point["front"] or f"<td>{point['name']}</td>" in choosing
    breaks = html.unescape(breaks)
    for file in (root / "results/stability").glob("*.json"):
        for limit in json.loads(file.read_text())["limits"]:
            assert f"<strong>{limit['axis']}</strong>" in breaks and limit["last_stable_text"] in breaks


@pytest.mark.skipif(not shutil.which("chromium"), reason="no chromium")
def test_the_site_in_a_browser(site, tmp_path):
    """Opened from a disk, without a network: search finds a page by two words, formulas are drawn."""
    def drawn(page):
        return run(["chromium", "--headless", "--no-sandbox", "--disable-gpu", f"--user-data-dir={tmp_path}/profile",
                    "--host-resolver-rules=MAP * ~NOTFOUND", "--virtual-time-budget=5000", "--dump-dom", f"file://{site}/{page}"],
                   (tmp_path, os.environ))
    found = re.search(r'<div id="found">(.*?)</div>', drawn("index.html?q=tall%20knots"), re.S)
    assert found and "book/theory/tallcell.html" in found[1]
    assert drawn("book/theory/mac.html").count('class="katex-display"') == 3
