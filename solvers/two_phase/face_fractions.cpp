// Fractions of the control volumes of faces: ½ upper half of the cell below + ½ lower half of the cell above, each below the cell's plane.
// A plane is reconstructed once for all axes within a plane of cells.
#include "mac/grid/rows.hpp"
#include "two_phase/fractions.hpp"

namespace weir::two_phase {

namespace {

template <int D>
class HalfCells {
public:
    HalfCells(const Padded<D>& cells, FaceFractions<D>& below, FaceFractions<D>& above)
        : cells_(cells), stride_(strides_of(cells)), below_(below), above_(above) {}

    /// Of all faces in one plane of the last axis.
    void find(int plane) {
        for_each_face_row(plane, [&](int a, const Index<D>& first, int count) { set_pure(a, first, count); });
        const Index<D> one = Index<D>::constant(1);
        Index<D> lo = Index<D>::constant(-1), hi = cells_.extent() + one;
        for_each_mixed(lo, hi, plane, [&](const Index<D>& I, const Plane<D>& cut) {
            for (int a = 0; a < D; ++a) set(above_, a, I, cut, 0);
            for (int a = 0; a + 1 < D; ++a) set(below_, a, I, cut, 1);
        });
        for_each_mixed(lo + one, hi - one, plane - 1, [&](const Index<D>& I, const Plane<D>& cut) { set(below_, D - 1, I, cut, 1); });
    }
    /// The mean of both halves, in `above`.
    void average(int plane) {
        for_each_face_row(plane, [&](int a, const Index<D>& first, int count) {
            const real* below = &below_[static_cast<std::size_t>(a)](first);
            real* above = &above_[static_cast<std::size_t>(a)](first);
#pragma omp simd
            for (int i = 0; i < count; ++i) above[i] = 0.5 * (below[i] + above[i]);
        });
    }

private:
    template <class F>
    void for_each_face_row(int plane, F&& f) {
        for (int a = 0; a < D; ++a) {
            const Extent<D>& extent = above_[static_cast<std::size_t>(a)].extent();
            if (plane >= extent[D - 1]) continue;
            Index<D> first{};
            first[D - 1] = plane;
            for (int j = 0; j < (D == 2 ? 1 : extent[1]); ++j) {
                if constexpr (D == 3) first[1] = j;
                f(a, first, extent[0]);
            }
        }
    }
    /// f(I, plane of cell I) for the mixed cells between lo and hi.
    template <class F>
    void for_each_mixed(Index<D> lo, const Index<D>& hi, int plane, F&& f) {
        lo[D - 1] = plane;
        for (Index<D> row = lo; D == 2 ? row[1] == plane : row[1] < hi[1]; ++row[1]) {
            const real* q = cells_.at(row) - row[0];
            for (Index<D> I = row; I[0] < hi[0]; ++I[0])
                if (is_mixed(q[I[0]])) f(I, plane_at<D>(q + I[0], stride_));
        }
    }
    /// Halves of pure cells: 0 or 1. Those of mixed ones follow.
    void set_pure(int a, const Index<D>& first, int count) {
        const real* f = cells_.at(first);
        const std::ptrdiff_t by = stride_[static_cast<std::size_t>(a)];
        real *below = &below_[static_cast<std::size_t>(a)](first), *above = &above_[static_cast<std::size_t>(a)](first);
#pragma omp simd
        for (int i = 0; i < count; ++i) {
            below[i] = is_full(f[i - by]) ? 1 : 0;
            above[i] = is_full(f[i]) ? 1 : 0;
        }
    }
    /// The half of cell I at its lower (end 0) or upper (end 1) face along an axis.
    void set(FaceFractions<D>& to, int a, const Index<D>& I, const Plane<D>& cut, int end) {
        auto& faces = to[static_cast<std::size_t>(a)];
        const Index<D> face = end == 0 ? I : I + e<D>(a);
        if (faces.contains(face)) faces(face) = fraction_of_slab(cut, a, end, 0.5);
    }

    const Padded<D>& cells_;
    Strides<D> stride_;
    FaceFractions<D>&below_, &above_;
};

}  // namespace

template <int D>
void find_face_fractions(const Padded<D>& cells, FaceFractions<D>& faces, FaceFractions<D>& scratch) {
    HalfCells<D> halves(cells, scratch, faces);
    for_each_plane(faces[D - 1].extent(), [&](int plane) {
        halves.find(plane);
        halves.average(plane);
    });
}

template void find_face_fractions<2>(const Padded<2>&, FaceFractions<2>&, FaceFractions<2>&);
template void find_face_fractions<3>(const Padded<3>&, FaceFractions<3>&, FaceFractions<3>&);

}  // namespace weir::two_phase
