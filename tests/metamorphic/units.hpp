// Units of the schema as exponents: how a quantity changes when lengths, times and masses are measured in other units.
#pragma once
#include <string_view>

namespace weir::metamorphic {

struct Dimension {
    double length = 0, time = 0, mass = 0;
};

/// Of a unit as the schema writes it: "kg/(m^3 s)", "s/m^(1/3)", "W/(m^2 K)"; temperature and angle have no exponent here. Throws
/// std::logic_error for a unit that is not known, so that a new one cannot be passed over.
Dimension dimension_of(std::string_view unit);

/// New units over old ones: a length of 1 becomes `length`.
struct UnitScale {
    double length = 1, time = 1, mass = 1;
    bool is_one() const { return length == 1 && time == 1 && mass == 1; }
    double of(const Dimension& d) const;
    double of(std::string_view unit) const { return of(dimension_of(unit)); }
};

}  // namespace weir::metamorphic
