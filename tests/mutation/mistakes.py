#!/usr/bin/env python3
"""Mistakes put into the code on purpose, and whether the tests see them. README.md beside this file says how to use it."""
import argparse
import concurrent.futures
import dataclasses
import fnmatch
import hashlib
import json
import os
import pathlib
import re
import signal
import subprocess
import sys
import tempfile
import threading
import time
import tomllib

HERE = pathlib.Path(__file__).resolve().parent
SOURCE = HERE.parents[1]
BUILD = SOURCE / "build" / "mutation"
TREE = BUILD / "tree"
RELEASE = TREE / "build" / "release"
SWITCH_HOME = "solvers/core/parallel.cpp"  # every program links it

SWITCH = """#ifndef weir_mutant
extern const int weir_mutant_chosen __asm__("weir_mutant_number");
#define weir_mutant(n) (weir_mutant_chosen == (n))
#endif
#line 1
"""
SWITCH_OF_KERNELS = """#ifdef __OPENCL_VERSION__
#define weir_mutant(n) 0
#endif
"""
SWITCH_ITSELF = """
#include <cstdlib>
extern "C" {
extern int weir_mutant_number;
int weir_mutant_number = std::getenv("WEIR_MUTANT") ? std::atoi(std::getenv("WEIR_MUTANT")) : 0;
}
"""


@dataclasses.dataclass
class Mistake:
    name: str
    number: int
    wrong: str
    file: str
    before: str
    after: str
    tests: list
    within: str = ""
    kind: str = "expression"  # or "statement"
    known: str = ""  # why no test sees it
    begin: int = 0
    end: int = 0
    lines: tuple = (0, 0)


def fail(text):
    sys.exit(f"mistakes.py: {text}")


PROBLEMS = []  # of the list, told all at once


# ---- the list

def known_tests():
    """Names of ctest entries, by the files that make them."""
    names = {"cost.studies"}
    names |= {f"stability.limits.{study.parent.name}" for study in SOURCE.glob("cases/*/stability.toml")}
    names |= {f"validate.{case.parent.name}" for case in SOURCE.glob("cases/*/case.toml")}
    for file in SOURCE.glob("tests/**/CMakeLists.txt"):
        for kind, name, rest in re.findall(r"weir_test\((\w+) (\w+)\s+SOURCES ([^)]*)\)", file.read_text()):
            sources = re.split(r"\b(?:LINKS|LABELS|TIMEOUT|ENVIRONMENT)\b", rest)[0]
            names |= {f"{kind}.{name}.{stem}" for stem in re.findall(r"(\w+)\.cpp", sources)}
    return names


def is_expression(text):
    """Whether parentheses match and nothing but an operand is at either end; whether the text compiles is found by building it."""
    depth = 0
    for c in text:
        depth += (c in "([{") - (c in ")]}")
        if depth < 0 or (c == ";" and depth == 0):
            return False
    return depth == 0 and not text.rstrip().endswith(("||", "&&", "+", "-", "*", "/", ",", "="))


def read_list():
    mistakes, number = [], 0
    tests = known_tests()
    for file in sorted((HERE / "mistakes").glob("*.toml")):
        for key, entry in tomllib.loads(file.read_text()).items():
            number += 1
            try:
                m = Mistake(name=f"{file.stem}.{key}", number=number, **entry)
            except TypeError as wrong:
                PROBLEMS.append(f"{file.stem}.{key}: {wrong}")
                continue
            if m.kind not in ("expression", "statement"):
                PROBLEMS.append(f"{m.name}: kind is \"expression\" or \"statement\"")
            named = []
            for pattern in m.tests:
                found = sorted(fnmatch.filter(tests, pattern))
                if not found:
                    PROBLEMS.append(f"{m.name}: there is no test {pattern}")
                named += [t for t in found if t not in named]
            for part in (m.before, m.after):
                if m.kind == "expression" and not is_expression(part):
                    PROBLEMS.append(f"{m.name}: {part!r} is no whole expression")
            m.tests = named
            place(m)
            mistakes.append(m)
    for m in mistakes:
        for other in mistakes:
            if other.number > m.number and other.file == m.file and (other.begin, other.end) != (m.begin, m.end) and \
                    other.begin < m.end and m.begin < other.end:
                PROBLEMS.append(f"{m.name} and {other.name} change overlapping text")
    if PROBLEMS:
        fail("\n".join(["the list is wrong:", *PROBLEMS]))
    return mistakes


