// One level of the multigrid of implicit viscosity (multigrid.hpp): the system
//
//     (m − ∇·2μD) x = b      m: mass of the faces, μ: viscosity times the time step, in cells and at edges
//
// in single precision. All arrays of a level have one layout, with two layers of ghosts, so one offset is valid for all of them.
#pragma once
#include "mac/grid/ghosts.hpp"
#include "mac/grid/rows.hpp"

#include <array>
#include <vector>

namespace weir::mac::viscous {

inline constexpr int ghosts = 2;

/// Values at the cells, faces or edges of a level. Indices run from −2 to n + 2.
template <int D>
class Field {
public:
    Field() = default;
    explicit Field(const Index<D>& cells) : values_(Extent<D>(cells + Index<D>::constant(2 * ghosts + 1)), 0.0f, ghosts) {}
    std::ptrdiff_t stride(int axis) const { return values_.stride(axis); }
    float* at(const Index<D>& I) { return values_.data() + values_.linear(I + Index<D>::constant(ghosts)); }
    const float* at(const Index<D>& I) const { return values_.data() + values_.linear(I + Index<D>::constant(ghosts)); }
    float& operator()(const Index<D>& I) { return *at(I); }
    const float& operator()(const Index<D>& I) const { return *at(I); }
    void swap(Field& other) { values_.swap(other.values_); }
    std::size_t bytes() const { return values_.bytes(); }

private:
    Grid<float, D> values_;
};

template <int D>
struct Faces {
    std::array<Field<D>, D> component;
    Faces() = default;
    explicit Faces(const Index<D>& cells) { component.fill(Field<D>(cells)); }
    Field<D>& operator[](int a) { return component[static_cast<std::size_t>(a)]; }
    const Field<D>& operator[](int a) const { return component[static_cast<std::size_t>(a)]; }
};

/// The pairs of axes (0, 1), (0, 2), (1, 2): the edges across two axes.
template <int D>
inline constexpr int edge_kinds = D == 2 ? 1 : 3;
inline std::size_t edge_kind(int a, int b) { return static_cast<std::size_t>(a + b - 1); }

/// The axes along which a value lies on nodes, not in the middle of cells: none for cells, two for edges.
template <int D>
struct OnNodes : std::array<bool, D> {};
template <int D>
OnNodes<D> across(int a, int b) {
    OnNodes<D> on_nodes{};
    on_nodes[static_cast<std::size_t>(a)] = on_nodes[static_cast<std::size_t>(b)] = true;
    return on_nodes;
}

/// An edge that rules its faces (stiff_edges.cpp).
struct StiffEdge {
    int count = 0;  // of ruled faces
    std::array<int, 4> axis{};
    std::array<std::ptrdiff_t, 4> at{};  // from the entry of cell 0
    std::array<real, 4> s{}, inverse{}, inverse_q{};
    real factor = 0;  // κ'/(1 + κ' Σ s²/q)
};

/// Which values the ghosts of a field take.
enum class Ghosts {
    velocity,   // those of the conditions at the sides
    transpose,  // so that the restriction is the transpose of the prolongation: 0 beyond nodes on sides
    even,       // mirrored: coefficients
};

template <int D>
struct Level {
    Index<D> cells{};
    Vec<D> h{};
    std::array<bool, D> halved{};        // axes along which the next level has half as many cells, rounded up
    std::array<Index<D>, D> lo{}, hi{};  // unknown faces of each component
    std::array<Boundary<D>, D> boundary;
    bool has_closed_faces = false;
    Faces<D> mass;     // −1 on closed faces, which are no unknowns
    Faces<D> inverse;  // of a diagonal that bounds the matrix from above (matrix.cpp); 0 on closed faces
    Faces<D> mu;       // in cells, of the stress along each component's own axis
    std::array<Field<D>, edge_kinds<D>> shear;
    std::vector<StiffEdge> stiff_edges;
    Faces<D> x, other, b;

