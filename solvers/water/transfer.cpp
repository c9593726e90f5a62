#include "water/transfer.hpp"

#include "core/parallel.hpp"
#include "free_surface/marker_lanes.hpp"

namespace weir::water {

namespace {

constexpr int slab_planes = 4;  // at least 2, so that slabs two apart share no face

/// Position of a sample (lo or hi of every axis) relative to the marker, per axis, in metres: the argument of APIC's affine part.
template <int D>
Vec<D> lower_arm(const Frame<D>& frame, const Stencil<D>& stencil, int a) {
    Vec<D> arm;
    for (int d = 0; d < D; ++d) arm[d] = -stencil.of(a, d).f * frame.h[d];
    return arm;
}

/// One marker with its APIC gradient.
template <int D>
void scatter_affine(const Markers<D>& m, std::size_t p, const Frame<D>& frame, FaceSums<D>& sums) {
    const Stencil<D> stencil(frame, m.position(p));
    for (int a = 0; a < D; ++a) {
        auto& sum = sums.sum[static_cast<std::size_t>(a)];
        FaceSum* to = sum.data();
        const Vec<D> arm = lower_arm(frame, stencil, a);
        Vec<D> gradient;
        real value = m.v[static_cast<std::size_t>(a)][p];
        for (int d = 0; d < D; ++d) {
            gradient[d] = m.c[static_cast<std::size_t>(a * D + d)][p];
            value += gradient[d] * arm[d];
            gradient[d] *= stencil.of(a, d).step == 0 ? 0 : frame.h[d];
        }
        int corner = 0;  // bit d: the upper sample along d, in the order of for_each_sample
        for_each_sample(stencil, a, sum.extent(), [&](std::ptrdiff_t at, real w) {
            real here = value;
            for (int d = 0; d < D; ++d) here += (corner >> d & 1) ? gradient[d] : 0;
            to[at].momentum += w * here;
            to[at].weight += w;
            ++corner;
        });
    }
}

/// Scatters the markers of one cell to the faces around it, row by row along x. (Σ w v, Σ w) of a face are adjacent as in FaceSum, so one
/// vector holds the faces of a row: two of them along x, three nodes across it. A marker adds its hat function along x times its weight of
/// the row. The rows stay in registers until all markers of the cell are processed.
template <int D>
class CellSums {
public:
    static constexpr int most = 4 * marker_lanes;  // markers per batch

    WEIR_INLINE CellSums(const Markers<D>& m, const Frame<D>& frame, const Index<D>& I, std::size_t p, int count) {
        for (int first = 0; first < count; first += marker_lanes) {
            const int here = std::min(marker_lanes, count - first);
            find_weights(from_centre(frame, I, load_positions(m, p + static_cast<std::size_t>(first), here)), first);
        }
        std::array<const real*, D> v;
        for (std::size_t a = 0; a < D; ++a) v[a] = m.v[a].data() + p;
        add_all(v, count);
    }
    WEIR_INLINE void add_to(FaceSums<D>& sums, const Frame<D>& frame, const Index<D>& I) const {
        add_rows<0, x_rows>(x_, sums.sum[0], frame, I);
        add_rows<1, y_rows>(y_, sums.sum[1], frame, I);
        if constexpr (D == 3) add_rows<2, z_rows>(z_, sums.sum[2], frame, I);
    }

private:
    // rows of faces along x, y, z: (3, 2, 3) along y times (3, 3, 2) along z
    static constexpr std::size_t x_rows = D == 2 ? 3 : 9, y_rows = D == 2 ? 2 : 6, z_rows = D == 2 ? 1 : 6;
    using Quad = simd::Pack<real, 4>;
    using Pair = simd::Pack<real, 2>;
    using Weights = std::array<real, most>;

