// The sides of the domain: what each of the 2 D ends does to the flow.
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
    bool no_slip = false;             // walls; a moving wall always drags the fluid along
    Vec<D> velocity{};                // of a moving wall or an inflow [m/s]
    std::string profile = "uniform";  // of an inflow
    std::optional<real> temperature;  // Dirichlet value [K]; none: adiabatic
    std::optional<real> smoke;        // carried in by an inflow
};

/// side(axis, 0) is the lower end, side(axis, 1) the upper one.
template <int D>
class Sides {
public:
    Sides() = default;
    /// From "sides" and "grid.periodic" of a scene; a side not named is a free-slip wall.
    explicit Sides(const scene::Scene& scene);
    /// What the sides say of "temperature" or "smoke", for solvers that carry it.
    void read(const scene::Scene& scene, const std::string& field);
    const Side<D>& side(int axis, int end) const { return sides_[static_cast<std::size_t>(2 * axis + end)]; }
    Side<D>& side(int axis, int end) { return sides_[static_cast<std::size_t>(2 * axis + end)]; }
    bool periodic(int axis) const { return side(axis, 0).kind == SideKind::periodic; }
    bool open(int axis, int end) const { return side(axis, end).kind == SideKind::outflow; }

private:
    std::array<Side<D>, 2 * D> sides_;
};

}  // namespace weir::geometry
