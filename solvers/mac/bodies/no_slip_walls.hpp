// No slip on bodies in a viscous fluid: the nodes of a velocity component with the wall of a body between them and a neighbour. The wall is
// at a distance of θ cells and imposes its velocity there (Gibou, Fedkiw, Cheng & Kang 2002):
//
//     (u(N) − u(I))/h²  becomes  (u_wall − u(I))/(θ h²),      force on the body  ρν ΔV (u(I) − u_wall)/(θ h²)
//
// The body gets the momentum that the fluid loses, and the wall has subgrid accuracy.
#pragma once
#include "mac/grid/ghosts.hpp"
#include "rigid/added_mass.hpp"

#include <vector>

namespace weir::mac {

/// The velocity along `a` at r from the centre of mass, per unit of each of a body's velocities.
template <int D>
rigid::Twist<D> moves_at(int a, const Vec<D>& r) {
    rigid::Twist<D> moves{};
    moves[static_cast<std::size_t>(a)] = 1;
    if constexpr (D == 2)
        moves[2] = a == 0 ? -r[1] : r[0];
    else  // (e × r)_a
        for (int k = 0; k < 3; ++k)
            if (k != a) moves[static_cast<std::size_t>(3 + k)] = (k + 1) % 3 == a ? -r[3 - a - k] : r[3 - a - k];
    return moves;
}

/// A no-slip wall link: a node, its neighbour behind the wall of a body, and the wall between them.
template <int D>
struct WallLink {
    int axis, across;  // axis of the component; axis from node to neighbour
    Index<D> node, beyond;
    std::size_t body;
    real nearer;            // 1/θ
    rigid::Twist<D> moves;  // the wall's velocity component, per unit of each of the body's velocities
    rigid::Twist<D> there;  // the same for the body's motion at the node itself
};

/// A face whose centre lies in a body, or that a body closes.
template <int D>
struct InsideFace {
    int axis;
    Index<D> face;
    std::size_t body;
    rigid::Twist<D> moves;
};

/// A no-slip body in the friction solve: its given data and the resulting impulse.
template <int D>
struct NoSlipBody {
    bool coupled = false;
    rigid::Block<D> mass{};               // its own and the added mass
    rigid::Twist<D> velocity{}, drive{};  // at the start of the step; estimate of all other impulses in this step
    std::array<bool, rigid::freedoms<D>> held{};
    real turning = 0;  // 2 ρν V: see no_slip_walls.cpp
    rigid::Twist<D> impulse{};

    rigid::Twist<D> with_mass(const rigid::Twist<D>& v) const {
        rigid::Twist<D> sum{};
        for (std::size_t k = 0; k < v.size(); ++k)
            for (std::size_t l = 0; l < v.size(); ++l) sum[k] += mass[k][l] * v[l];
        return sum;
    }
};

template <int D>
struct NoSlipWalls {
    bool holds_closed = false;            // `inside` includes faces closed by bodies, as deep as stress reaches; takes_part is empty
    std::array<Padded<D>, D> takes_part;  // 1 on the faces whose velocity is an unknown of the fluid
    std::vector<WallLink<D>> links;
    std::vector<InsideFace<D>> inside;  // faces that are open to the pressure
    std::vector<NoSlipBody<D>> bodies;  // one per body

    static real along(const rigid::Twist<D>& moves, const rigid::Twist<D>& velocity) {
        real v = 0;
        for (std::size_t k = 0; k < moves.size(); ++k) v += moves[k] * velocity[k];
        return v;
    }
    std::size_t bytes() const {
        std::size_t total = links.capacity() * sizeof(WallLink<D>) + inside.capacity() * sizeof(InsideFace<D>);
        for (const auto& mask : takes_part) total += mask.bytes();
        return total + bodies.capacity() * sizeof(NoSlipBody<D>);
    }
};

template <int D>
struct MacState;
template <int D>
class SolidPlacement;

/// Finds the faces and wall links of no-slip bodies in their present position; bodies are the last entries of the solids.
template <int D>
void find_no_slip_walls(const MacState<D>& s, const SolidPlacement<D>& placement, NoSlipWalls<D>& no_slip_walls);

}  // namespace weir::mac
