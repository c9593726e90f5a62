// Where a fluid with viscosity sticks to bodies: the nodes of a velocity component that have the wall of a body between them and a
// neighbour. The wall stands a part θ of a cell away and holds its own velocity there (Gibou, Fedkiw, Cheng & Kang 2002):
//
//     (u(N) − u(I))/h²  becomes  (u_wall − u(I))/(θ h²),      the body feels  ρν ΔV (u(I) − u_wall)/(θ h²)
//
// so that the body gets what the fluid loses, and the wall is felt where it is and not where the grid's lines are.
#pragma once
#include "rigid/added_mass.hpp"
#include "staggered/ghosts.hpp"

#include <vector>

namespace weir::staggered {

/// The velocity along `a` that a unit of each of a body's velocities gives at r from its centre of mass.
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

/// A node, the neighbour behind the wall of a body, and the wall between them.
template <int D>
struct WallLink {
    int axis, across;  // of the component; from node to neighbour
    Index<D> node, beyond;
    std::size_t body;
    real nearer;            // 1/θ
    rigid::Twist<D> moves;  // the component of the wall's velocity by each of the body's
    rigid::Twist<D> there;  // and of the body's motion at the node itself
};

/// A face with its middle in a body, or closed by it.
template <int D>
struct InsideFace {
    int axis;
    Index<D> face;
    std::size_t body;
    rigid::Twist<D> moves;
};

/// A body as friction meets it: what is known of it before, and the impulse that it gets.
template <int D>
struct Rider {
    bool sticks = false;
    rigid::Block<D> mass{};               // its own, and the fluid's that has to move with it
    rigid::Twist<D> velocity{}, drive{};  // before; the impulse of all else in this step as far as it is foretold
    std::array<bool, rigid::freedoms<D>> held{};
    real turning = 0;  // 2 ρν V: see wall_grip.cpp
    rigid::Twist<D> impulse{};

    rigid::Twist<D> with_mass(const rigid::Twist<D>& v) const {
        rigid::Twist<D> sum{};
        for (std::size_t k = 0; k < v.size(); ++k)
            for (std::size_t l = 0; l < v.size(); ++l) sum[k] += mass[k][l] * v[l];
        return sum;
    }
};

template <int D>
struct WallGrip {
    bool holds_closed = false;            // `inside` has the faces that bodies close, too, as deep as stress reaches; takes_part is empty
    std::array<Padded<D>, D> takes_part;  // 1 on the faces where the fluid's velocity is its own
    std::vector<WallLink<D>> links;
    std::vector<InsideFace<D>> inside;  // those that the pressure still knows
    std::vector<Rider<D>> riders;       // one a body

    static real along(const rigid::Twist<D>& moves, const rigid::Twist<D>& velocity) {
        real v = 0;
        for (std::size_t k = 0; k < moves.size(); ++k) v += moves[k] * velocity[k];
        return v;
    }
    std::size_t bytes() const {
        std::size_t total = links.capacity() * sizeof(WallLink<D>) + inside.capacity() * sizeof(InsideFace<D>);
        for (const auto& mask : takes_part) total += mask.bytes();
        return total + riders.capacity() * sizeof(Rider<D>);
    }
};

template <int D>
struct MacState;
template <int D>
class SolidPlacement;

/// Finds faces and walls of the bodies that stick, as they stand; they are the last `riders` of the solids.
template <int D>
void find_grip(const MacState<D>& s, const SolidPlacement<D>& placement, WallGrip<D>& grip);

}  // namespace weir::staggered
