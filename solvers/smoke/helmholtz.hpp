// (I − a ∇²) δ = r on the nodes of one kind (a velocity component or cells), by conjugate gradients: the linear solve of implicit viscosity
// and diffusion. ∇² is the 5- or 7-point Laplacian. δ is a correction with homogeneous boundary conditions.
#pragma once
#include "mac/grid/ghosts.hpp"
#include "parallel/grid.hpp"
#include "smoke/effects.hpp"

#include <span>
#include <type_traits>
#include <vector>

namespace weir::smoke {

/// The open fractions of all faces, or nullptr where all are open.
template <int D>
using OpenFaces = const std::array<Grid<real, D>, D>*;

/// The nodes that take part: 1, others 0, with ghosts. Empty: all take part.
template <int D>
using Mask = Padded<D>;

/// out = (q(I + e_b) − 2 q(I) + q(I − e_b)) / h_b², summed over b, on `nodes`; zero where the mask is 0. In cells beside solids each
/// difference is weighted by the open fraction of the face.
template <int D>
void laplacian(const Padded<D>& q, const Vec<D>& h, const Nodes<D>& nodes, const Mask<D>& mask, std::type_identity_t<OpenFaces<D>> open,
               Grid<real, D>& out);

/// Rows of the implicit solve modified by walls: ∇²δ has the additional term `extra` δ(I). The solve is for δ/scale, which scales their
/// diagonal to that of other rows.
template <int D>
struct WallRows {
    std::vector<Index<D>> node{};
    std::vector<real> extra{}, scale{};
    bool empty() const { return node.empty(); }
    std::size_t bytes() const { return node.capacity() * sizeof(Index<D>) + (extra.capacity() + scale.capacity()) * sizeof(real); }
    /// f(I, extra, scale) for all of them.
    template <class F>
    void each(F&& f) const {
        constexpr int worth_threads = 4096;
        const int count = static_cast<int>(node.size());
        const auto one = [&](int i) {
            f(node[static_cast<std::size_t>(i)], extra[static_cast<std::size_t>(i)], scale[static_cast<std::size_t>(i)]);
        };
        if (count >= worth_threads) return parallel_for(0, count, one);
        for (int i = 0; i < count; ++i) one(i);
    }
};

template <int D>
class Helmholtz {
public:
    /// `open`: for cells, whose flux passes through open faces only.
    Helmholtz(const Nodes<D>& nodes, const Vec<D>& h, const Boundary<D>& boundary, OpenFaces<D> open, const Extent<D>& extent);
    /// On entry r is the right-hand side (zero outside nodes and mask), on return δ, with ‖residual‖₂ ≤ tolerance ‖r‖₂. δ = 0 in held
    /// cells. Throws NumericalFailure if the tolerance is not reached; `what` names the quantity.
    int solve(Grid<real, D>& r, real a, const Mask<D>& mask, std::span<const Held> held, const char* what, const WallRows<D>& walls = {});
    std::size_t bytes() const { return direction_.bytes() + image_.bytes() + solution_.bytes(); }

private:
    struct System;
    void set_first_direction(const Grid<real, D>& r, const WallRows<D>& walls);
    Nodes<D> nodes_;
    Vec<D> h_;
    Boundary<D> boundary_;
    OpenFaces<D> open_;
    Padded<D> direction_;
    Grid<real, D> image_, solution_;
};

}  // namespace weir::smoke
