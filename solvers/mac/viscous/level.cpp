// Storage and ghosts of a level.
#include "mac/viscous/level.hpp"

#include <algorithm>

namespace weir::mac::viscous {

using Kind = EndRule::Kind;

template <int D>
Level<D>::Level(const Index<D>& cells_, const Vec<D>& h_, const std::array<Boundary<D>, D>& boundary_)
    : cells(cells_), h(h_), boundary(boundary_), mass(cells), inverse(cells), mu(cells), x(cells), other(cells), b(cells) {
    shear.fill(Field<D>(cells));
    for (int a = 0; a < D; ++a) {
        const auto at = static_cast<std::size_t>(a);
        const auto& ends = boundary[at].end[at];
        hi[at] = cells;
        if (ends[0].kind == Kind::odd_about_node) lo[at][a] = 1;
        if (ends[1].kind == Kind::constant_beyond_node) ++hi[at][a];
    }
}

template <int D>
std::size_t Level<D>::unknowns() const {
    std::size_t total = 0;
    for (std::size_t a = 0; a < D; ++a) total += product(hi[a] - lo[a]);
    return total;
}

template <int D>
std::size_t Level<D>::bytes() const {
    std::size_t total = stiff_edges.capacity() * sizeof(StiffEdge);
    for (const auto& mu_at : shear) total += mu_at.bytes();
    for (const Faces<D>* faces : {&mass, &inverse, &mu, &x, &other, &b})
        for (const auto& field : faces->component) total += field.bytes();
    return total;
}

namespace {

/// q = factor q(from) at `to`, along one axis.
struct Copy {
    int from, to;
    float factor;
};
struct Copies {
    std::array<Copy, 2 * ghosts + 2> list{};
    int count = 0;
    void add(int from, int to, float factor) { list[static_cast<std::size_t>(count++)] = {from, to, factor}; }
    const Copy* begin() const { return list.data(); }
    const Copy* end() const { return list.data() + count; }
};

struct Factors {
    float half_way = 1, beyond_node = 0;
};

Factors factors_of(EndRule::Kind kind, Ghosts kind_of_ghosts) {
    if (kind_of_ghosts == Ghosts::even) return {1, 0};
    const float half_way = kind == Kind::dirichlet ? -1 : 1;
    if (kind_of_ghosts == Ghosts::transpose) return {half_way, 0};
    return {half_way, kind == Kind::constant_beyond_node ? 1.0f : 0.0f};
}

/// Those of a field of n cells that has nodes on the sides (on_node) or half a cell from them. `alone`: nothing beyond the last cell enters
/// the transpose, because the prolongation to it reads no value there.
Copies copies_of(int n, bool on_node, bool alone, const std::array<EndRule, 2>& ends, Ghosts kind) {
    Copies copies;
    if (ends[0].kind == Kind::periodic) {
        for (int k = 1; k <= ghosts; ++k) copies.add(((n - k) % n + n) % n, -k, 1);
        for (int k = n; k <= n + ghosts; ++k) copies.add(k % n, k, 1);
        return copies;
    }
    const Factors lower = factors_of(ends[0].kind, kind), upper = factors_of(ends[1].kind, kind);
    if (on_node) {
        copies.add(0, -1, lower.beyond_node);
        copies.add(n, n + 1, upper.beyond_node);
    } else {
        copies.add(0, -1, lower.half_way);
        copies.add(n - 1, n, alone ? 0 : upper.half_way);
        copies.add(std::max(n - 2, 0), n + 1, kind == Ghosts::even ? 1 : 0);
    }
    return copies;
}

/// The ghosts within one plane of the slowest axis.
template <int D>
void fill_plane(Field<D>& q, const Index<D>& cells, const std::array<Copies, D>& copies, int plane) {
    Index<D> I{};
    I[D - 1] = plane;
    const int rows = D == 2 ? 1 : cells[1] + 1;
    for (int j = 0; j < rows; ++j) {
        if constexpr (D == 3) I[1] = j;
        float* row = q.at(I);
        for (const Copy& copy : copies[0]) row[copy.to] = copy.factor * row[copy.from];
    }
    if constexpr (D == 3) {
        I[0] = -ghosts, I[1] = 0;
        float* rows_at = q.at(I);
        for (const Copy& copy : copies[1]) {
            const float* from = rows_at + copy.from * q.stride(1);
            float* to = rows_at + copy.to * q.stride(1);
            for (int i = 0; i < q.stride(1); ++i) to[i] = copy.factor * from[i];
        }
    }
}

/// The planes beyond both ends of the slowest axis.
template <int D>
void fill_end_planes(Field<D>& q, const Copies& copies) {
    Index<D> I = Index<D>::constant(-ghosts);
    I[D - 1] = 0;
    for (const Copy& copy : copies) {
        const float* from = q.at(I) + copy.from * q.stride(D - 1);
        float* to = q.at(I) + copy.to * q.stride(D - 1);
        for (std::ptrdiff_t i = 0; i < q.stride(D - 1); ++i) to[i] = copy.factor * from[i];
    }
}

template <int D>
std::array<Copies, D> copies_of(const Level<D>& level, const OnNodes<D>& on_nodes, const Boundary<D>& boundary, Ghosts kind) {
    std::array<Copies, D> copies;
    for (std::size_t d = 0; d < D; ++d) {
        const int n = level.cells[static_cast<int>(d)];
        const bool alone = kind == Ghosts::transpose && level.halved[d] && n % 2 != 0;
        copies[d] = copies_of(n, on_nodes[d], alone, boundary.end[d], kind);
    }
    return copies;
}

}  // namespace

template <int D>
void fill_ghosts(const Level<D>& level, Faces<D>& q, Ghosts kind) {
    std::array<std::array<Copies, D>, D> copies;
    for (int a = 0; a < D; ++a) {
        OnNodes<D> on_nodes{};
        on_nodes[static_cast<std::size_t>(a)] = true;
        copies[static_cast<std::size_t>(a)] = copies_of(level, on_nodes, level.boundary[static_cast<std::size_t>(a)], kind);
    }
    for_each_plane_of(level, 0, level.cells[D - 1] + 1, [&](int plane) {
        for (int a = 0; a < D; ++a) fill_plane<D>(q[a], level.cells, copies[static_cast<std::size_t>(a)], plane);
    });
    for (int a = 0; a < D; ++a) fill_end_planes(q[a], copies[static_cast<std::size_t>(a)][D - 1]);
}

template <int D>
void fill_ghosts(const Level<D>& level, Field<D>& q, const OnNodes<D>& on_nodes) {
    const std::array<Copies, D> copies = copies_of(level, on_nodes, level.boundary[0], Ghosts::even);
    for_each_plane_of(level, 0, level.cells[D - 1] + 1, [&](int plane) { fill_plane<D>(q, level.cells, copies, plane); });
    fill_end_planes(q, copies[D - 1]);
}

#define WEIR_INSTANTIATE(D)                                        \
    template struct Level<D>;                                      \
    template void fill_ghosts(const Level<D>&, Faces<D>&, Ghosts); \
    template void fill_ghosts(const Level<D>&, Field<D>&, const OnNodes<D>&);
WEIR_INSTANTIATE(2)
WEIR_INSTANTIATE(3)
#undef WEIR_INSTANTIATE

}  // namespace weir::mac::viscous
