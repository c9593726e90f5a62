// Ghost layers, filled a row at a time, against the rules written node by node.
#include "mac/grid/ghosts.hpp"

#include "support/test.hpp"

namespace weir::mac::ghosts_tests {

namespace {

using Kind = EndRule::Kind;

/// Fills the layers of one axis for the line through I, as the comment at the head of ghosts.hpp says.
template <int D>
void fill_line(Padded<D>& q, int axis, const Boundary<D>& boundary, const Index<D>& I, std::size_t side_node) {
    const int n = q.extent()[axis], cells = n - (axis == boundary.node_axis ? 1 : 0);
    const auto at = [&](int i) -> real& {
        Index<D> J = I;
        J[axis] = i;
        return q(J);
    };
    if (boundary.end[static_cast<std::size_t>(axis)][0].kind == Kind::periodic && cells < n) at(cells) = at(0);
    for (int end = 0; end < 2; ++end) {
        const EndRule& rule = boundary.end[static_cast<std::size_t>(axis)][static_cast<std::size_t>(end)];
        for (int k = 1; k <= ghost_layers; ++k) {
            const auto inside = [&](int j) { return end == 0 ? j : n - 1 - j; };
            real& outer = at(end == 0 ? -k : n - 1 + k);
            if (rule.kind == Kind::periodic) outer = at(((end == 0 ? -k : n - 1 + k) + cells) % cells);
            if (rule.kind == Kind::dirichlet) outer = 2 * rule.value_at(side_node) - at(inside(k - 1));
            if (rule.kind == Kind::neumann) outer = at(inside(k - 1));
            if (rule.kind == Kind::odd_about_node) outer = 2 * at(inside(0)) - at(inside(k));
            if (rule.kind == Kind::constant_beyond_node) outer = at(inside(0));
        }
    }
}

}  // namespace

TEST_IN_2D_AND_3D("ghost layers are what their rules say, corners included, profiles and periodic axes too") {
    const Kind kinds[] = {Kind::dirichlet, Kind::neumann, Kind::odd_about_node, Kind::constant_beyond_node, Kind::periodic};
    for (int node_axis = -1; node_axis < D; ++node_axis)
        for (std::size_t turn = 0; turn < std::size(kinds); ++turn) {
            Extent<D> extent(Index<D>::constant(5));
            for (int d = 0; d < D; ++d) extent[d] += d;
            if (node_axis >= 0) ++extent[node_axis];
            Boundary<D> boundary;
            boundary.node_axis = node_axis;
            for (std::size_t a = 0; a < D; ++a)
                for (std::size_t end = 0; end < 2; ++end) {
                    Kind kind = kinds[(turn + 2 * a + end) % 4];
                    if (kinds[(turn + a) % std::size(kinds)] == Kind::periodic) kind = Kind::periodic;
                    boundary.end[a][end] = {kind, 0.25 + static_cast<real>(a), {}};
                    if (kind == Kind::dirichlet && end == 1)
                        for (int i = 0; i < 512; ++i) boundary.end[a][end].profile.push_back(std::sin(1.0 * i));
                }
            Grid<real, D> inner(extent);
            for (std::size_t i = 0; i < inner.size(); ++i) inner[i] = std::cos(1.3 * static_cast<real>(i));
            Padded<D> fast(extent), plain(extent);
            fill(fast, inner, boundary);
            for_each_cell(extent, [&](const Index<D>& I) { plain(I) = inner(I); });
            for (int axis = 0; axis < D; ++axis) {
                Index<D> lo{}, nodes = extent;
                Extent<D> hi = extent;
                for (int b = 0; b < axis; ++b) lo[b] = -ghost_layers, hi[b] += ghost_layers;
                hi[axis] = nodes[axis] = 1;
                for_each_in(lo, hi, [&](const Index<D>& I) {
                    std::size_t side_node = 0;
                    for (int d = D - 1; d >= 0; --d)
                        side_node =
                            side_node * static_cast<std::size_t>(nodes[d]) + static_cast<std::size_t>(std::clamp(I[d], 0, nodes[d] - 1));
                    fill_line(plain, axis, boundary, I, side_node);
                });
            }
            const Index<D> ghosts = Index<D>::constant(ghost_layers);
            for_each_in(Index<D>{} - ghosts, extent + ghosts, [&](const Index<D>& I) { EXPECT_EQ(fast(I), plain(I)); });
        }
}

}  // namespace weir::mac::ghosts_tests
