#!/usr/bin/env bash
# run.sh BUILD [OPTION...]: the unit tests and every case at a tiny size, by programs that a sanitizer watches (presets asan and tsan).
# A case's tiny size is `weir validate CASE --steps N`: all its variants, each at the first value of its sweep, with frames, reference and
# metrics; a case that has only a stability.toml has its floors cut off in the same way, and other scenes are run to a small time.
#   --part K/N     the jobs whose names fall to part K of N; K = now: by the number of commits, so that N commits in a row cover all
#   --only KIND    unit, case or both (default)
#   --steps N      of each run (default 12)
#   --threads N    of the cases (default 1; the thread sanitizer finds races with 2)
#   --jobs N       beside each other (default 1)
#   --limit SEC    of one job (default 300)
#   --out DIR      logs (default BUILD/sanitized)
#   --list         the names of the jobs, nothing is run
# Exit code 1 where a job found something, ended otherwise than it may, or took too long; the first lines of each finding are shown.
# A sanitizer's own options (ASAN_OPTIONS, ...) are added to those below.
set -euo pipefail
here="$(cd "$(dirname "$0")" && pwd)"
root="$(cd "$here/../.." && pwd)"
[ $# -ge 1 ] && [ "$1" != --help ] || { sed -n '2,/are added to/{s/^# \{0,1\}//;p}' "$0"; exit 2; }
build="$(cd "$1" && pwd)" && shift
part=0 parts=1 only=both steps=12 threads=1 jobs=1 limit=300 out="$build/sanitized" list=false
while [ $# -gt 0 ]; do
    case "$1" in
        --part) part="${2%/*}" parts="${2#*/}"; shift 2 ;;
        --only) only="$2"; shift 2 ;;
        --steps) steps="$2"; shift 2 ;;
        --threads) threads="$2"; shift 2 ;;
        --jobs) jobs="$2"; shift 2 ;;
        --limit) limit="$2"; shift 2 ;;
        --out) out="$2"; shift 2 ;;
        --list) list=true; shift ;;
        *) echo "run.sh: unknown word $1" >&2; exit 2 ;;
    esac
done
if [ "$part" = now ]; then
    count="$(git -C "$root" rev-list --count HEAD 2>/dev/null || date +%j)"
    part=$((10#$count % parts))
fi

# One line a job: its name, a tab, its command.
cases() {
    local folder name file
    for folder in "$root"/cases/*/; do
        name="$(basename "$folder")"
        if [ -e "$folder/case.toml" ]; then
            printf 'case.%s\texec %q validate %q --steps %s --threads %s --quiet --out %q\n' "$name" "$build/weir" "$folder" "$steps" "$threads" "$out/files/$name"
        elif [ -e "$folder/stability.toml" ]; then
            printf 'stability.%s\texec %q stability %q --floors --steps %s --threads %s --quiet --out %q\n' "$name" "$build/weir" "$folder" "$steps" "$threads" "$out/files/$name"
        fi
    done
    while read -r file end; do # scenes of studies, which no case runs
        name="${file%.toml}" && name="${name//\//.}"
        printf 'scene.%s\texec %q run %q --set time.end=%s --threads %s --quiet --out %q\n' "$name" "$build/weir" "$root/cases/$file" "$end" "$threads" "$out/files/$name"
    done < <(sed '/^#/d' "$here/scenes.txt")
}
units() {
    local program suite
    for program in "$build"/unit_*; do
        { [ -f "$program" ] && [ -x "$program" ]; } || continue
        for suite in $("$program" --gtest_list_tests | sed -n 's/^\([^ ].*\)\.$/\1/p'); do
            printf '%s.%s\tcd %q && exec %q --gtest_filter=%s.* --gtest_brief=1\n' "$(basename "$program")" "$suite" "$build" "$program" "$suite"
        done
    done
}
wanted() { # the jobs of this part, by their names
    local name command sum
    while IFS=$'\t' read -r name command; do
        sum="$(cksum <<<"$name")"
        [ $((${sum%% *} % parts)) -eq "$part" ] && printf '%s\t%s\n' "$name" "$command"
    done
    true
}

export OMP_NUM_THREADS="${OMP_NUM_THREADS:-1}" GOMP_SPINCOUNT=1000 POCL_CACHE_DIR="$out/pocl"
common="exitcode=99:halt_on_error=1:print_stacktrace=1"
export ASAN_OPTIONS="$common:detect_leaks=1:detect_stack_use_after_return=1:check_initialization_order=1:handle_abort=1${ASAN_OPTIONS:+:$ASAN_OPTIONS}"
export UBSAN_OPTIONS="$common${UBSAN_OPTIONS:+:$UBSAN_OPTIONS}"
export LSAN_OPTIONS="suppressions=$here/leaks.txt:print_suppressions=0:exitcode=99${LSAN_OPTIONS:+:$LSAN_OPTIONS}"
export TSAN_OPTIONS="exitcode=99:halt_on_error=1:second_deadlock_stack=1:ignore_noninstrumented_modules=1:suppressions=$here/threads.txt${TSAN_OPTIONS:+:$TSAN_OPTIONS}"

run_job() { # "NAME<tab>COMMAND"
    local name="${1%%$'\t'*}" command="${1#*$'\t'}" code=0 start=$SECONDS
    timeout --foreground -k 5 "$limit" bash -c "$command" >"$out/$name.log" 2>&1 || code=$?
    grep -qE "runtime error:|ERROR: (Address|Leak)Sanitizer|WARNING: ThreadSanitizer" "$out/$name.log" && code=99
    printf '%s\t%s\t%s\n' "$code" "$((SECONDS - start))" "$name" >>"$out/ended.txt"
}
export -f run_job
export out limit

chosen="$({ [ "$only" = unit ] || cases; [ "$only" = case ] || units; } | wanted)"
if $list; then cut -f1 <<<"$chosen"; exit 0; fi
mkdir -p "$out" && rm -f "$out"/*.log && : >"$out/ended.txt"
tr '\n' '\0' <<<"$chosen" | sed -z '/^$/d' | xargs -0 -P "$jobs" -n 1 bash -c 'run_job "$1"' _

found=0
while IFS=$'\t' read -r code seconds name; do
    case "$code" in 0 | 77) continue ;; esac # 77: skipped, for want of a device
    found=$((found + 1))
    case "$code" in
        99) echo "== $name: found" ;;
        124 | 137) echo "== $name: not at its end after $seconds s" ;;
        *) echo "== $name: exit code $code" ;;
    esac
    { grep -E -m 3 -A 12 "runtime error:|ERROR: |WARNING: ThreadSanitizer|Assertion|a mistake in weir" "$out/$name.log" || tail -n 15 "$out/$name.log"; } | sed 's/^/    /'
done <"$out/ended.txt"
rm -rf "$out/files"
echo "$(wc -l <"$out/ended.txt") jobs (part $part of $parts), $found with findings, $SECONDS s; logs in $out"
[ "$found" -eq 0 ]
