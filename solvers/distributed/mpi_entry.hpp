// What weir asks of MPI: Slabs, made by a library of their own.
#pragma once
#include "core/slabs.hpp"

namespace weir::distributed {

/// The name in the library of a function that joins the other ranks.
inline constexpr const char* mpi_entry = "weir_mpi_slabs";
using MpiEntry = Slabs* (*)();

}  // namespace weir::distributed
