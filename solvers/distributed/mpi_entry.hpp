// What weir asks of MPI: Slabs, made by a library of their own.
#pragma once
#include "core/slabs.hpp"

namespace weir::distributed {

/// The name in the library of a function that joins the other ranks.
inline constexpr const char* mpi_entry = "weir_mpi_slabs";
using MpiEntry = Slabs* (*)();
/// The name of a function that returns, once they have joined, the time in which waits of this rank slept because other processes were
/// busy.
inline constexpr const char* mpi_busy_entry = "weir_mpi_busy_seconds";
using MpiBusyEntry = double (*)();

}  // namespace weir::distributed
