#include "mac/bodies/no_slip_walls.hpp"

#include "mac/bodies/solid_faces.hpp"

#include <algorithm>
#include <cmath>

namespace weir::mac {

namespace {

template <int D>
class Finder {
public:
    Finder(const MacState<D>& s, const geometry::Solids<D>& solids, NoSlipWalls<D>& no_slip_walls, std::size_t body)
        : s_(s), solids_(solids), no_slip_walls_(no_slip_walls), body_(body), own_(solids.count() - no_slip_walls.bodies.size() + body) {}

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
        if (shut && !no_slip_walls_.holds_closed) return;
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
        if (!no_slip_walls_.holds_closed)
            no_slip_walls_.takes_part[static_cast<std::size_t>(a)](I) = 0;
        else if (away < -3 * norm(s_.u.h) || !its_own(a, I))
            return;
        no_slip_walls_.inside.push_back({a, I, body_, moves_at<D>(a, s_.u.face_centre(a, I) - at_)});
    }

    void link(int a, int b, const Index<D>& I, const Index<D>& N, real away) {
        if (!s_.u[a].contains(N)) return;
        const real deep = distance(a, N);
        if (deep > 0 && (open(a, N) || !its_own(a, N))) return;
        const real theta = deep < 0 ? std::max(away / (away - deep), least_open_fraction) : 1;
        const Vec<D> x = s_.u.face_centre(a, I), wall = x + theta * (s_.u.face_centre(a, N) - x);
        no_slip_walls_.links.push_back({a, b, I, N, body_, 1 / theta, moves_at<D>(a, wall - at_), moves_at<D>(a, x - at_)});
    }

    const MacState<D>& s_;
    const geometry::Solids<D>& solids_;
    NoSlipWalls<D>& no_slip_walls_;
    std::size_t body_, own_;
    Vec<D> at_{};
};

}  // namespace

template <int D>
void find_no_slip_walls(const MacState<D>& s, const SolidPlacement<D>& placement, NoSlipWalls<D>& no_slip_walls) {
    for (int a = 0; a < D && !no_slip_walls.holds_closed; ++a) {
        auto& mask = no_slip_walls.takes_part[static_cast<std::size_t>(a)];
        const auto& open = s.solid.open[static_cast<std::size_t>(a)];
        if (mask.empty()) mask = Padded<D>(open.extent());
        for_each_cell(open.extent(), [&](const Index<D>& I) { mask(I) = open(I) > 0 ? 1 : 0; });
    }
    no_slip_walls.links.clear(), no_slip_walls.inside.clear();
    for (std::size_t b = 0; b < no_slip_walls.bodies.size(); ++b)
        if (no_slip_walls.bodies[b].coupled) Finder<D>(s, placement.solids(), no_slip_walls, b).find();
}

template void find_no_slip_walls(const MacState<2>&, const SolidPlacement<2>&, NoSlipWalls<2>&);
template void find_no_slip_walls(const MacState<3>&, const SolidPlacement<3>&, NoSlipWalls<3>&);

}  // namespace weir::mac
