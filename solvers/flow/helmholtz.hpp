// (I − a ∇²) δ = r on the nodes of one kind (a velocity component or cells), by conjugate gradients: the linear solve of implicit
// viscosity and diffusion. ∇² is the 5- or 7-point Laplacian. δ is a correction: it obeys the homogeneous conditions of the sides.
#pragma once
#include "core/grid.hpp"
#include "flow/effects.hpp"
#include "staggered/ghosts.hpp"

#include <span>
#include <type_traits>
#include <vector>

namespace weir::flow {

/// The open fractions of all faces, or nullptr where all are open.
template <int D>
using OpenFaces = const std::array<Grid<real, D>, D>*;

/// The nodes that take part: 1, others 0, with ghosts. Empty: all do.
template <int D>
using Mask = Padded<D>;

/// out = (q(I + e_b) − 2 q(I) + q(I − e_b)) / h_b², summed over b, on `nodes`; zero where the mask is. Of cells beside solids each
/// difference is weighed by the open fraction of the face between them.
template <int D>
void laplacian(const Padded<D>& q, const Vec<D>& h, const Nodes<D>& nodes, const Mask<D>& mask, std::type_identity_t<OpenFaces<D>> open,
               Grid<real, D>& out);

/// Rows of the implicit solve that walls change: ∇²δ has `extra` δ(I) more there. The solve is for δ/scale, which makes their diagonal as
/// large as that of other rows.
template <int D>
struct WallRows {
    std::vector<Index<D>> node{};
    std::vector<real> extra{}, scale{};
    bool empty() const { return node.empty(); }
    std::size_t bytes() const { return node.capacity() * sizeof(Index<D>) + (extra.capacity() + scale.capacity()) * sizeof(real); }
    /// f(I, extra, scale) on all of them.
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
    /// `open`: nodes are cells, of which only open faces let anything through.
    Helmholtz(const Nodes<D>& nodes, const Vec<D>& h, const Boundary<D>& boundary, OpenFaces<D> open, const Index<D>& extent);
    /// r on entry the right-hand side (zero outside nodes and mask), on return δ, to ‖residual‖₂ ≤ tolerance ‖r‖₂. δ = 0 in held cells.
    /// Throws NumericalFailure when that is not reached; `what` names the quantity.
    int solve(Grid<real, D>& r, real a, const Mask<D>& mask, std::span<const Held> held, const char* what, const WallRows<D>& walls = {});
    std::size_t bytes() const { return direction_.bytes() + image_.bytes() + solution_.bytes(); }

private:
    void begin(const Grid<real, D>& r, const WallRows<D>& walls);
    real dot(const Grid<real, D>& x, const Grid<real, D>& y) const;
    Nodes<D> nodes_;
    Vec<D> h_;
    Boundary<D> boundary_;
    OpenFaces<D> open_;
    Padded<D> direction_;
    Grid<real, D> image_, solution_;
};

}  // namespace weir::flow
