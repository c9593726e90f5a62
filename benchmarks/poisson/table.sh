#!/usr/bin/env bash
# table.sh: what peers take for a pressure problem, and how many times the multigrid's time that is: all on one thread, and PETSc's methods
# over two ranks, where the multigrid has two as well. On two processors with nothing beside, about ten minutes.
set -euo pipefail
root=$(realpath "$(dirname "$0")/../..")
bench=$root/build/release/bench_poisson
source "$root/tests/support/mpirun.sh"
export GOMP_SPINCOUNT=2000

rows() { # comma-separated values to lines of a table, problem by problem
    awk -F, '
        function tell(   i, f) {
            for (i = 1; i <= count; i++) {
                if (split(line[i], f, ",") == 6) printf "| `%s`, %d^%d | `%s` | %s | | | | | | |\n", f[1], f[3], f[2], f[5], f[6]
                else printf "| `%s`, %d^%d | `%s` | %.0f | %.1f | %d | %.0e | %.1f | %.0f | %.1f |\n", f[1], f[3], f[2], f[5], f[6], f[7], f[8], f[9], f[10], f[11], f[7] / ours
            }
            count = 0
        }
        $1 == "case" { next }
        { sub(/^# /, "") }
        $1 FS $2 != problem { tell(); problem = $1 FS $2 }
        { line[++count] = $0 }
        $5 == "multigrid" { ours = $7 }
        END { tell() }'
}
head='| problem | method | setup [ms] | solve [ms] | iterations | residual | ns an unknown | bytes an unknown | times multigrid |
|---|---|---|---|---|---|---|---|---|'

echo "# The pressure equation: the multigrid and its peers"
echo "Written by \`benchmarks/poisson/table.sh\`: $("$root"/build/release/weir --version | head -n 1); $(sed -n 's/^model name.*: //p' /proc/cpuinfo | head -n 1)."
echo
echo "Solved to 1e-8 of the right-hand side; the residual is the true one. \`pfmg_cg\` is hypre's, the \`petsc_\` ones PETSc's conjugate gradients with its"
echo "GAMG, hypre's BoomerAMG and incomplete Cholesky."
echo
echo "## One thread"
echo "$head"
{
    "$bench" --threads 1 --csv --dim 2 --n 512
    "$bench" --threads 1 --csv --dim 3 --n 96
} | rows
echo
echo "## Two ranks"
echo "\`petsc_icc\` factors each rank's rows for themselves."
echo
echo "$head"
over 2 "$bench" --threads 1 --csv --dim 3 --n 96 --solver multigrid --solver petsc_gamg --solver petsc_boomeramg --solver petsc_icc | rows