def place(m):
    text = (SOURCE / m.file).read_text()
    first, last = 0, len(text)
    if m.within:
        if text.count(m.within) != 1:
            return PROBLEMS.append(f"{m.name}: its 'within' stands {text.count(m.within)} times in {m.file}, not once")
        first = text.index(m.within)
        last = first + len(m.within)
        if m.before not in m.within:  # what begins there
            last = text.index("\n\n", first) if "\n\n" in text[first:] else len(text)
    count = text.count(m.before, first, last)
    if count != 1:
        return PROBLEMS.append(f"{m.name}: its 'before' stands {count} times in {m.file}{' within the text given' if m.within else ''}, not once")
    m.begin = text.index(m.before, first, last)
    if m.kind == "expression" and text[:m.begin].endswith((".", "->")):
        PROBLEMS.append(f"{m.name}: {m.before!r} is a part of an expression: a member of what stands before it")
    line = text[text.rindex("\n", 0, m.begin) + 1:m.end]
    if re.match(r"\s*((inline|static) )*constexpr [^()]*=", line):
        PROBLEMS.append(f"{m.name}: a constant expression cannot be switched")
    m.end = m.begin + len(m.before)
    m.lines = (text.count("\n", 0, m.begin) + 1, text.count("\n", 0, m.end) + 1)


# ---- the tree

def switched(before, changes):
    if changes[0].kind == "statement":
        text = "{ "
        for m in changes:
            text += f"if (weir_mutant({m.number})) {{ {m.after} }} else "
        return text + f"{{ {before} }} }}"
    return "(" + "".join(f"weir_mutant({m.number}) ? ({m.after}) : " for m in changes) + f"({before}))"


def with_mistakes(text, changes):
    spans = {}
    for m in changes:
        spans.setdefault((m.begin, m.end), []).append(m)
    for (begin, end), here in sorted(spans.items(), reverse=True):
        text = text[:begin] + switched(text[begin:end], here) + text[end:]
    return text


def who_includes(kernels, files):
    """Host files that include one of these kernel files, or a kernel file that does."""
    kernels, hosts, more = set(kernels), set(), True
    while more:
        more = False
        for file in files:
            if not file.endswith((".cpp", ".hpp", ".inl", ".h")):
                continue
            text = (SOURCE / file).read_text(errors="replace")
            if not any(f'"{k.removeprefix("solvers/")}"' in text for k in kernels):
                continue
            if file.endswith(".inl"):
                more = more or file not in kernels
                kernels.add(file)
            else:
                hosts.add(file)
    return hosts


def write_tree(mistakes):
    files = subprocess.run(["git", "ls-files", "--cached", "--others", "--exclude-standard"], cwd=SOURCE, check=True, capture_output=True,
                           text=True).stdout.split("\n")
    files = [f for f in files if f and (SOURCE / f).is_file()]
    of_file = {}
    for m in mistakes:
        of_file.setdefault(m.file, []).append(m)
    hosts = who_includes([f for f in of_file if f.endswith(".inl")], files)
    for file in files:
        content = (SOURCE / file).read_bytes()
        if file in of_file:
            text = with_mistakes(content.decode(), of_file[file])
            content = ((SWITCH_OF_KERNELS if file.endswith(".inl") else SWITCH) + text).encode()
        elif file in hosts:
            content = SWITCH.encode() + content
        if file == SWITCH_HOME:
            content += SWITCH_ITSELF.encode()
        to = TREE / file
        if to.is_file() and to.read_bytes() == content:
            continue
        to.parent.mkdir(parents=True, exist_ok=True)
        to.write_bytes(content)
        to.chmod((SOURCE / file).stat().st_mode)
    kept = set(files)
    for old in TREE.rglob("*"):
        name = old.relative_to(TREE).as_posix()
        if old.is_file() and not name.startswith("build/") and name not in kept:
            old.unlink()


def target_of(test):
    kind, name, *_ = test.split(".")
    return f"{kind}_{name}" if kind in ("unit", "shared", "convergence", "metamorphic", "effects") else "weir"