    WEIR_INLINE void find_weights(const LaneVec<D>& d, int first) {
        const Hats<D, false> hats(d);
        const auto keep = [&](Weights& to, const Lanes& w) { simd::store(to.data() + first, w); };
        for (std::size_t i = 0; i < 2; ++i) keep(along_face_[i], hats.face[0][i]);
        for (std::size_t i = 0; i < 3; ++i) keep(along_centre_[i], hats.centre[0][i]);
        for (std::size_t j = 0; j < 3; ++j)
            for (std::size_t k = 0; k < (D == 2 ? 1 : 3); ++k) {
                if constexpr (D == 2) {
                    keep(x_weight_[j], hats.centre[1][j]);
                    if (j < 2) keep(y_weight_[j], hats.face[1][j]);
                } else {
                    keep(x_weight_[j + 3 * k], hats.centre[1][j] * hats.centre[2][k]);
                    if (j < 2) keep(y_weight_[j + 2 * k], hats.face[1][j] * hats.centre[2][k]);
                    if (k < 2) keep(z_weight_[j + 3 * k], hats.centre[1][j] * hats.face[2][k]);
                }
            }
    }
    /// Adds all markers whose weights are computed; v: their velocities.
    WEIR_INLINE void add_all(const std::array<const real*, D>& v, int count) {
        Quad x[x_rows]{};
        Lanes y[y_rows]{}, z[z_rows]{};
        const auto one = [](real speed) {  // factors of the weights along x: momentum, weight, momentum, ...
            return __builtin_shufflevector(Lanes{} + speed, Lanes{} + 1, 0, 9, 2, 11, 4, 13, 6, 15);
        };
        for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
            const Quad face = __builtin_shufflevector(Quad{} + along_face_[0][i], Quad{} + along_face_[1][i], 0, 1, 6, 7);
            const Quad across_x = face * __builtin_shufflevector(Quad{} + v[0][i], Quad{} + 1, 0, 5, 2, 7);
#pragma GCC unroll 9
            for (std::size_t r = 0; r < x_rows; ++r) x[r] += across_x * x_weight_[r][i];
            const Lanes left =
                __builtin_shufflevector(Lanes{} + along_centre_[0][i], Lanes{} + along_centre_[1][i], 0, 1, 10, 11, 4, 5, 6, 7);
            const Lanes centre = __builtin_shufflevector(left, Lanes{} + along_centre_[2][i], 0, 1, 2, 3, 12, 13, 14, 15);
            const Lanes across_y = centre * one(v[1][i]);
#pragma GCC unroll 6
            for (std::size_t r = 0; r < y_rows; ++r) y[r] += across_y * y_weight_[r][i];
            if constexpr (D == 3) {
                const Lanes across_z = centre * one(v[2][i]);
#pragma GCC unroll 6
                for (std::size_t r = 0; r < z_rows; ++r) z[r] += across_z * z_weight_[r][i];
            }
        }
#pragma GCC unroll 9
        for (std::size_t r = 0; r < x_rows; ++r) x_[r] = x[r];
#pragma GCC unroll 6
        for (std::size_t r = 0; r < y_rows; ++r) y_[r] = y[r];
#pragma GCC unroll 6
        for (std::size_t r = 0; r < z_rows; ++r) z_[r] = z[r];
    }
    template <int A, std::size_t rows, class Row>
    WEIR_INLINE static void add_rows(const Row (&row)[rows], Grid<FaceSum, D>& sums, const Frame<D>& frame, const Index<D>& I) {
        constexpr int along_y = A == 1 ? 2 : 3, first_j = A == 1 ? 0 : -1, first_k = D == 2 || A == 2 ? 0 : -1;
        bool inner = true;
        for (int d = 0; d < D; ++d) inner = inner && is_inner(frame, I, d);
        if (inner) {
            FaceSum* own = &sums(I) - (A == 0 ? 0 : 1);
            const std::ptrdiff_t sy = sums.stride(1), sz = D == 2 ? 0 : sums.stride(D - 1);
#pragma GCC unroll 9
            for (int r = 0; r < int{rows}; ++r) add_row(row[r], own + (r % along_y + first_j) * sy + (r / along_y + first_k) * sz);
            return;
        }
        const NodeOffsets<D> offset(sums, frame, I);
        for (int r = 0; r < int{rows}; ++r) {
            alignas(Row) std::array<real, sizeof(Row) / sizeof(real)> values;
            std::memcpy(values.data(), &row[r], sizeof(Row));
            for (int i = 0; i < (A == 0 ? 2 : 3); ++i) {
                FaceSum& face = sums.data()[offset(i - (A == 0 ? 0 : 1), r % along_y + first_j, r / along_y + first_k)];
                face.momentum += values[2 * static_cast<std::size_t>(i)];
                face.weight += values[2 * static_cast<std::size_t>(i) + 1];
            }
        }
    }
    WEIR_INLINE static void add_row(const Quad& row, FaceSum* to) { add_to_memory(row, to); }
    WEIR_INLINE static void add_row(const Lanes& row, FaceSum* to) {
        add_to_memory(__builtin_shufflevector(row, row, 0, 1, 2, 3), to);
        add_to_memory(__builtin_shufflevector(row, row, 4, 5), to + 2);
    }
    template <class V>
    WEIR_INLINE static void add_to_memory(const V& v, FaceSum* to) {
        V sum;
        std::memcpy(&sum, to, sizeof sum);
        sum += v;
        std::memcpy(static_cast<void*>(to), &sum, sizeof sum);
    }

