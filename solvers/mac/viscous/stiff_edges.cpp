// Edges that hold the larger part of the diagonal of two or more of their faces: those beside a corner of the viscous fluid. The energy of
// such an edge, κ (s·x)², is 0 for all but one combination of its faces, so a diagonal is far too large for the others, and no coarse grid
// resolves them. The bounding matrix keeps the edge as it is for the faces A that it rules:
//
//     κ (s·x)² ≤ κ [ (4/|A|) (s_A·x)² + 4 Σ_(not in A) (s_f x_f)² ]
//
// No face is ruled by two edges, since the parts of its diagonal add up to less than 1: the bounding matrix has one small block per edge,
// and (Sherman & Morrison 1950) B⁻¹ r = r/q − (s/q) κ' (s·r/q)/(1 + κ' Σ s²/q), q the rest of the diagonal, κ' = 4κ/|A|.
#include "mac/viscous/level.hpp"

namespace weir::mac::viscous {

namespace {

/// One of the four faces of an edge.
template <int D>
struct EdgeFace {
    int axis;
    Index<D> face;
    real s;
};

/// The edge at the lower corner of cell I across a and b; face indices on periodic axes from 0 to n − 1.
template <int D>
std::array<EdgeFace<D>, 4> faces_of(const Level<D>& level, int a, int b, const Index<D>& I) {
    const auto wrap = [&](Index<D> J, int axis) {
        if (J[axis] < 0) J[axis] += level.cells[axis];
        return J;
    };
    const real along_a = 1 / level.h[a], along_b = 1 / level.h[b];
    return {{{a, I, along_b}, {a, wrap(I - e<D>(b), b), -along_b}, {b, I, along_a}, {b, wrap(I - e<D>(a), a), -along_a}}};
}

/// The diagonal of the bounding matrix at a face without the part of one edge.
template <int D>
real rest_of_diagonal(const Level<D>& level, const EdgeFace<D>& f, int across, const Index<D>& edge_at) {
    const int a = f.axis;
    const Index<D>& I = f.face;
    real sum = level.mass[a](I) + 4 / (level.h[a] * level.h[a]) * (level.mu[a](I) + level.mu[a](I - e<D>(a)));
    for (int b = 0; b < D; ++b) {
        if (b == a) continue;
        const real scale = 4 / (level.h[b] * level.h[b]);
        const bool below = b == across && I[b] == edge_at[b];
        if (!below) sum += scale * level.edge(a, b)(I);
        if (b != across || below) sum += scale * level.edge(a, b)(I + e<D>(b));
    }
    return sum;
}

template <int D>
void add_if_stiff(Level<D>& level, int a, int b, const Index<D>& I) {
    const real shear = level.edge(a, b)(I);
    StiffEdge stiff;
    std::array<real, 4> q{};
    for (const EdgeFace<D>& f : faces_of(level, a, b, I)) {
        const real inverse = level.inverse[f.axis](f.face);
        if (4 * shear * f.s * f.s * inverse <= 0.5) continue;
        const auto k = static_cast<std::size_t>(stiff.count++);
        stiff.axis[k] = f.axis;
        stiff.at[k] = level.mass[0].at(f.face) - level.mass[0].at({});
        stiff.inverse[k] = inverse;
        stiff.s[k] = f.s;
        q[k] = rest_of_diagonal(level, f, f.axis == a ? b : a, I);
    }
    if (stiff.count < 2) return;
    const real kappa = 4 * shear / stiff.count;
    real sum = 0;
    for (std::size_t k = 0; k < static_cast<std::size_t>(stiff.count); ++k) {
        stiff.inverse_q[k] = 1 / q[k];
        sum += stiff.s[k] * stiff.s[k] / q[k];
    }
    stiff.factor = kappa / (1 + kappa * sum);
    level.stiff_edges.push_back(stiff);
}

}  // namespace

template <int D>
void find_stiff_edges(Level<D>& level) {
    level.stiff_edges.clear();
    for (int b = 1; b < D; ++b)
        for (int a = 0; a < b; ++a) {
            Index<D> lo{};
            for (const int d : {a, b}) lo[d] = level.is_periodic(d) ? 0 : 1;
            Index<D> I = lo;
            if (product(level.cells) == 0) continue;
            for (; I[D - 1] < level.cells[D - 1];) {
                add_if_stiff(level, a, b, I);
                for (int d = 0; d < D; ++d) {
                    if (++I[d] < level.cells[d] || d == D - 1) break;
                    I[d] = lo[d];
                }
            }
        }
}

template <int D>
void relax_stiff_edges(const Level<D>& level, float omega, const Faces<D>* x, Faces<D>& y) {
    std::array<const float*, D> from{};
    std::array<float*, D> to;
    for (int a = 0; a < D; ++a) {
        to[static_cast<std::size_t>(a)] = y[a].at({});
        if (x) from[static_cast<std::size_t>(a)] = (*x)[a].at({});
    }
    for_each_plane_of(level, 0, static_cast<int>(level.stiff_edges.size()), [&](int i) {
        const StiffEdge& stiff = level.stiff_edges[static_cast<std::size_t>(i)];
        const auto count = static_cast<std::size_t>(stiff.count);
        std::array<real, 4> before{}, z{};
        real sum = 0;
        for (std::size_t k = 0; k < count; ++k) {
            const auto a = static_cast<std::size_t>(stiff.axis[k]);
            before[k] = x ? from[a][stiff.at[k]] : 0;
            const real r = (to[a][stiff.at[k]] - before[k]) / (omega * stiff.inverse[k]);
            z[k] = r * stiff.inverse_q[k];
            sum += stiff.s[k] * z[k];
        }
        for (std::size_t k = 0; k < count; ++k) {
            const real change = z[k] - stiff.inverse_q[k] * stiff.s[k] * stiff.factor * sum;
            to[static_cast<std::size_t>(stiff.axis[k])][stiff.at[k]] = static_cast<float>(before[k] + omega * change);
        }
    });
}

#define WEIR_INSTANTIATE(D)                    \
    template void find_stiff_edges(Level<D>&); \
    template void relax_stiff_edges(const Level<D>&, float, const Faces<D>*, Faces<D>&);
WEIR_INSTANTIATE(2)
WEIR_INSTANTIATE(3)
#undef WEIR_INSTANTIATE

}  // namespace weir::mac::viscous
