// Integrals of the liquid inside a level set: energies, momentum, and the height of its surface.
#pragma once
#include "core/solver.hpp"
#include "free_surface/level_set.hpp"

namespace weir::free_surface {

/// Sums over the liquid fraction of every cell that is not closed; `closed` is empty without solids.
template <int D>
class Measure {
public:
    /// `part`: the liquid fraction of each cell; nullptr: that of the level set.
    Measure(const Frame<D>& frame, const LevelSet<D>& surface, const Grid<std::uint8_t, D>& closed, const Grid<real, D>* part = nullptr)
        : frame_(frame), surface_(surface), closed_(closed), part_(part) {}
    real kinetic_energy(const MacVelocity<D>& u, real rho) const;
    Vec<D> momentum(const MacVelocity<D>& u, real rho) const;
    /// −Σ ρ g·(x − origin) over the liquid, at its centroid in partly filled cells.
    real potential_energy(const Vec<D>& gravity, real rho) const;
    /// The largest coordinate along an axis at which the surface bounds liquid from above.
    real furthest(int axis) const;
    /// The same for the cells at the lower end of x, or of y where `up` is x.
    real height_at_lower_end(int up) const;
    /// All of these, as the integrals of solvers with a free surface; `target`: the volume that the liquid should have.
    std::vector<Integral> integrals(const MacVelocity<D>& u, real rho, const Vec<D>& gravity, int up, real target) const;

private:
    /// Liquid fraction of a cell; 0 in cells closed by solids, where φ is only extrapolated.
    real liquid_part(const Index<D>& I) const {
        if (part_) return (*part_)(I);
        return !closed_.empty() && closed_(I) ? 0 : surface_.open_part(I) * surface_.fraction(I);
    }
    Vec<D> middle(const Index<D>& I) const;
    real crossing(const Index<D>& I, int axis) const;
    template <class F>
    real sum_over_faces(int a, F&& f) const;

    const Frame<D>& frame_;
    const LevelSet<D>& surface_;
    const Grid<std::uint8_t, D>& closed_;
    const Grid<real, D>* part_;
};

}  // namespace weir::free_surface
