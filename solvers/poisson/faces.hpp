// The weight of a face, in one place for all methods: the rules of poisson.hpp.
#pragma once
#include "poisson/poisson.hpp"

namespace weir::poisson {

template <int D>
bool has_weights(const Operator<D>& A) {
    return !A.weight[0].empty();
}

/// The cell on the other side of a face; `outside` beyond a domain side that is not periodic.
template <int D>
struct Neighbour {
    Index<D> cell;
    bool outside = false;
};

/// The neighbour of I along axis a, on the lower (side 0) or upper (side 1) side.
template <int D>
Neighbour<D> neighbour(const Operator<D>& A, Index<D> I, int a, int side) {
    const int n = A.cells.extent()[a];
    I[a] += side == 0 ? -1 : 1;
    if (I[a] >= 0 && I[a] < n) return {I, false};
    if (!A.periodic[static_cast<std::size_t>(a)]) return {I, true};
    I[a] = I[a] < 0 ? n - 1 : 0;
    return {I, false};
}

/// w_f of the face between fluid cell I and its neighbour: 0 towards solids, closed sides, and a periodic cell's own image.
template <int D>
real face_weight(const Operator<D>& A, const Index<D>& I, int a, int side) {
    const auto [N, outside] = neighbour(A, I, a, side);
    if (!outside && A.cells(N) == Cell::solid) return 0;
    if (!outside && A.cells.extent()[a] == 1) return 0;
    if (!has_weights(A)) return outside ? 0 : A.axis_weight[a];
    Index<D> face = I;
    if (side == 1) face = outside ? N : N[a] == 0 ? N : I + e<D>(a);
    return A.axis_weight[a] * A.weight[static_cast<std::size_t>(a)](face);
}

}  // namespace weir::poisson
