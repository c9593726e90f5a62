// A program that mpirun has started several times: how the processes join and how they end together.
#pragma once
#include <functional>
#include <string>

namespace weir::distributed {

/// The number of processes started together, and the rank of this one, from the environment of mpirun, mpiexec or srun; 1 and 0 without a
/// launcher.
int started_ranks();
int started_rank();

/// Default number of threads for each rank of this machine. 0: as for one process, because there is only one or because mpirun bound each
/// rank to its own processors.
int threads_of_rank();

/// Number of ranks that this program forks itself, without MPI, for tests: WEIR_FORKED_RANKS; 1 without it.
/// Throws BadInput for anything but a number from 1 to 16.
int forked_ranks();
/// run() as each of these ranks, in a process of its own with one thread unless it asks for more; output of ranks other than 0 is hidden.
/// Returns exit_success if all ranks do; else the exit code of a rank that failed by itself: those that wait for it end with
/// exit_internal_error.
int run_on_forked_ranks(int ranks, const std::function<int()>& run);

/// Makes communicator() the communicator of all ranks and hides the output of ranks other than 0. Throws BadInput where this weir was built
/// without MPI. Does nothing for one process.
void join();

/// Ends the program on all ranks. Where all ranks arrive they exit one after another and the result is `exit_code`. Where one failed alone,
/// the others never arrive: it prints `complaint` (which rank 0 has printed where all failed alike) and aborts all ranks.
int leave(int exit_code, const std::string& complaint);

}  // namespace weir::distributed
