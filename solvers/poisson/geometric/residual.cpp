// r = b − A p directly from the definition in poisson.hpp: slow, and the reference for every method.
#include "poisson/faces.hpp"

namespace weir::poisson {

template <int D>
void residual(const Operator<D>& A, const Grid<real, D>& p, const Grid<real, D>& b, Grid<real, D>& r) {
    if (r.extent() != A.cells.extent()) r = Grid<real, D>(A.cells.extent());
    for_each_cell(A.cells.extent(), [&](const Index<D>& I) {
        r(I) = 0;
        if (A.cells(I) != Cell::fluid) return;
        real sum = b(I);
        for (int a = 0; a < D; ++a)
            for (int side = 0; side < 2; ++side) {
                const real w = face_weight(A, I, a, side);
                if (w == 0) continue;
                const auto [N, outside] = neighbour(A, I, a, side);
                const bool zero = outside || A.cells(N) != Cell::fluid;
                sum -= w * (p(I) - (zero ? 0 : p(N)));
            }
        r(I) = sum;
    });
}

template void residual<2>(const Operator<2>&, const Grid<real, 2>&, const Grid<real, 2>&, Grid<real, 2>&);
template void residual<3>(const Operator<3>&, const Grid<real, 3>&, const Grid<real, 3>&, Grid<real, 3>&);

}  // namespace weir::poisson
