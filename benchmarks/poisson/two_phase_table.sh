#!/usr/bin/env bash
# two_phase_table.sh [BEFORE]: iterations and time of `multigrid` for all shapes of two phases, on one thread. BEFORE: a bench_poisson of an
# earlier build, which is measured in turns with the present one. Times are setup and solve per unknown, the least of the runs. On one processor
# with nothing beside, about four minutes. ROUNDS=1: one run each.
set -euo pipefail
root=$(realpath "$(dirname "$0")/../..")
now=$root/build/release/bench_poisson
export GOMP_SPINCOUNT=2000 OMP_NUM_THREADS=1
rounds=${ROUNDS:-3}

measure() { # label, program, arguments: label, shape, dim, n, iterations, ns per unknown of setup and solve
    local label=$1 program=$2
    shift 2
    "$program" --threads 1 --csv --solver multigrid --repeat 3 "$@" | awk -F, -v label="$label" -v ratio="$ratio" '
        /^[a-z]/ && $1 != "case" { unknowns = 1e6 * $7 / $10; print label, $1, $2, $3, ratio, $8, 1e6 * ($6 + $7) / unknowns }'
}
one_round() { # programs
    for program in "$@"; do
        [ "$program" = "$now" ] && label=now || label=before
        measure "$label" "$program" --dim "$dim" --n "$n" --ratio "$ratio" "${shapes[@]}"
    done
}

{
    for grid in "2 256" "2 1024" "3 64" "3 128"; do
        read -r dim n <<< "$grid"
        for ratio in 1000 100 10; do
            shapes=(--two-phase)
            [ "$ratio" = 1000 ] || shapes=(--case film --case gas_film)
            for ((k = 0; k < rounds; k++)); do one_round ${1:+"$1"} "$now"; done
        done
    done
} | awk -v earlier="${1:+1}" '
    function cell(label, grid,   key) {
        key = label SUBSEP name SUBSEP grid
        return (key in least) ? sprintf("%d, %.0f", iterations[key], least[key]) : ""
    }
    {
        name = $2 " at " $5 ":1"; key = $1 SUBSEP name SUBSEP $3 "D " $4
        if (!(name in known)) { known[name] = 1; order[++count] = name }
        if (!(key in least) || $7 < least[key]) least[key] = $7
        iterations[key] = $6
    }
    END {
        print "| shape | before or now | 2D 256² | 2D 1024² | 3D 64³ | 3D 128³ |\n|---|---|---|---|---|---|"
        for (i = 1; i <= count; i++) {
            name = order[i]
            for (k = earlier ? 1 : 2; k <= 2; k++) {
                label = k == 1 ? "before" : "now"
                printf "| %s | %s | %s | %s | %s | %s |\n", name, label, cell(label, "2D 256"), cell(label, "2D 1024"), cell(label, "3D 64"), cell(label, "3D 128")
            }
        }
    }'
