// Walls of solids that stand or move by a formula, as a viscous fluid meets them. A node of a velocity component whose neighbour lies in a
// no-slip solid has the wall a part θ of a cell away (Gibou, Fedkiw, Cheng & Kang 2002, the symmetric form):
//
//     (u(N) − u(I))/h²  becomes  (u_wall − u(I))/(θ h²).
//
// A free-slip wall takes only what flows through it: in an implicit solve (u(N) − u(I))/h² becomes −D n_a² u(I)/h², which bounds the
// stress nnᵀ u of a wall with the normal n.
#pragma once
#include "geometry/solids.hpp"
#include "staggered/state.hpp"

#include <span>
#include <vector>

namespace weir::staggered {

template <int D>
class SolidPlacement;

/// A wall between a node and its neighbour, which lies a step of `way` along the axis `across`.
template <int D>
struct SolidWall {
    int across, way;
    bool no_slip;
    real nearer;     // 1/θ; of a free-slip wall D n_a²
    real now, last;  // its velocity along the component, when the walls were found and the time before [m/s]
    real turn;       // ∂v_across/∂x_component of its rigid motion [1/s]
};

/// A node with walls beside it: those from `begin` to before `end`.
template <int D>
struct WallNode {
    Index<D> node;
    std::size_t begin, end;
};

/// A face that is open to flow and has its centre in a no-slip solid, and the solid's velocity there.
template <int D>
struct HeldFace {
    Index<D> face;
    real velocity;
};

/// Force on all solids, and its torque about the origin of coordinates: about z in 2D. [N, N m; per metre of depth in 2D]
template <int D>
struct SolidLoad {
    Vec<D> force{};
    std::array<real, D == 2 ? 1 : 3> torque{};
};

template <int D>
class SolidWalls {
public:
    /// The walls as the solids stand at `now`; `last` is the time of the velocities before. Only of planes that this rank owns.
    void find(const MacState<D>& s, const SolidPlacement<D>& placement, real now, real last);
    bool found() const;
    void forget() { any_ = false; }
    /// Whether the fluid sticks to any solid.
    bool stick() const { return stick_; }

    /// 1 on the faces whose velocity the fluid's viscosity changes, else 0, with ghosts.
    const Padded<D>& takes_part(int a) const { return takes_part_[static_cast<std::size_t>(a)]; }
    std::span<const WallNode<D>> nodes(int a) const { return nodes_[static_cast<std::size_t>(a)]; }
    std::span<const SolidWall<D>> walls(int a, const WallNode<D>& node) const {
        return std::span(walls_[static_cast<std::size_t>(a)]).subspan(node.begin, node.end - node.begin);
    }
    std::span<const HeldFace<D>> held(int a) const { return held_[static_cast<std::size_t>(a)]; }
    /// u = u_solid on held faces, plus `factor` ∇p: what the projection takes away again where the pressure stays as it is.
    void hold(MacState<D>& s, real factor) const;
    /// Of the friction [N, N m], with the stress at the wall to second order.
    SolidLoad<D> friction(const MacState<D>& s) const;
    std::size_t bytes() const;

private:
    void set_mask(const MacState<D>& s, const SolidPlacement<D>& placement, int a, real margin);
    void find_nodes(const MacState<D>& s, const SolidPlacement<D>& placement, int a);

    std::array<Padded<D>, D> takes_part_;
    std::array<std::vector<WallNode<D>>, D> nodes_;
    std::array<std::vector<SolidWall<D>>, D> walls_;
    std::array<std::vector<HeldFace<D>>, D> held_;
    std::vector<geometry::Pose<D>> last_;  // of each solid that moves
    bool stick_ = false, any_ = false;
    int begin_ = 0, end_ = 0;  // the planes that they were found of
};

/// Force of the pressure on all solids: Σ p S, S the area of solid surface in each fluid cell, whose components are differences of the open
/// fractions of opposite faces.
template <int D>
SolidLoad<D> pressure_load(const MacState<D>& s);

}  // namespace weir::staggered
