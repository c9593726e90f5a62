// hypre's conjugate gradients preconditioned by PFMG (Ashby & Falgout 1996): the fastest peer measured. Debian's hypre has no threads, so
// two of them are two MPI ranks, and the measurement is a process of its own.
#pragma once
#include <string>

namespace weir::bench {

struct PfmgResult {
    double setup_ms = 0, solve_ms = 0, residual = 0, bytes = 0;
    int iterations = 0;
    std::string failure;  // why there is no result
};

/// Starts this program again as `ranks` MPI processes and reads what they measured.
PfmgResult run_pfmg(const std::string& program, const std::string& name, int dim, int n, int ranks, int repeat, double ratio);

/// What such a process does; prints one line from rank 0.
int pfmg_process(const std::string& name, int dim, int n, int repeat, double ratio);

}  // namespace weir::bench
