// The entry points of the MPI library of weir, which implements Communicator.
#pragma once
#include "parallel/communicator.hpp"

namespace weir::distributed {

/// The name of the function that joins the other ranks.
inline constexpr const char* mpi_entry = "weir_mpi_communicator";
using MpiEntry = Communicator* (*)();

}  // namespace weir::distributed
