#!/usr/bin/env python3
"""Compiles each header alone, included twice: those that changed, or include one that did, since headers_alone.txt was written. A header that
a compiled source includes before anything else is compiled alone there; of those only `#pragma once` is asked.

headers.py --build BUILD            compile what changed; exit code 1 where one does not compile alone
headers.py --build BUILD --record   the same, and write headers_alone.txt beside this file, which is committed
"""
import argparse
import functools
import hashlib
import json
import pathlib
import re
import subprocess
import sys

source = pathlib.Path(__file__).resolve().parents[2]
recorded = pathlib.Path(__file__).with_name("headers_alone.txt")
include = re.compile(r'^\s*#\s*include\s*"([^"]+)"', re.MULTILINE)
any_include = re.compile(r'^\s*#\s*include\s*["<]([^">]+)[">]', re.MULTILINE)
roots = (source / "solvers", source)


@functools.cache
def text(file):
    return file.read_text()


def resolved(file, name):
    """The project's file that an #include of `name` in `file` means; None for a library's."""
    at = next((root / name for root in (file.parent, *roots) if (root / name).is_file()), None)
    return at.resolve() if at else None


@functools.cache
def included(file):
    """The project's files that a file includes itself."""
    found = []
    for name in include.findall(text(file)):
        at = resolved(file, name)
        if at:
            found.append(at)
    return found


def digest(header):
    """Of the header and of everything of the project that it includes, by any way."""
    seen, left = set(), [header]
    while left:
        file = left.pop()
        if file not in seen:
            seen.add(file)
            left += included(file)
    whole = hashlib.sha256()
    for file in sorted(seen):
        whole.update(f"{file.relative_to(source)}\n{text(file)}".encode())
    return whole.hexdigest()[:16]


def included_first(build):
    """Headers that a source of the build includes before anything else (not those of joined sources, which have others before them)."""
    found = set()
    for command in json.loads((build / "compile_commands.json").read_text()):
        file = pathlib.Path(command["file"])
        first = any_include.search(text(file)) if source in file.parents and build.resolve() not in file.parents else None
        header = resolved(file, first[1]) if first else None
        if header and "#pragma once" in text(header):
            found.add(str(header.relative_to(source)))
    return found


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=pathlib.Path, required=True, help="a configured build folder, of Ninja")
    parser.add_argument("--record", action="store_true", help="write headers_alone.txt")
    arguments = parser.parse_args()
    headers = (arguments.build / "tests/layout/headers.txt").read_text().split()
    now = {name: digest((source / name).resolve()) for name in headers}
    before = dict(line.split() for line in recorded.read_text().splitlines()) if recorded.exists() else {}
    changed = [name for name in headers if before.get(name) != now[name]]
    first = included_first(arguments.build)
    print(f"{len(changed)} of {len(headers)} headers changed since {recorded.name} was written; {len(first.intersection(changed))} are the first of a source", flush=True)
    changed = [name for name in changed if name not in first]
    objects = ["tests/layout/CMakeFiles/layout_headers.dir/alone/" + re.sub(r"\W", "_", name) + ".cpp.o" for name in changed]
    if objects and subprocess.run(["ninja", "-C", str(arguments.build), *objects], check=False).returncode != 0:
        return 1
    if arguments.record:
        recorded.write_text("".join(f"{name} {now[name]}\n" for name in headers))
    return 0


if __name__ == "__main__":
    sys.exit(main())
