// The sides of the domain: the boundary condition at each of the 2 D ends.
#pragma once
#include "core/types.hpp"
#include "scene/scene.hpp"

#include <array>
#include <optional>
#include <string>

namespace weir::geometry {

enum class SideKind { wall, moving_wall, inflow, outflow, periodic };

template <int D>
struct Side {
    SideKind kind = SideKind::wall;
    bool no_slip = false;             // walls; a moving wall is always no-slip
    Vec<D> velocity{};                // of a moving wall or an inflow [m/s]
    std::string profile = "uniform";  // of an inflow
    std::optional<real> temperature;  // Dirichlet value [K]; nullopt: adiabatic
    std::optional<real> smoke;        // advected in by an inflow
};

/// side(axis, 0) is the lower end, side(axis, 1) the upper one.
template <int D>
class Sides {
public:
    Sides() = default;
    /// From "sides" and "grid.periodic" of a scene; a side not named is a free-slip wall.
    explicit Sides(const scene::Scene& scene);
    /// Reads the sides' values of "temperature" or "smoke", for solvers that advect it.
    void read(const scene::Scene& scene, const std::string& field);
    const Side<D>& side(int axis, int end) const { return sides_[static_cast<std::size_t>(2 * axis + end)]; }
    Side<D>& side(int axis, int end) { return sides_[static_cast<std::size_t>(2 * axis + end)]; }
    bool periodic(int axis) const { return side(axis, 0).kind == SideKind::periodic; }
    bool open(int axis, int end) const { return side(axis, end).kind == SideKind::outflow; }

private:
    std::array<Side<D>, 2 * D> sides_;
};

}  // namespace weir::geometry
