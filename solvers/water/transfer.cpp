#include "water/transfer.hpp"

#include "core/parallel.hpp"
#include "water/marker_lanes.hpp"

namespace weir::water {

namespace {

constexpr int slab_planes = 4;  // at least 2, so that slabs two apart share no face

/// Position of sample (lo or hi of every axis) relative to the marker, per axis, in metres: what APIC's affine part multiplies.
template <int D>
Vec<D> lower_arm(const Frame<D>& frame, const Stencil<D>& stencil, int a) {
    Vec<D> arm;
    for (int d = 0; d < D; ++d) arm[d] = -stencil.of(a, d).f * frame.h[d];
    return arm;
}

/// One marker with the gradient that APIC gives it.
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

/// What the markers of one cell give to the faces along A around it, row by row along x; (Σ w v, Σ w) of a face lie side by side as in
/// FaceSum, so one vector holds the faces of a row, and the rows stay in registers until the cell is done.
template <int D, int A>
class CellSums {
public:
    WEIR_LANES void add(const Hats<D, false>& hats, const Lanes& x, const real* v, int count) {
        alignas(Lanes) std::array<std::array<real, marker_lanes>, rows> weight;  // of a row, for each marker
        for (int r = 0; r < rows; ++r) {
            Lanes w = along<1>(hats, r % rows_along_y);
            if constexpr (D == 3) w *= along<2>(hats, r / rows_along_y);
            store_lanes(weight[static_cast<std::size_t>(r)].data(), w, marker_lanes);
        }
        const Row momentum = pattern({1, 0, 1, 0, 1, 0, 1, 0}), one = pattern({0, 1, 0, 1, 0, 1, 0, 1});
        for (int l = 0; l < count; ++l) {
            const Row across = hat_of_faces(x[l]) * (v[l] * momentum + one);
            for (int r = 0; r < rows; ++r) sum_[r] += across * weight[static_cast<std::size_t>(r)][static_cast<std::size_t>(l)];
        }
    }
    WEIR_LANES void add_to(Grid<FaceSum, D>& sums, const Frame<D>& frame, const Index<D>& I) const {
        const NodeOffsets<D> offset(sums, frame, I);
        for (int r = 0; r < rows; ++r) {
            alignas(Row) std::array<real, sizeof(Row) / sizeof(real)> row;
            std::memcpy(row.data(), &sum_[r], sizeof(Row));
            const int j = r % rows_along_y - (A == 1 ? 0 : 1), k = r / rows_along_y - (A == 2 ? 0 : 1);
            FaceSum* first = sums.data() + offset(first_face, j, k);
            for (int i = 0; i < faces_along_x; ++i) {
                FaceSum& face = offset.straight() ? first[i] : sums.data()[offset(first_face + i, j, k)];
                face.momentum += row[2 * static_cast<std::size_t>(i)];
                face.weight += row[2 * static_cast<std::size_t>(i) + 1];
            }
        }
    }

private:
    static constexpr int first_face = A == 0 ? 0 : -1, faces_along_x = A == 0 ? 2 : 3, rows_along_y = A == 1 ? 2 : 3;
    static constexpr int rows = rows_along_y * (D == 2 ? 1 : A == 2 ? 2 : 3);
    using Narrow = double __attribute__((vector_size(32)));
    using Row = std::conditional_t<A == 0, Narrow, Lanes>;