    Level(const Index<D>& cells_, const Vec<D>& h_, const std::array<Boundary<D>, D>& boundary_);
    const Field<D>& edge(int a, int b_) const { return shear[edge_kind(a, b_)]; }
    Field<D>& edge(int a, int b_) { return shear[edge_kind(a, b_)]; }
    bool is_periodic(int axis) const { return boundary[0].end[static_cast<std::size_t>(axis)][0].kind == EndRule::Kind::periodic; }
    std::ptrdiff_t stride(int axis) const { return mass[0].stride(axis); }
    std::size_t unknowns() const;
    std::size_t bytes() const;
};

/// f(plane) for planes in [lo, hi). Below this many cells a loop ends sooner than another thread begins.
inline constexpr std::size_t least_shared = 8192;
template <int D, class F>
void for_each_plane_of(const Level<D>& level, int lo, int hi, F&& f) {
    if (product(level.cells) >= least_shared) return parallel_for(lo, hi, f);
    for (int plane = lo; plane < hi; ++plane) f(plane);
}

/// f(a, first, count) on the rows of unknowns.
template <int D, class F>
void for_each_row_of(const Level<D>& level, F&& f) {
    const auto plane_of = [&](int a, int plane) {
        const Index<D>&lo = level.lo[static_cast<std::size_t>(a)], &hi = level.hi[static_cast<std::size_t>(a)];
        Index<D> first = lo;
        first[D - 1] = plane;
        if constexpr (D == 2) return f(a, first, hi[0] - lo[0]);
        for (; first[1] < hi[1]; ++first[1]) f(a, first, hi[0] - lo[0]);
    };
    for_each_plane_of(level, 0, level.cells[D - 1] + 1, [&](int plane) {
        for (int a = 0; a < D; ++a)
            if (plane >= level.lo[static_cast<std::size_t>(a)][D - 1] && plane < level.hi[static_cast<std::size_t>(a)][D - 1])
                plane_of(a, plane);
    });
}

/// The same on blocks of at most row_block unknowns.
template <int D, class F>
void for_each_block_of(const Level<D>& level, F&& f) {
    for_each_row_of(level, [&](int a, const Index<D>& first, int count) {
        for_each_block(first, first[0] + count, [&](const Index<D>& I, int length) { f(a, I, length); });
    });
}

// matrix.cpp
/// The inverse of the bounding diagonal from mass, mu and shear.
template <int D>
void find_inverse(Level<D>& level);
/// y = ω B⁻¹ b.
template <int D>
void start(const Level<D>& level, float omega, Faces<D>& y);
/// y = x + ω B⁻¹ (b − A x); x with its ghosts.
template <int D>
void relax(const Level<D>& level, float omega, const Faces<D>& x, Faces<D>& y);
/// r = b − A x on unknowns; x with its ghosts.
template <int D>
void residual(const Level<D>& level, const Faces<D>& x, Faces<D>& r);
/// out = A x on a row of at most row_block unknowns.
template <int D>
void multiply_row(const Level<D>& level, const Faces<D>& x, int a, const Index<D>& first, int count, float* out);

// stiff_edges.cpp
template <int D>
void find_stiff_edges(Level<D>& level);
/// The faces of stiff edges in y = x + ω B⁻¹ r, where y = x + ω r/diagonal; x = nullptr: 0.
template <int D>
void relax_stiff_edges(const Level<D>& level, float omega, const Faces<D>* x, Faces<D>& y);

// level.cpp
template <int D>
void fill_ghosts(const Level<D>& level, Faces<D>& q, Ghosts kind);
/// The same for values in cells (`node_axes` none) or at edges, which are mirrored or periodic.
template <int D>
void fill_ghosts(const Level<D>& level, Field<D>& q, const OnNodes<D>& on_nodes);

// coarsen.cpp
/// Mass, viscosities and closed faces of the next level. `scratch` of the fine level: x and other.
template <int D>
void coarsen(Level<D>& fine, Level<D>& coarse);

// transfer.cpp
/// coarse = 2^−d Pᵀ fine, d the number of halved axes; fine with its transpose ghosts.
template <int D>
void restrict_faces(const Level<D>& fine, const Faces<D>& from, const Level<D>& coarse, Faces<D>& to);
/// x += P coarse on unknowns, P linear along all axes; coarse with its ghosts.
template <int D>
void add_prolonged(const Level<D>& coarse, const Faces<D>& from, const Level<D>& fine, Faces<D>& x);

}  // namespace weir::mac::viscous
