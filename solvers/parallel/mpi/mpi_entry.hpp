// The entry points of the MPI library of weir, which implements Communicator.
#pragma once
#include "parallel/communicator.hpp"

namespace weir::distributed {

/// The name of the function that joins the other ranks.
inline constexpr const char* mpi_entry = "weir_mpi_communicator";
using MpiEntry = Communicator* (*)();
/// The name of the function that returns the time, since the start, in which this rank slept while waiting because other processes were
/// busy.
inline constexpr const char* mpi_busy_entry = "weir_mpi_busy_seconds";
using MpiBusyEntry = double (*)();

}  // namespace weir::distributed