    alignas(64) std::array<Weights, 2> along_face_;
    alignas(64) std::array<Weights, 3> along_centre_;
    alignas(64) std::array<Weights, x_rows> x_weight_;
    alignas(64) std::array<Weights, y_rows> y_weight_;
    alignas(64) std::array<Weights, z_rows> z_weight_;  // neither this nor z_ is used in 2D
    Quad x_[x_rows];
    Lanes y_[y_rows], z_[z_rows];
};

/// Scatters the markers of one cell to all faces around it.
template <int D>
void scatter_cell(const Markers<D>& m, const Index<D>& I, std::size_t begin, std::size_t end, const Frame<D>& frame, FaceSums<D>& sums) {
    for (std::size_t p = begin; p < end; p += CellSums<D>::most) {
        const int count = static_cast<int>(std::min<std::size_t>(CellSums<D>::most, end - p));
        CellSums<D>(m, frame, I, p, count).add_to(sums, frame, I);
    }
}

/// A periodic axis stores its first face twice: both copies get the sum.
template <int D>
void join_periodic(const Frame<D>& frame, FaceSums<D>& sums) {
    for (int a = 0; a < D; ++a) {
        if (!frame.periodic(a)) continue;
        auto& sum = sums.sum[static_cast<std::size_t>(a)];
        Index<D> lo{}, hi = sum.extent();
        hi[a] = 1;
        if (a == D - 1 && !(sum.store().holds(0) && sum.store().holds(frame.cells[a]))) continue;  // this rank does not read them
        for_each_held(sum, lo, hi, [&](Index<D> I) {
            Index<D> last = I;
            last[a] = frame.cells[a];
            sum(I).momentum += sum(last).momentum;
            sum(I).weight += sum(last).weight;
            sum(last) = sum(I);
        });
    }
}

/// f(index, count) on the part of each line of faces within reach of markers, g(index, count) on the rest.
template <int D, class F, class G>
void for_faces_near(const Markers<D>& markers, const Frame<D>& frame, const Extent<D>& extent, F&& f, G&& g) {
    const auto row = [&](const Index<D>& I) {
        std::size_t at = 0;
        for (int d = D - 1; d > 0; --d) at = at * static_cast<std::size_t>(frame.cells[d]) + static_cast<std::size_t>(I[d]);
        return markers.in_row(at);
    };
    for_each_line(extent, [&](const Index<D>& I, std::size_t at) {
        Segment near{frame.cells[0], 0};
        for (const int j : {-1, 0, 1}) {
            if constexpr (D == 2) {
                near.join(row(frame.near(I, 1, j)));
            } else {
                for (const int k : {-1, 0, 1}) near.join(row(frame.near(frame.near(I, 1, j), 2, k)));
            }
        }
        const auto count = static_cast<std::size_t>(extent[0]);
        if (near.empty()) return g(at, count);
        const bool joins = frame.periodic(0) && (near.begin == 0 || near.end == frame.cells[0]);
        const auto begin = static_cast<std::size_t>(joins ? 0 : std::max(0, near.begin - 1));
        const auto end = static_cast<std::size_t>(joins ? extent[0] : std::min(extent[0], near.end + 1));
        g(at, begin);
        f(at + begin, end - begin);
        g(at + end, count - end);
    });
}

}  // namespace

