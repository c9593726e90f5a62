// Numbers in the source text of a program that a device compiles.
#pragma once
#include <string>

namespace weir {

/// Formats a number so that a C compiler reads it back bit for bit.
std::string hex_number(double value);

}  // namespace weir
