#!/usr/bin/env python3
"""What clang 14 and clang-tidy say about the whole tree: warnings without code (-fsyntax-only), and the checks of .clang-tidy.

tests/lint/clang.py warnings [REGEX]   every file, and every header by itself
tests/lint/clang.py tidy [REGEX]       solvers, app and validation, headers too
REGEX chooses files by their path. Exit code 1 where anything is said."""
import argparse
import json
import re
import shlex
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
GENERATED = ["solvers/particles/kernel_text.cpp", "solvers/output/build_info.cpp"]


def configure(build, unity):
    options = ["-DCMAKE_BUILD_TYPE=Debug", "-DWEIR_TESTS=ON", "-DWEIR_BENCHMARKS=ON", "-DWEIR_PYTHON=ON", f"-DWEIR_UNITY={'ON' if unity else 'OFF'}"]
    compilers = ["-DCMAKE_CXX_COMPILER=clang++-14", "-DCMAKE_C_COMPILER=clang-14"]
    subprocess.run(["cmake", "-G", "Ninja", "-S", ROOT, "-B", build, *compilers, *options], check=True, stdout=subprocess.DEVNULL)
    for source in GENERATED:  # alone: ninja would build the libraries below first
        command = subprocess.run(["ninja", "-C", build, "--quiet", "-t", "commands", "-s", source], check=True, capture_output=True, text=True)
        subprocess.run(command.stdout, shell=True, cwd=build, check=True, stdout=subprocess.DEVNULL)
    return json.loads((build / "compile_commands.json").read_text())


def arguments(entry, extra):
    """The command of an entry without its object file, with other options before the source."""
    words = shlex.split(entry["command"])
    if Path(words[0]).name == "ccache":
        words = words[1:]
    at = words.index("-o")
    del words[at:at + 2]
    words.remove("-c")
    return [words[0], *words[1:], *extra]


def warnings_of(entry):
    done = subprocess.run(arguments(entry, ["-fsyntax-only"]), cwd=entry["directory"], capture_output=True, text=True)
    return done.stderr or (f"{entry['file']}: the compiler ended with {done.returncode}\n" if done.returncode else "")


def tidy_of(entry):
    command = ["clang-tidy-14", "--quiet", "-p", entry["directory"], f"--header-filter={ROOT}/(solvers|app|validation)/.*", entry["file"]]
    done = subprocess.run(command, capture_output=True, text=True)
    return done.stdout + (done.stderr if done.returncode else "")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", choices=["warnings", "tidy"])
    parser.add_argument("regex", nargs="?", default="")
    parser.add_argument("-j", type=int, default=1, help="how many beside each other")
    given = parser.parse_intermixed_args()
    tidy = given.what == "tidy"
    entries = configure(ROOT / "build" / ("tidy" if tidy else "clang"), unity=not tidy)
    if tidy:
        entries = [e for e in entries if Path(e["file"]).relative_to(ROOT).parts[0] in ("solvers", "app", "validation")]
    entries = [e for e in entries if re.search(given.regex, e["file"])]
    if not entries:
        sys.exit(f"no file matches '{given.regex}'")
    seen = set()
    with ThreadPoolExecutor(given.j) as pool:
        for entry, said in zip(entries, pool.map(tidy_of if tidy else warnings_of, entries)):
            if said and said not in seen:
                seen.add(said)
                print(f"== {entry['file']}\n{said}", flush=True)
    print(f"{len(entries)} files, {len(seen)} with something said")
    sys.exit(1 if seen else 0)


if __name__ == "__main__":
    main()
