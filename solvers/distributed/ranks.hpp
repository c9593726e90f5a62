// A program that mpirun has started several times: how the processes find each other, and how they end together.
#pragma once
#include <string>

namespace weir::distributed {

/// How many processes were started together, and which of them this is, as mpirun, mpiexec or srun tell in the environment; 1 and 0 where
/// nobody does.
int started_ranks();
int started_rank();

/// Threads that each rank of this machine may have where nobody says how many; 0: as many as one process, since there is one, or since
/// mpirun has given each its own processors.
int threads_of_rank();

/// Makes slabs() those of all ranks; what others than rank 0 print goes nowhere. Throws BadInput where this weir has no MPI. Does nothing
/// for one process.
void join();

/// The time so far in which other processes were busy on this rank's processor, so that it slept while it waited for other ranks [s].
double busy_seconds();

/// The end of the program, for all ranks: where all come here they end one after the other, and the answer is `exit_code`. Where one has
/// failed alone, the others wait for it in vain: it says `complaint`, which rank 0 has said where all failed alike, and ends them all.
int leave(int exit_code, const std::string& complaint);

}  // namespace weir::distributed