template <int D>
void markers_to_faces(const Markers<D>& markers, const Frame<D>& frame, FaceSums<D>& sums, MacVelocity<D>& u,
                      std::type_identity_t<std::array<Grid<std::uint8_t, D>, D>>& known) {
    const auto nothing = [](std::size_t, std::size_t) {};
    // in parallel: ghost markers also add to ghost faces, whose sums are incomplete and unused
    for (auto& sum : sums.sum) {
        for_faces_near(
            markers, frame, replicated<D>(sum.extent()),
            [&](std::size_t at, std::size_t count) { std::fill(sum.data() + at, sum.data() + at + count, FaceSum{}); }, nothing);
    }
    const int planes = frame.cells[D - 1], slabs = (planes + slab_planes - 1) / slab_planes;
    const std::size_t plane_cells = product(frame.cells) / static_cast<std::size_t>(planes);
    const auto scatter_slab = [&](int slab) {
        const std::size_t from = static_cast<std::size_t>(slab * slab_planes) * plane_cells;
        const std::size_t to = static_cast<std::size_t>(std::min((slab + 1) * slab_planes, planes)) * plane_cells;
        markers.for_occupied_cells(frame, from, to, [&](const Index<D>& I, std::size_t begin, std::size_t end) {
            if (!markers.carries_gradient()) return scatter_cell(markers, I, begin, end, frame, sums);
            for (std::size_t p = begin; p < end; ++p) scatter_affine(markers, p, frame, sums);
        });
    };
    const int paired = slabs - slabs % 2;  // an odd last slab borders the first one around a periodic axis: it runs separately
    for (int colour = 0; colour < 2; ++colour) parallel_for(0, paired / 2, [&](int i) { scatter_slab(2 * i + colour); });
    if (paired < slabs) scatter_slab(slabs - 1);
    join_periodic(frame, sums);
    for (int a = 0; a < D; ++a) {
        const auto& sum = sums.sum[static_cast<std::size_t>(a)];
        auto& seen = known[static_cast<std::size_t>(a)];
        for_faces_near(
            markers, frame, sum.extent(),
            [&](std::size_t at, std::size_t count) {
                const FaceSum* from = sum.data() + at;
                std::uint8_t* mark = seen.data() + at;
                real* mean = u[a].data() + at;
#pragma omp simd
                for (std::size_t i = 0; i < count; ++i) {
                    const bool any = from[i].weight > 1e-12;  // less is round-off of a marker at the edge of the hat function
                    mark[i] = any;
                    mean[i] = any ? from[i].momentum / from[i].weight : mean[i];
                }
            },
            [&](std::size_t at, std::size_t count) { std::fill(seen.data() + at, seen.data() + at + count, std::uint8_t{0}); });
    }
}

/// v = β v + Σ_i w_ip u_i for every marker; they must be sorted.
template <int D>
static void gather(const MacVelocity<D>& u, const Frame<D>& frame, real beta, Markers<D>& markers) {
    markers.for_each_occupied_cell(frame, [&](const Index<D>& I, std::size_t begin, std::size_t end) {
        const CellFaces<D> faces(u, frame, I);
        for (std::size_t p = begin; p < end; p += marker_lanes) {
            const int count = static_cast<int>(std::min<std::size_t>(marker_lanes, end - p));
            const auto v = faces.template velocity<false>(from_centre(frame, I, load_positions(markers, p, count)));
            for (std::size_t a = 0; a < D; ++a) {
                real* carried = markers.v[a].data() + p;
                simd::store_first(carried, beta * simd::load_first(carried, count) + v[a], count);
            }
        }
    });
}