def build(mistakes, jobs):
    """Returns those that do not compile: they are taken out again."""
    if not (RELEASE / "build.ninja").is_file():
        subprocess.run(["cmake", "--preset", "release", "-DWEIR_TESTS=ON", "-DWEIR_BENCHMARKS=OFF", "-DWEIR_PYTHON=OFF"], cwd=TREE, check=True,
                       stdout=subprocess.DEVNULL)
    targets = sorted({target_of(t) for m in mistakes for t in m.tests})
    broken = []
    while True:
        log = subprocess.run(["ninja", "-C", str(RELEASE), "-k", "0", f"-j{jobs}", *targets], capture_output=True, text=True)
        (BUILD / "build.log").write_text(log.stdout + log.stderr)
        if log.returncode == 0:
            return broken
        found = []
        for path, line in re.findall(r"^(\S+?):(\d+):\d+: error", log.stdout, re.M):
            file = os.path.relpath(os.path.normpath(RELEASE / path), TREE)
            found += [m for m in mistakes if m.file == file and m.lines[0] <= int(line) <= m.lines[1] and m not in found]
        if not found:
            fail(f"the tree does not compile, and not for a mistake's line: {BUILD / 'build.log'}")
        for m in found:
            print(f"does not compile: {m.name}", flush=True)
        broken += found
        mistakes = [m for m in mistakes if m not in found]
        write_tree(mistakes)


# ---- running

def commands():
    listed = subprocess.run(["ctest", "--show-only=json-v1"], cwd=RELEASE, check=True, capture_output=True, text=True).stdout
    found = {}
    for test in json.loads(listed)["tests"]:
        if "command" not in test:
            continue
        properties = {p["name"]: p["value"] for p in test.get("properties", [])}
        found[test["name"]] = (test["command"], dict(e.split("=", 1) for e in properties.get("ENVIRONMENT", [])))
    return found


def run_test(test, listed, number, limit):
    """passes, fails or hangs; and its time. What is skipped sees nothing: it passes."""
    command, more = listed[test]
    environment = {**os.environ, **more}
    environment.pop("WEIR_MUTANT", None)
    if number:
        environment["WEIR_MUTANT"] = str(number)
    begin = time.monotonic()
    with tempfile.TemporaryDirectory(prefix="mistakes.") as out:
        command = list(command)
        if "--out" in command:
            command[command.index("--out") + 1] = out
        environment["TMPDIR"] = out
        process = subprocess.Popen(command, cwd=RELEASE, env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                                   errors="replace", start_new_session=True)
        try:
            text, _ = process.communicate(timeout=limit)
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)
            process.communicate()
            return "hangs", time.monotonic() - begin, ""
    passes = process.returncode in (0, 77)
    return "passes" if passes else "fails", time.monotonic() - begin, text


class Baseline:
    """Each test without a mistake, once, when it is first asked for: its time, or None where it fails."""

    def __init__(self, listed):
        self.listed, self.times, self.locks, self.own = listed, {}, {}, threading.Lock()

    def __call__(self, test):
        with self.own:
            lock = self.locks.setdefault(test, threading.Lock())
        with lock:
            if test not in self.times:
                end, seconds, text = run_test(test, self.listed, 0, 900)
                if end != "passes":
                    print(f"{end} without any mistake: {test} {first_failure(text)}", flush=True)
                self.times[test] = seconds if end == "passes" else None
            return self.times[test]


def first_failure(text):
    failed = re.findall(r"\[  FAILED  \] ([^\n(]+)", text)
    return failed[0].strip(" ,") if failed else ""


def judge(m, tests, baseline, all_tests):
    """Quick tests first: cases only where no test has seen the mistake."""
    saw = []
    for test in sorted(tests, key=lambda t: (t.startswith("validate"), baseline.times.get(t) or 0)):
        seconds = baseline(test)
        if seconds is None:
            continue
        end, _, _ = run_test(test, baseline.listed, m.number, max(30, 10 * seconds))
        if end != "passes":
            saw.append(test + (" (hangs)" if end == "hangs" else ""))
            if not all_tests:
                break
    return saw


def key_of(m):
    return hashlib.sha256(json.dumps([m.file, m.within, m.before, m.after, m.kind, m.tests]).encode()).hexdigest()[:16]


class Results:
    """What was found, kept from call to call until an entry changes: by name, who saw it; nothing stands there of what was not run to its end."""

    def __init__(self, fresh):
        self.file = BUILD / "results.json"
        self.kept = json.loads(self.file.read_text()) if self.file.is_file() and not fresh else {}

    def keep(self, m, saw):
        self.kept[m.name] = {"key": key_of(m), "saw": saw}
        self.file.write_text(json.dumps(self.kept, indent=1))

    def of(self, m):
        found = self.kept.get(m.name)
        return found["saw"] if found and found["key"] == key_of(m) else None


