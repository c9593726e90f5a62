// Programs with windows stand beside weir, so that a run without a window loads no window system.
#pragma once
#include <string>
#include <vector>

namespace weir::app {

/// Becomes the program; `called` is its name in its own messages. Throws BadInput where it is not there.
[[noreturn]] void start_program(const std::string& called, const std::string& program, const std::vector<std::string>& arguments);

}  // namespace weir::app