    template <int Axis>
    WEIR_LANES static const Lanes& along(const Hats<D, false>& hats, int k) {
        if constexpr (Axis == A)
            return hats.face[Axis][static_cast<std::size_t>(k)];
        else
            return hats.centre[Axis][static_cast<std::size_t>(k)];
    }
    WEIR_LANES static Row hat_of_faces(real x) {
        const Row zero{}, places = A == 0 ? pattern({-0.5, -0.5, 0.5, 0.5}) : pattern({-1, -1, 0, 0, 1, 1, 2, 2});
        const Row apart = x - places, w = 1 - (apart < zero ? -apart : apart);
        return w > zero ? w : zero;
    }
    WEIR_LANES static Row pattern(const std::array<real, marker_lanes>& values) {
        Row row;
        std::memcpy(&row, values.data(), sizeof row);
        return row;
    }
    Row sum_[rows]{};
};

/// The markers of one cell to all faces around it.
template <int D>
void scatter_cell(const Markers<D>& m, const Index<D>& I, std::size_t begin, std::size_t end, const Frame<D>& frame, FaceSums<D>& sums) {
    CellSums<D, 0> x;
    CellSums<D, 1> y;
    CellSums<D, 2> z;  // not used in 2D
    for (std::size_t p = begin; p < end; p += marker_lanes) {
        const int count = static_cast<int>(std::min<std::size_t>(marker_lanes, end - p));
        const auto d = from_centre(frame, I, load_positions(m, p, count));
        const Hats<D, false> hats(d);
        x.add(hats, d[0], m.v[0].data() + p, count);
        y.add(hats, d[0], m.v[1].data() + p, count);
        if constexpr (D == 3) z.add(hats, d[0], m.v[2].data() + p, count);
    }
    x.add_to(sums.sum[0], frame, I);
    y.add_to(sums.sum[1], frame, I);
    if constexpr (D == 3) z.add_to(sums.sum[2], frame, I);
}

/// A periodic axis has its first face twice: both copies get the sum.
template <int D>
void join_periodic(const Frame<D>& frame, FaceSums<D>& sums) {
    for (int a = 0; a < D; ++a) {
        if (!frame.periodic(a)) continue;
        auto& sum = sums.sum[static_cast<std::size_t>(a)];
        Index<D> lo{}, hi = sum.extent();
        hi[a] = 1;
        for_each_in(lo, hi, [&](Index<D> I) {
            Index<D> last = I;
            last[a] = frame.cells[a];
            sum(I).momentum += sum(last).momentum;
            sum(I).weight += sum(last).weight;
            sum(last) = sum(I);
        });
    }
}

/// f(place, count) on the lines of faces along `a` within reach of markers, g(place, count) on all others.
template <int D, class F, class G>
void for_lines_near(const Markers<D>& markers, const Frame<D>& frame, const Index<D>& extent, F&& f, G&& g) {
    const auto row_holds = [&](const Index<D>& I) {
        Index<D> J = I;
        J[0] = 0;
        std::size_t cell = 0;
        for (int d = D - 1; d >= 0; --d) cell = cell * static_cast<std::size_t>(frame.cells[d]) + static_cast<std::size_t>(J[d]);
        return markers.begin(cell) < markers.end(cell + static_cast<std::size_t>(frame.cells[0]) - 1);
    };
    for_each_line(extent, [&](const Index<D>& I, std::size_t at) {
        const auto count = static_cast<std::size_t>(extent[0]);
        bool near = false;
        for (const int j : {-1, 0, 1}) {
            if constexpr (D == 2) {
                near = near || row_holds(frame.near(I, 1, j));
            } else {
                for (const int k : {-1, 0, 1}) near = near || row_holds(frame.near(frame.near(I, 1, j), 2, k));
            }
        }
        if (near)
            f(at, count);
        else
            g(at, count);
    });
}

}  // namespace

template <int D>
void markers_to_faces(const Markers<D>& markers, const Frame<D>& frame, FaceSums<D>& sums, MacVelocity<D>& u,
                      std::type_identity_t<std::array<Grid<std::uint8_t, D>, D>>& known) {
    const auto nothing = [](std::size_t, std::size_t) {};
    for (auto& sum : sums.sum)
        for_lines_near(
            markers, frame, sum.extent(),
            [&](std::size_t at, std::size_t count) { std::fill(sum.data() + at, sum.data() + at + count, FaceSum{}); }, nothing);
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
    const int paired = slabs - slabs % 2;  // an odd last slab touches the first one around a periodic axis: it goes alone
    for (int colour = 0; colour < 2; ++colour) parallel_for(0, paired / 2, [&](int i) { scatter_slab(2 * i + colour); });
    if (paired < slabs) scatter_slab(slabs - 1);
    join_periodic(frame, sums);
    for (int a = 0; a < D; ++a) {
        const auto& sum = sums.sum[static_cast<std::size_t>(a)];
        auto& seen = known[static_cast<std::size_t>(a)];
        for_lines_near(
            markers, frame, sum.extent(),
            [&](std::size_t at, std::size_t count) {
                for (std::size_t i = at; i < at + count; ++i) {
                    seen[i] = sum[i].weight > 1e-12;  // less is round-off of a marker that sits on the edge of the hat
                    if (seen[i]) u[a][i] = sum[i].momentum / sum[i].weight;
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
                store_lanes(carried, beta * load_lanes(carried, count) + v[a], count);
            }
        }
    });
}

template <int D>
void pic_to_markers(const MacVelocity<D>& u, const Frame<D>& frame, Markers<D>& markers) {
    gather(u, frame, 0, markers);
}

template <int D>
void flip_to_markers(const MacVelocity<D>& u, MacVelocity<D>& before, real beta, const Frame<D>& frame, Markers<D>& markers) {
    for (int a = 0; a < D; ++a)  // β v + Σ w (u − β u_before): one interpolation instead of two
        for_lines_near(
            markers, frame, u[a].extent(),
            [&](std::size_t at, std::size_t count) {
                for (std::size_t i = at; i < at + count; ++i) before[a][i] = u[a][i] - beta * before[a][i];
            },
            [](std::size_t, std::size_t) {});
    gather(before, frame, beta, markers);
}

template <int D>
void apic_to_markers(const MacVelocity<D>& u, const Frame<D>& frame, Markers<D>& markers) {
    parallel_for(0, static_cast<int>(markers.count()), [&](int i) {
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
    template void pic_to_markers(const MacVelocity<D>&, const Frame<D>&, Markers<D>&);                         \
    template void flip_to_markers(const MacVelocity<D>&, MacVelocity<D>&, real, const Frame<D>&, Markers<D>&); \
    template void apic_to_markers(const MacVelocity<D>&, const Frame<D>&, Markers<D>&);
WEIR_INSTANTIATE(2)
WEIR_INSTANTIATE(3)
#undef WEIR_INSTANTIATE

}  // namespace weir::water