template <int D>
void pic_to_markers(const MacVelocity<D>& u, const Frame<D>& frame, Markers<D>& markers) {
    gather(u, frame, 0, markers);
}

template <int D>
void copy_faces_near(const Markers<D>& markers, const Frame<D>& frame, const MacVelocity<D>& u, MacVelocity<D>& to) {
    for (int a = 0; a < D; ++a)
        for_faces_near(
            markers, frame, u[a].extent(),
            [&](std::size_t at, std::size_t count) { std::copy_n(u[a].data() + at, count, to[a].data() + at); },
            [](std::size_t, std::size_t) {});
}

template <int D>
void flip_to_markers(const MacVelocity<D>& u, MacVelocity<D>& before, real beta, const Frame<D>& frame, Markers<D>& markers) {
    for (int a = 0; a < D; ++a)  // β v + Σ w (u − β u_before): one interpolation instead of two
        for_faces_near(
            markers, frame, u[a].extent(),
            [&](std::size_t at, std::size_t count) {
                const real* now = u[a].data() + at;
                real* then = before[a].data() + at;
#pragma omp simd
                for (std::size_t i = 0; i < count; ++i) then[i] = now[i] - beta * then[i];
            },
            [](std::size_t, std::size_t) {});
    refresh_faces(before, frame, 1);
    gather(before, frame, beta, markers);
}

template <int D>
void apic_to_markers(const MacVelocity<D>& u, const Frame<D>& frame, Markers<D>& markers) {
    const auto [first, last] = markers.own(frame);
    parallel_for(static_cast<int>(first), static_cast<int>(last), [&](int i) {
        const auto p = static_cast<std::size_t>(i);
        const Stencil<D> stencil(frame, markers.position(p));
        for (int a = 0; a < D; ++a) {
            real v = 0;
            Vec<D> gradient{};
            int corner = 0;
            const real* face = u[a].data();
            for_each_sample(stencil, a, u[a].extent(), [&](std::ptrdiff_t at, real w) {
                v += w * face[at];
                for (int d = 0; d < D; ++d) {  // ∂w/∂x_d = ± 1/h_d times the weights along the other axes
                    real slope = (corner >> d & 1) ? frame.inv_h[d] : -frame.inv_h[d];
                    if (stencil.of(a, d).step == 0) slope = 0;
                    for (int o = 0; o < D; ++o)
                        if (o != d) slope *= (corner >> o & 1) ? stencil.of(a, o).f : 1 - stencil.of(a, o).f;
                    gradient[d] += slope * face[at];
                }
                ++corner;
            });
            markers.v[static_cast<std::size_t>(a)][p] = v;
            for (int d = 0; d < D; ++d) markers.c[static_cast<std::size_t>(a * D + d)][p] = gradient[d];
        }
    });
}

template class FaceSums<2>;
template class FaceSums<3>;
#define WEIR_INSTANTIATE(D)                                                                                    \
    template void markers_to_faces(const Markers<D>&, const Frame<D>&, FaceSums<D>&, MacVelocity<D>&,          \
                                   std::array<Grid<std::uint8_t, D>, D>&);                                     \
    template void copy_faces_near(const Markers<D>&, const Frame<D>&, const MacVelocity<D>&, MacVelocity<D>&); \
    template void pic_to_markers(const MacVelocity<D>&, const Frame<D>&, Markers<D>&);                         \
    template void flip_to_markers(const MacVelocity<D>&, MacVelocity<D>&, real, const Frame<D>&, Markers<D>&); \
    template void apic_to_markers(const MacVelocity<D>&, const Frame<D>&, Markers<D>&);
WEIR_INSTANTIATE(2)
WEIR_INSTANTIATE(3)
#undef WEIR_INSTANTIATE

}  // namespace weir::water
