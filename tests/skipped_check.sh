#!/usr/bin/env bash
# skipped_check.sh SKIPPED.sh: what it says of skips that a machine explains, does not explain, and of none.
set -euo pipefail
skipped=$1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
bash=$(command -v bash)
mkdir "$work/bin"
for tool in awk; do ln -s "$(command -v $tool)" "$work/bin/"; done
printf '#!%s\nexit 2\n' "$bash" >"$work/weir"
chmod +x "$work/weir"
one() { # NAME OUTPUT
    printf '\t<testcase name="%s" classname="%s" time="0.1" status="notrun">\n\t\t<skipped message="SKIP_RETURN_CODE=77"/>\n' "$1" "$1"
    printf '\t\t<system-out>%s\n</system-out>\n\t</testcase>\n' "$2"
}
says() { # WANTED CODE, WANTED TEXT
    local code=0 text
    text=$(PATH="$work/bin" INCLUDES="$work/include" PETSC="$work/petsc" "$bash" "$skipped" "$work/tests.xml" "$work/weir") || code=$?
    [ "$code" -eq "$1" ] && [[ "$text" == *"$2"* ]] || { echo "ended with $code and said: $text; wanted $1 and: $2"; exit 1; }
}
{ echo '<testsuite>'; printf '\t<testcase name="a" status="run">\n\t\t<system-out>skipped: no</system-out>\n\t</testcase>\n'; echo '</testsuite>'; } >"$work/tests.xml"
says 0 "0 tests skipped"
{ echo '<testsuite>'; one app.page "skipped: no chromium (Debian: apt-get install chromium)"; one b "no OpenCL device here"; echo '</testsuite>'; } >"$work/tests.xml"
says 0 "2 tests skipped; app.page: no chromium (Debian: apt-get install chromium); b: no OpenCL device here"
printf '#!%s\n' "$bash" >"$work/bin/chromium"
chmod +x "$work/bin/chromium"
says 1 "app.page: NOT EXPLAINED"
{ echo '<testsuite>'; one c ""; echo '</testsuite>'; } >"$work/tests.xml"
says 1 "c: NOT EXPLAINED by this machine (no reason given)"
{ echo '<testsuite>'; one d "skipped: no ffmpeg (1 of 9 tests)"; one e "skipped: built without Embree (1 of 9 tests)"; echo '</testsuite>'; } >"$work/tests.xml"
says 0 "2 tests skipped; d: no ffmpeg (1 of 9 tests); e: built without Embree (1 of 9 tests)"
mkdir -p "$work/include/embree3"
touch "$work/include/embree3/rtcore.h"
says 1 "2 tests skipped; d: no ffmpeg (1 of 9 tests); e: NOT EXPLAINED"
printf '#!%s\n' "$bash" >"$work/bin/ffmpeg"
chmod +x "$work/bin/ffmpeg"
says 1 "2 tests skipped; d: NOT EXPLAINED"
{ echo '<testsuite>'; one f "skipped: built without PETSc (2 of 9 tests)"; echo '</testsuite>'; } >"$work/tests.xml"
says 0 "1 tests skipped; f: built without PETSc"
mkdir -p "$work/petsc/petsc3.18/x86_64-linux-gnu-real/include"
touch "$work/petsc/petsc3.18/x86_64-linux-gnu-real/include/petsc.h"
says 1 "f: NOT EXPLAINED"
