#!/usr/bin/env bash
# ranks.sh [ROUNDS]: what two processes take for what two threads of one take: five scenes and the four pressure problems, one after the
# other in turns, ROUNDS (5) times, on two processors with nothing beside. A line a pair: the medians, and the median of the rounds' ratios.
set -euo pipefail
root=$(realpath "$(dirname "$0")/../..")
weir=$root/build/release/weir bench=$root/build/release/bench_poisson
source "$root/tests/support/mpirun.sh"
rounds=${1:-5}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
export GOMP_SPINCOUNT=2000

# the mean step of a run, without the first, which allocates [ms]
mean_step() { cut -d, -f2 run/timings.csv | tail -n +3 | awk '{ sum += $1 } END { printf "%.3f", sum / NR }'; }
scene() { # THREADS|ranks SCENE [--set ...]
    local how=$1
    shift
    rm -rf run
    if [ "$how" = ranks ]; then over 2 "$weir" run "$@" --threads 1 --quiet --out run >log 2>&1; else "$weir" run "$@" --threads 2 --quiet --out run >log 2>&1; fi
    mean_step
}
problem() { # threads|ranks NAME
    if [ "$1" = ranks ]; then over 2 "$bench" --case "$2" --dim 3 --threads 1 --csv --solver multigrid; else "$bench" --case "$2" --dim 3 --threads 2 --csv --solver multigrid; fi |
        awk -F, '$5 == "multigrid" { print $7 }'
}
middle() { sort -g | awk '{ v[NR] = $1 } END { print v[int((NR + 1) / 2)] }'; }
compare() { # NAME COMMAND...
    local name=$1 what=$2
    shift 2
    : >threads : >ranks
    for _ in $(seq "$rounds"); do
        "$what" threads "$@" >>threads && echo >>threads
        "$what" ranks "$@" >>ranks && echo >>ranks
    done
    sed -i '/^$/d' threads ranks
    printf '| %s | %.1f | %.1f | %.2f |\n' "$name" "$(middle <threads)" "$(middle <ranks)" "$(paste threads ranks | awk '{ print $2 / $1 }' | middle)"
}
steps() { echo "--set time.end=$1 --set output.every=$1"; }

echo "# Two processes against two threads"
echo "Written by \`benchmarks/ranks/ranks.sh $rounds\`: $("$weir" --version | head -n 1); $(sed -n 's/^model name.*: //p' /proc/cpuinfo | head -n 1)."
echo
echo "| | 2 threads [ms] | 2 ranks [ms] | ratio |"
echo "|---|---|---|---|"
compare "\`mac\`, a step of plume_3d, 64 x 96 x 64" scene plume_3d $(steps 0.5)
if "$weir" list solvers 2>/dev/null | grep -q mac_water && over 2 "$weir" run dam_break_3d $(steps 0.001) --quiet --out probe >log 2>&1; then
    compare "\`mac_water\`, a step of dam_break_3d, 96 x 64 x 48" scene dam_break_3d $(steps 0.2)
fi
compare "\`tallcell\`, a step of the same" scene dam_break_3d --set solver=tallcell --set "scheme={}" $(steps 0.2)
compare "\`pbf\`, a step of dam_break_particles, 32,768" scene dam_break_particles $(steps 0.1)
compare "\`sph\`, a step of those" scene dam_break_particles --set solver=sph --set "scheme={support=2.0}" --set "time={end=0.02}" --set output.every=0.02
for name in box wavy box_weights wavy_weights; do compare "pressure alone, \`$name\`, 128 x 128 x 128" problem $name; done
