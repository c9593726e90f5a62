// The matrix of the next level: masses by the transpose of the prolongation (its lumped Galerkin product), viscosities by means, which keep
// the energy of smooth velocities where viscosity jumps. Sides keep their conditions; closed faces act on the open ones beside them as a
// mass, because the coarse grid does not resolve them.
#include "mac/viscous/level.hpp"

namespace weir::mac::viscous {

namespace {

/// The mass of open faces, and their coupling to closed ones; 0 on closed faces.
template <int D>
void find_open_mass(const Level<D>& fine, Faces<D>& to) {
    for_each_block_of(fine, [&](int a, const Index<D>& first, int count) {
        const float *mass = fine.mass[a].at(first), *mu = fine.mu[a].at(first);
        float* out = to[a].at(first);
        const std::ptrdiff_t s = fine.stride(a);
        for (int i = 0; i < count; ++i) out[i] = std::max(mass[i], 0.0f);
        if (!fine.has_closed_faces) return;
        for (int b = 0; b < D; ++b) {
            const std::ptrdiff_t up = fine.stride(b);
            const auto scale = static_cast<float>((b == a ? 2 : 1) / (fine.h[b] * fine.h[b]));
            const float *lower = b == a ? mu - s : fine.edge(a, b).at(first), *upper = b == a ? mu : lower + up;
            for (int i = 0; i < count; ++i) {
                if (mass[i] < 0) continue;
                if (mass[i - up] < 0) out[i] += scale * lower[i];
                if (mass[i + up] < 0) out[i] += scale * upper[i];
            }
        }
    });
}

template <int D>
void coarsen_mass(Level<D>& fine, Level<D>& coarse) {
    find_open_mass(fine, fine.x);
    fill_ghosts(fine, fine.x, Ghosts::even);
    restrict_faces(fine, fine.x, coarse, coarse.mass);
    coarse.has_closed_faces = fine.has_closed_faces;
    if (fine.has_closed_faces) {
        for_each_block_of(fine, [&](int a, const Index<D>& first, int count) {
            const float* mass = fine.mass[a].at(first);
            float* open = fine.x[a].at(first);
            for (int i = 0; i < count; ++i) open[i] = mass[i] < 0 ? 0 : 1;
        });
        fill_ghosts(fine, fine.x, Ghosts::even);
        restrict_faces(fine, fine.x, coarse, coarse.b);
        for_each_block_of(coarse, [&](int a, const Index<D>& first, int count) {
            const float* open = coarse.b[a].at(first);
            float* mass = coarse.mass[a].at(first);
            for (int i = 0; i < count; ++i)
                if (open[i] == 0) mass[i] = -1;
        });
    }
    fill_ghosts(coarse, coarse.mass, Ghosts::even);
}

/// How a coefficient is averaged along an axis, so that the energy of any coarse velocity is at least that of its prolongation: over the
/// children of a cell along the velocity; over the nodes around a node; over the four cells that the prolongation reaches beside it.
enum class Place { children, nodes, beside };
template <int D>
struct Places : std::array<Place, D> {
    static Places all(Place place) {
        Places p;
        p.fill(place);
        return p;
    }
    Place& operator[](int d) { return this->data()[d]; }
    Place operator[](int d) const { return this->data()[d]; }
};

/// Fine entries and their weights along one axis; on sides the nodes of the side.
struct Range {
    int first, count;
    std::array<float, 4> w;
};

template <int D>
Range range(const Level<D>& fine, int axis, Place place, int coarse, int coarse_cells) {
    const int n = fine.cells[axis];
    if (!fine.halved[static_cast<std::size_t>(axis)]) return {coarse, 1, {1, 0, 0}};
    if (place == Place::beside) return {2 * coarse - 1, 4, {0.125f, 0.375f, 0.375f, 0.125f}};
    if (place == Place::children) return 2 * coarse + 1 < n ? Range{2 * coarse, 2, {0.5f, 0.5f, 0}} : Range{2 * coarse, 1, {1, 0, 0}};
    if (fine.is_periodic(axis) || (coarse > 0 && coarse < coarse_cells)) return {2 * coarse - 1, 3, {0.25f, 0.5f, 0.25f}};
    return {std::min(2 * coarse, n), 1, {1, 0, 0}};
}

template <int D>
void coarsen_means(const Level<D>& fine, const Field<D>& from, const Places<D>& places, const Level<D>& coarse, Field<D>& to) {
    Index<D> hi = coarse.cells;
    for (int d = 0; d < D; ++d) hi[d] += places[d] == Place::nodes ? 1 : 0;
    const auto mean = [&](const Index<D>& I) {
        std::array<Range, D> of;
        for (int d = 0; d < D; ++d) of[static_cast<std::size_t>(d)] = range(fine, d, places[d], I[d], coarse.cells[d]);
        float sum = 0;
        Index<D> K{};
        const int planes = D == 3 ? of[D - 1].count : 1;
        for (int k = 0; k < planes; ++k)
            for (int j = 0; j < of[1].count; ++j)
                for (int i = 0; i < of[0].count; ++i) {
                    float w = of[0].w[static_cast<std::size_t>(i)] * of[1].w[static_cast<std::size_t>(j)];
                    K[0] = of[0].first + i, K[1] = of[1].first + j;
                    if constexpr (D == 3) K[2] = of[2].first + k, w *= of[2].w[static_cast<std::size_t>(k)];
                    sum += w * from(K);
                }
        return sum;
    };
    for_each_plane_of(coarse, 0, hi[D - 1], [&](int plane) {
        Index<D> I{};
        I[D - 1] = plane;
        for (I[1] = D == 2 ? plane : 0; I[1] < (D == 2 ? plane + 1 : hi[1]); ++I[1])
            for (I[0] = 0; I[0] < hi[0]; ++I[0]) to(I) = mean(I);
    });
    OnNodes<D> on_nodes{};
    for (int d = 0; d < D; ++d) on_nodes[static_cast<std::size_t>(d)] = places[d] == Place::nodes;
    fill_ghosts(coarse, to, on_nodes);
}

}  // namespace

template <int D>
void coarsen(Level<D>& fine, Level<D>& coarse) {
    coarsen_mass(fine, coarse);
    for (int a = 0; a < D; ++a) {
        Places<D> places = Places<D>::all(Place::beside);
        places[a] = Place::children;
        coarsen_means(fine, fine.mu[a], places, coarse, coarse.mu[a]);
    }
    for (int b = 1; b < D; ++b)
        for (int a = 0; a < b; ++a) {
            Places<D> places = Places<D>::all(Place::beside);
            places[a] = places[b] = Place::nodes;
            coarsen_means(fine, fine.edge(a, b), places, coarse, coarse.edge(a, b));
        }
    find_inverse(coarse);
    find_stiff_edges(coarse);
}

template void coarsen(Level<2>&, Level<2>&);
template void coarsen(Level<3>&, Level<3>&);

}  // namespace weir::mac::viscous
