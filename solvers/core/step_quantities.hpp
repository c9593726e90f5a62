// The quantities of a step's report by name: the columns of steps.csv, in this order; metrics of cases; what stability studies watch;
// Python.
#pragma once
#include "core/solver.hpp"

#include <array>
#include <string_view>

namespace weir {

struct StepQuantity {
    enum class Kind { number, count, count_if_any };  // count_if_any: zero means that the solver has no such iterations
    const char* name;
    const char* short_name;  // in cases and stability studies as well
    const char* unit;
    Kind kind;
    real (*value)(const StepReport& report);

    bool is_count() const { return kind != Kind::number; }
};

inline constexpr std::array<StepQuantity, 11> step_quantities = {{
    {"dt", "dt", "s", StepQuantity::Kind::number, [](const StepReport& r) { return r.dt; }},
    {"cfl", "cfl", "", StepQuantity::Kind::number, [](const StepReport& r) { return r.cfl; }},
    {"max_divergence", "divergence", "1/s", StepQuantity::Kind::number, [](const StepReport& r) { return r.max_divergence; }},
    {"density_error", "density_error", "", StepQuantity::Kind::number, [](const StepReport& r) { return r.density_error; }},
    {"max_density_error", "max_density_error", "", StepQuantity::Kind::number, [](const StepReport& r) { return r.max_density_error; }},
    {"iterations", "iterations", "", StepQuantity::Kind::count, [](const StepReport& r) { return static_cast<real>(r.iterations); }},
    {"viscous_iterations", "viscous_iterations", "", StepQuantity::Kind::count_if_any,
     [](const StepReport& r) { return static_cast<real>(r.viscous_iterations); }},
    {"viscous_coupling_iterations", "viscous_coupling_iterations", "", StepQuantity::Kind::count_if_any,
     [](const StepReport& r) { return static_cast<real>(r.viscous_coupling_iterations); }},
    {"residual_before", "residual_before", "", StepQuantity::Kind::number, [](const StepReport& r) { return r.residual_before; }},
    {"residual_after", "residual", "", StepQuantity::Kind::number, [](const StepReport& r) { return r.residual_after; }},
    {"residual_max", "residual_max", "", StepQuantity::Kind::number, [](const StepReport& r) { return r.residual_max; }},
}};

/// By its name or its short name; nullptr where there is none.
inline const StepQuantity* find_step_quantity(std::string_view name) {
    for (const StepQuantity& quantity : step_quantities)
        if (quantity.name == name || quantity.short_name == name) return &quantity;
    return nullptr;
}

}  // namespace weir
