// Numbers in the text of a program that a device compiles.
#pragma once
#include <string>

namespace weir {

/// A number as a C compiler reads it back to the last bit.
std::string hex_number(double value);

}  // namespace weir
