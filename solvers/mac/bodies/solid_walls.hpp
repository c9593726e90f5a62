// Walls of fixed solids and solids with prescribed motion for a viscous fluid. Where a neighbour of a node of a velocity component lies in
// a no-slip solid, the wall is at a distance of θ cells (Gibou, Fedkiw, Cheng & Kang 2002, the symmetric form):
//
//     (u(N) − u(I))/h²  becomes  (u_wall − u(I))/(θ h²).
//
// A free-slip wall removes only the normal velocity. In an implicit solve (u(N) − u(I))/h² becomes −D n_a² u(I)/h², which bounds the stress
// nnᵀ u of a wall with normal n.
#pragma once
#include "geometry/solids.hpp"
#include "mac/grid/state.hpp"

#include <span>
#include <vector>

namespace weir::mac {

template <int D>
class SolidPlacement;

/// A wall between a node and its neighbour in direction `way` along the axis `across`.
template <int D>
struct SolidWall {
    int across, way;
    bool no_slip;
    real nearer;         // 1/θ; for a free-slip wall D n_a²
    real now, last;      // its velocity along the component, now and at the previous time [m/s]
    real rotation_rate;  // ∂v_across/∂x_component of its rigid motion [1/s]
};

/// A node with walls beside it: the entries [begin, end).
template <int D>
struct WallNode {
    Index<D> node;
    std::size_t begin, end;
};

/// An open face whose centre lies in a no-slip solid, and the solid's velocity there.
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
    /// Finds the walls for the solids at `now`; `last` is the time of the previous velocities. Only in planes that this rank owns.
    void find(const MacState<D>& s, const SolidPlacement<D>& placement, real now, real last);
    bool found() const;
    void forget() { found_ = false; }
    /// Returns whether any solid is no-slip.
    bool no_slip() const { return no_slip_; }

    /// 1 on faces whose velocity is changed by viscosity, 0 elsewhere; with ghosts.
    const Padded<D>& takes_part(int a) const { return takes_part_[static_cast<std::size_t>(a)]; }
    std::span<const WallNode<D>> nodes(int a) const { return nodes_[static_cast<std::size_t>(a)]; }
    std::span<const SolidWall<D>> walls(int a, const WallNode<D>& node) const {
        return std::span(walls_[static_cast<std::size_t>(a)]).subspan(node.begin, node.end - node.begin);
    }
    std::span<const HeldFace<D>> held(int a) const { return held_[static_cast<std::size_t>(a)]; }
    /// u = u_solid + `factor` ∇p on held faces: the projection subtracts the gradient again where the pressure does not change.
    void enforce_no_slip(MacState<D>& s, real factor) const;
    /// Friction force and torque [N, N m], with second-order stress at the wall.
    SolidLoad<D> friction(const MacState<D>& s) const;
    std::size_t bytes() const;

private:
    void set_mask(const MacState<D>& s, const SolidPlacement<D>& placement, int a, real margin);
    void find_nodes(const MacState<D>& s, const SolidPlacement<D>& placement, int a);

    std::array<Padded<D>, D> takes_part_;
    std::array<std::vector<WallNode<D>>, D> nodes_;
    std::array<std::vector<SolidWall<D>>, D> walls_;
    std::array<std::vector<HeldFace<D>>, D> held_;
    std::vector<geometry::Pose<D>> last_;  // of each moving solid
    bool no_slip_ = false, found_ = false;
};

/// Force of the pressure on all solids: Σ p S, S the area of solid surface in each fluid cell, whose components are differences of the open
/// fractions of opposite faces.
template <int D>
SolidLoad<D> pressure_load(const MacState<D>& s);

}  // namespace weir::mac
