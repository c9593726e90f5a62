// A field that a metric cannot do without.
#pragma once
#include "core/error.hpp"
#include "core/solver.hpp"

#include <string>
#include <string_view>

namespace weir::validation {

/// Throws BadInput where the solver does not show it.
inline const FieldView& needed_field(const FieldSet& fields, std::string_view set, std::string_view name) {
    if (const FieldView* field = fields.find(set, name)) return *field;
    throw BadInput("the solver shows no field \"" + std::string(name) + "\" of " + std::string(set));
}

}  // namespace weir::validation
