#include "fuzz/read_any.hpp"
#include "fuzz/targets.hpp"
#include "unit/scene/schema.hpp"

bool weir::fuzz::made_up(std::string_view bytes) { return read_any(bytes, scene::made_up::schemas()).has_value(); }