def table(mistakes, results):
    found = [(m, results.of(m)) for m in mistakes]
    caught, run = sum(1 for _, saw in found if saw), sum(1 for _, saw in found if saw is not None)
    broken = sum(1 for _, saw in found if saw == ["does not compile"])
    summary = f"{len(found)} mistakes: {run} run, {caught - broken} caught, {run - caught} survive, {broken} do not compile"
    lines = ["# Mistakes and the tests that see them", "", f"Written by `tests/mutation/mistakes.py`. {summary}.", "",
             "| mistake | what is wrong | seen by |", "|---|---|---|"]
    for m, saw in sorted(found, key=lambda entry: entry[0].name):
        text = "not run" if saw is None else ", ".join(saw) if saw else "**survives**" + (": " + m.known if m.known else "")
        lines.append(f"| {m.name} | {m.wrong} | {text} |")
    return summary, "\n".join(lines) + "\n"


def main():
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("--only", metavar="PATTERN", action="append", help="names that match, as flow.* or *seam*; may be repeated")
    options.add_argument("--tests", metavar="PATTERN", default="*", help="of the named tests those that match: a mistake that they do not see counts as not run")
    options.add_argument("--list", action="store_true", help="check and print the list; nothing is built")
    options.add_argument("--jobs", type=int, default=os.cpu_count(), help="of the build, and mistakes beside each other")
    options.add_argument("--all-tests", action="store_true", help="run every named test, also after one has seen the mistake")
    options.add_argument("--missing", action="store_true", help="run those alone that were not caught yet")
    options.add_argument("--fresh", action="store_true", help="forget what former calls found")
    options.add_argument("--minutes", type=float, default=1e9, help="begin no mistake after so long")
    options.add_argument("--table", type=pathlib.Path, help="write the table there, too")
    given = options.parse_args()
    mistakes = read_list()
    results = Results(given.fresh)
    chosen = [m for m in mistakes if any(fnmatch.fnmatch(m.name, p) for p in given.only or ["*"])]
    if given.missing:
        chosen = [m for m in chosen if not results.of(m)]
    if given.list:
        for m in chosen:
            print(f"{m.number:4} {m.name:40} {m.wrong}" + (f" [known: {m.known}]" if m.known else ""))
        return print(f"{len(chosen)} mistakes in {len({m.file for m in chosen})} files")
    begin = time.monotonic()
    write_tree(mistakes)
    for m in build(mistakes, given.jobs):
        results.keep(m, ["does not compile"])
    chosen = [m for m in chosen if results.of(m) != ["does not compile"]]
    baseline = Baseline(commands())
    with concurrent.futures.ThreadPoolExecutor(given.jobs) as pool:

        def one(m):
            if time.monotonic() - begin < 60 * given.minutes:
                tests = fnmatch.filter(m.tests, given.tests)
                return m, judge(m, tests, baseline, given.all_tests), len(tests) == len(m.tests)
            return m, None, False

        for done in concurrent.futures.as_completed([pool.submit(one, m) for m in chosen]):
            m, saw, whole = done.result()
            if saw is not None and (saw or whole):
                results.keep(m, saw)
            if saw is not None:
                print(f"{'caught' if saw else 'SURVIVES' if whole else 'not seen':9} {m.name:40} {', '.join(saw)}", flush=True)
    summary, text = table(mistakes, results)
    (BUILD / "results.md").write_text(text)
    if given.table:
        given.table.write_text(text)
    print(summary)
    bad = [t for t, seconds in baseline.times.items() if seconds is None]
    wrong = [m.name for m in chosen if results.of(m) == [] and not m.known]
    found = [m.name for m in chosen if results.of(m) and m.known]
    broken = [m.name for m in mistakes if results.of(m) == ["does not compile"]]
    for what, names in (("fail without a mistake", bad), ("do not compile", broken), ("survive, and the list gives no reason", wrong),
                        ("are caught, and listed as known: take the reason out", found)):
        if names:
            print(f"{what}: {', '.join(names)}")
    sys.exit(1 if bad or broken or wrong or found else 0)


if __name__ == "__main__":
    main()
