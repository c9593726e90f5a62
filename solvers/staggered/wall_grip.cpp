#include "staggered/wall_grip.hpp"

#include "staggered/solid_faces.hpp"

#include <algorithm>
#include <cmath>

namespace weir::staggered {

namespace {

/// The velocity along `a` that a unit of each of the body's velocities gives at r from its centre of mass.
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

template <int D>
class Finder {
public:
    Finder(const MacState<D>& s, const geometry::Solids<D>& solids, WallGrip<D>& grip, std::size_t body)
        : s_(s), solids_(solids), grip_(grip), body_(body), own_(solids.count() - grip.riders.size() + body) {}

    void find() {
        const geometry::Ball<D>& ball = solids_.ball(own_);
        const geometry::Pose<D>& pose = solids_.pose(own_);
        at_ = pose.centre + pose.offset;
        for (int a = 0; a < D; ++a) {
            const Nodes<D> nodes = free_faces(s_.u, s_.sides, a);
            CellBox<D> box;
            for (int d = 0; d < D; ++d) {
                const auto face = [&](real x) { return static_cast<int>(std::floor((x - s_.u.origin[d]) / s_.u.h[d])); };
                box.lo[d] = std::max(nodes.lo[d], face(ball.middle[d] - ball.radius) - 1);
                box.hi[d] = std::min(nodes.hi[d], face(ball.middle[d] + ball.radius) + 3);
            }
            box.in_order([&](const Index<D>& I) { look(a, I); });
        }
    }

private:
    real distance(int a, const Index<D>& I) const { return solids_.distance(own_, s_.u.face_centre(a, I)); }
    bool open(int a, const Index<D>& I) const { return s_.solid.open[static_cast<std::size_t>(a)](I) > 0; }
    bool its_own(int a, const Index<D>& I) const { return solids_.nearest(s_.u.face_centre(a, I)) == own_; }

    void look(int a, const Index<D>& I) {
        if (!open(a, I)) return;
        const real away = distance(a, I);
        if (away <= 0) {
            grip_.takes_part[static_cast<std::size_t>(a)](I) = 0;
            grip_.inside.push_back({a, I, body_, moves_at<D>(a, s_.u.face_centre(a, I) - at_)});
            return;
        }
        for (int b = 0; b < D; ++b) {
            if (away >= s_.u.h[b]) continue;
            link(a, b, I, I - e<D>(b), away);
            link(a, b, I, I + e<D>(b), away);
        }
    }

    void link(int a, int b, const Index<D>& I, const Index<D>& N, real away) {
        if (!s_.u[a].contains(N)) return;
        const real deep = distance(a, N);
        if (deep > 0 && (open(a, N) || !its_own(a, N))) return;
        const real theta = deep < 0 ? std::max(away / (away - deep), least_open_fraction) : 1;
        const Vec<D> x = s_.u.face_centre(a, I), wall = x + theta * (s_.u.face_centre(a, N) - x);
        grip_.links.push_back({a, b, I, N, body_, 1 / theta, moves_at<D>(a, wall - at_)});
    }

    const MacState<D>& s_;
    const geometry::Solids<D>& solids_;
    WallGrip<D>& grip_;
    std::size_t body_, own_;
    Vec<D> at_{};
};

}  // namespace

template <int D>
void find_grip(const MacState<D>& s, const SolidPlacement<D>& placement, WallGrip<D>& grip) {
    for (int a = 0; a < D; ++a) {
        auto& mask = grip.takes_part[static_cast<std::size_t>(a)];
        const auto& open = s.solid.open[static_cast<std::size_t>(a)];
        if (mask.empty()) mask = Padded<D>(open.extent());
        for_each_cell(open.extent(), [&](const Index<D>& I) { mask(I) = open(I) > 0 ? 1 : 0; });
    }
    grip.links.clear(), grip.inside.clear();
    for (std::size_t b = 0; b < grip.riders.size(); ++b)
        if (grip.riders[b].sticks) Finder<D>(s, placement.solids(), grip, b).find();
}

template void find_grip(const MacState<2>&, const SolidPlacement<2>&, WallGrip<2>&);
template void find_grip(const MacState<3>&, const SolidPlacement<3>&, WallGrip<3>&);

}  // namespace weir::staggered
