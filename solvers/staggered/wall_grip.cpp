#include "staggered/wall_grip.hpp"

#include "staggered/solid_faces.hpp"

#include <algorithm>
#include <cmath>

namespace weir::staggered {

namespace {

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
        const bool shut = !open(a, I);
        if (shut && !grip_.holds_closed) return;
        const real away = distance(a, I);
        if (shut || away <= 0) return hold(a, I, away);
        for (int b = 0; b < D; ++b) {
            if (away >= s_.u.h[b]) continue;
            link(a, b, I, I - e<D>(b), away);
            link(a, b, I, I + e<D>(b), away);
        }
    }

    /// Stores a face inside a body. With holds_closed each closed face belongs to one body; faces that stress does not reach are left out.
    /// It acts on the edges of cells that are not closed, at most two cell diagonals deep in a body.
    void hold(int a, const Index<D>& I, real away) {
        if (!grip_.holds_closed)
            grip_.takes_part[static_cast<std::size_t>(a)](I) = 0;
        else if (away < -3 * norm(s_.u.h) || !its_own(a, I))
            return;
        grip_.inside.push_back({a, I, body_, moves_at<D>(a, s_.u.face_centre(a, I) - at_)});
    }

    void link(int a, int b, const Index<D>& I, const Index<D>& N, real away) {
        if (!s_.u[a].contains(N)) return;
        const real deep = distance(a, N);
        if (deep > 0 && (open(a, N) || !its_own(a, N))) return;
        const real theta = deep < 0 ? std::max(away / (away - deep), least_open_fraction) : 1;
        const Vec<D> x = s_.u.face_centre(a, I), wall = x + theta * (s_.u.face_centre(a, N) - x);
        grip_.links.push_back({a, b, I, N, body_, 1 / theta, moves_at<D>(a, wall - at_), moves_at<D>(a, x - at_)});
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
    for (int a = 0; a < D && !grip.holds_closed; ++a) {
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
