// Formulas in scenes, such as "0.2 - 0.05*(x-10)^2": numbers, variables by name, + - * / ^, comparisons, brackets and functions.
// Read and evaluated by muParser.
#pragma once
#include "core/types.hpp"
#include "scene/scene.hpp"

#include <functional>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace weir::scene {

/// An error in a formula and its position: `at` counts characters from 0.
struct BadFormula : std::runtime_error {
    BadFormula(int at_, int width_, const std::string& what) : std::runtime_error(what), at(at_), width(width_) {}
    int at, width;
};

/// Thread-safe by a lock: concurrent calls wait for one another; a copy is the same formula.
class Formula {
public:
    Formula() = default;
    /// Throws BadFormula. `variables` in the order in which values are given.
    Formula(std::string_view text, const std::vector<std::string>& variables);
    /// NaN or infinity where the formula has no value. One value per variable; further ones are ignored. Throws std::logic_error where
    /// there are fewer.
    real operator()(std::span<const real> values) const;
    bool empty() const { return compiled_ == nullptr; }
    /// The vocabulary of formulas, for hints and manuals.
    static const std::string& words();

private:
    struct Compiled;
    std::shared_ptr<Compiled> compiled_;
};

/// The variant "formula" of an initial field: a function of position, with its text at the key `value`.
Variant formula_variant(const char* unit);
/// That formula. NaN or infinity where it has no value.
template <int D>
std::function<real(const Vec<D>&)> formula_of_place(const Scene& scene, std::string_view path);

/// Reads a formula from a key of type text; throws BadScene with the position of an error.
Formula formula_at(const Scene& scene, std::string_view path, const std::vector<std::string>& variables);

}  // namespace weir::scene
