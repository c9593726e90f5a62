// What liquid below a level set amounts to: energies, momentum, where its surface stands.
#pragma once
#include "core/solver.hpp"
#include "surface/level_set.hpp"

namespace weir::surface {

/// Sums over the liquid's part of every cell that is not closed; `closed` is empty without solids.
template <int D>
class Measure {
public:
    /// `part`: the liquid part of each cell; none: that of the surface.
    Measure(const Frame<D>& frame, const LevelSet<D>& surface, const Grid<std::uint8_t, D>& closed, const Grid<real, D>* part = nullptr)
        : frame_(frame), surface_(surface), closed_(closed), part_(part) {}
    real kinetic_energy(const MacVelocity<D>& u, real rho) const;
    Vec<D> momentum(const MacVelocity<D>& u, real rho) const;
    /// −Σ ρ g·(x − origin) over liquid, which counts where it is in a part-filled cell.
    real potential_energy(const Vec<D>& gravity, real rho) const;
    /// The largest coordinate along an axis at which the surface leaves liquid in its direction.
    real furthest(int axis) const;
    /// The same of the cells at the lower end of x, or of y where `up` is x.
    real height_at_lower_end(int up) const;
    /// All of that, as solvers with a free surface list it; `target`: the volume that the liquid should have.
    std::vector<Integral> integrals(const MacVelocity<D>& u, real rho, const Vec<D>& gravity, int up, real target) const;

private:
    /// Liquid part of a cell; where φ is only continued, in cells that solids close, there is none.
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

}  // namespace weir::surface
