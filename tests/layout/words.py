#!/usr/bin/env python3
"""words.py [--count] [FILE...]: fails where a document, a message, a comment or a name has a phrase of phrases.txt. Without files: those that
scope.txt lists. --count prints hits per file and phrase. Exit code 1: there are hits."""
import collections
import pathlib
import re
import subprocess
import sys

here = pathlib.Path(__file__).resolve().parent
root = here.parent.parent


def lines_of(name):
    return [l for l in (here / name).read_text().splitlines() if l and not l.startswith("#")]


def phrases():
    for line in lines_of("phrases.txt"):
        phrase, instead = line.rsplit("|", 1)
        yield re.compile(rf"(?<![A-Za-z]){phrase}(?![A-Za-z])", re.IGNORECASE), phrase, instead


def files():
    tracked = subprocess.run(["git", "ls-files", *lines_of("scope.txt")], cwd=root, capture_output=True, text=True, check=True)
    return [root / name for name in tracked.stdout.splitlines()]


def main():
    count = "--count" in sys.argv
    chosen = [pathlib.Path(a).resolve() for a in sys.argv[1:] if not a.startswith("--")] or files()
    found, hits = list(phrases()), collections.Counter()
    for path in chosen:
        for number, line in enumerate(path.read_text(errors="replace").splitlines(), 1):
            for pattern, phrase, instead in found:
                for match in pattern.finditer(line):
                    hits[(path, phrase)] += 1
                    if not count:
                        print(f'{path.relative_to(root)}:{number}:{match.start() + 1}: "{match.group()}"; say: {instead or "it plainly"}')
    if count:
        for (path, phrase), n in sorted(hits.items(), key=lambda h: -h[1]):
            print(f"{n:5} {path.relative_to(root)}: {phrase}")
    print(f"{sum(hits.values())} hits in {len(chosen)} files")
    return 1 if hits else 0


sys.exit(main())
