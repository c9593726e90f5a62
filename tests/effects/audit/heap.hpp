// Every allocation of the program, counted: how many there were, and how many bytes are held.
#pragma once

namespace weir::test {

long allocations();
long bytes_held();

}  // namespace weir::test
