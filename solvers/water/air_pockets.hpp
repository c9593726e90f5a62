// Enclosed air: connected components of air cells that touch no open side and no emitter. Each pocket conserves Q = p^(1/γ) V (p V^γ =
// const, Poisson 1823), or its volume where the gas is incompressible: Q = V. Where pockets merge Q is added; where one splits, each part
// takes its share of the volume; air that was open is enclosed at the pressure of the open air. The pressure of a pocket follows from its
// volume, so it does not drift. In a pocket of less than three cells across it would follow the error of the volume: there the gas is
// incompressible in this step, and Q is carried on for when the pocket merges.
#pragma once
#include "core/checkpoint.hpp"
#include "free_surface/level_set.hpp"
#include "mac/grid/state.hpp"

#include <cmath>
#include <map>
#include <optional>
#include <utility>
#include <vector>

namespace weir::water {

using namespace free_surface;  // the words of the grid and of its free surface are the solver's own

/// p V^γ = const, with the absolute pressure of the open air, at which air is enclosed [Pa].
struct GasLaw {
    real pressure = 101325;
    real exponent = 1.4;
};

template <int D>
class AirPockets {
public:
    struct Pocket {
        real content = 0;   // Q [Pa^(1/γ) m^D]; incompressible: the volume that it keeps [m^D]
        real volume = 0;    // [m^D]
        real capacity = 0;  // Σ of the open parts of its cells [cells]
        real pressure = 0;  // absolute [Pa]; 0 where the gas is incompressible
        bool resolved = true;
    };

    /// All arguments must outlive it. `closed`: cells inside solids, empty without solids. `part`: the liquid fraction of each cell;
    /// nullptr: that of the level set.
    AirPockets(const Frame<D>& frame, std::optional<GasLaw> law, const LevelSet<D>& surface, const Grid<std::uint8_t, D>& closed,
               const Grid<real, D>* part)
        : frame_(frame), law_(law), surface_(surface), closed_(closed), part_(part) {}

    /// Finds the pockets of state.cells and carries Q over from those found before. state.p: the pressure of the last step.
    void find(const MacState<D>& state);
    const std::vector<Pocket>& pockets() const { return pockets_; }
    /// The pocket of an air cell; nullptr for any other cell.
    const Pocket* pocket(std::size_t cell) const {
        return label_[cell] > open_air ? &pockets_[static_cast<std::size_t>(label_[cell]) - 1] : nullptr;
    }
    /// The pocket of the largest volume; nullptr where there is none.
    const Pocket* largest() const;
    const std::optional<GasLaw>& law() const { return law_; }
    /// Returns whether any air is open: otherwise incompressible gas leaves the pressure undetermined up to a constant.
    bool has_open_air() const { return has_open_air_; }
    /// Open part of an air cell, with a floor that keeps cells at solids in the sums [cells].
    real capacity(const Index<D>& I) const { return std::max(surface_.open_part(I), least_capacity); }
    /// Mean of p over the cells of the largest pocket [Pa].
    real mean_pressure(const Grid<real, D>& p) const;

    /// Of resolved pockets, Σ ∫ (p₀ − p) dV from the volume V₀ at the pressure p₀ of the open air, p₀ V₀^γ = p V^γ; 0 for incompressible
    /// gas [J]. Additive where pockets merge or split at one pressure.
    real elastic_energy() const;

    void save(Checkpoint& to) const;
    void restore(const Checkpoint& from);
    std::size_t bytes() const { return label_.bytes() + air_.bytes() + pockets_.capacity() * sizeof(Pocket); }

private:
    static constexpr int no_air = -1, open_air = 0;  // labels; pocket k has label k + 1
    static constexpr real least_capacity = 1e-3;
    using Overlaps = std::map<std::pair<int, int>, real>;  // volume of air per old and new label [cells]

    real air_in(const Index<D>& I) const;
    template <class F>
    void for_each_open_face(const MacState<D>& state, const Index<D>& I, F&& f) const;
    bool fill(const MacState<D>& state, std::size_t seed, int label);
    void label_components(const MacState<D>& state);
    void measure(const MacState<D>& state);
    std::map<int, real> air_beside(const MacState<D>& state, const Index<D>& I, int steps) const;
    void carry_content(const MacState<D>& state, const Grid<int, D>& old_label, const Grid<real, D>& old_air,
                       const std::vector<Pocket>& old);
    Overlaps overlaps(const MacState<D>& state, const Grid<int, D>& old_label, const Grid<real, D>& old_air, std::size_t old_count) const;
    void set_pressures(const MacState<D>& state, const std::vector<char>& appeared, const std::vector<char>& was_resolved);
    std::vector<real> mean_pressures(const Grid<real, D>& p) const;
    /// Q of a unit of volume at an absolute pressure.
    real content_per_volume(real pressure) const { return law_ ? std::pow(std::max(pressure, real(1)), 1 / law_->exponent) : 1; }

    Frame<D> frame_;
    std::optional<GasLaw> law_;
    const LevelSet<D>& surface_;
    const Grid<std::uint8_t, D>& closed_;
    const Grid<real, D>* part_;
    Grid<int, D> label_;
    Grid<real, D> air_;  // volume of air in each air cell [cells]
    std::vector<Pocket> pockets_;
    bool has_open_air_ = false;
    std::vector<std::size_t> stack_;
};

}  // namespace weir::water
