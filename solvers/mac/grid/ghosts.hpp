// Ghost values: a copy of a component or cell field with three ghost layers, filled by the boundary conditions of the sides. Kernels then
// read their neighbours without branches at boundaries.
//
//   half-way nodes (cell fields; components along another axis):   q(−k) = 2 v − q(k−1)  Dirichlet v,   q(−k) = q(k−1)  Neumann
//   nodes on the side itself (component a at the ends of axis a):  q(−k) = 2 q(0) − q(k) closed or inflow,   q(−k) = q(0)  open
#pragma once
#include "geometry/sides.hpp"
#include "mac/grid/velocity.hpp"
#include "parallel/grid.hpp"

#include <array>
#include <vector>

namespace weir::mac {

inline constexpr int ghost_layers = 3;  // a cubic stencil at a point clamped to the domain's edge reaches two nodes outside

/// Values on a box with ghost layers. Indices are those of the inner box; they may run from -ghost_layers.
template <int D>
class Padded {
public:
    Padded() = default;
    explicit Padded(const Extent<D>& extent) : extent_(extent), values_(extent + Index<D>::constant(2 * ghost_layers), 0, ghost_layers) {}

    const Extent<D>& extent() const { return extent_; }
    bool empty() const { return values_.empty(); }
    std::ptrdiff_t stride(int axis) const { return values_.stride(axis); }
    std::size_t linear(const Index<D>& I) const { return values_.linear(I + Index<D>::constant(ghost_layers)); }
    real& operator()(const Index<D>& I) { return values_[linear(I)]; }
    const real& operator()(const Index<D>& I) const { return values_[linear(I)]; }
    real* at(const Index<D>& I) { return values_.data() + linear(I); }
    const real* at(const Index<D>& I) const { return values_.data() + linear(I); }
    /// The planes of the slowest axis, each with its ghosts.
    Planes planes() {
        const std::ptrdiff_t plane = stride(D - 1);
        return {values_.data() + ghost_layers * plane, sizeof(real) * static_cast<std::size_t>(plane), extent_[D - 1], ghost_layers,
                values_.store().held()};
    }
    /// In parallel, allocates `ghost_planes` planes.
    void open(int ghost_planes, bool ring) { values_.store().open(ghost_planes, ring); }
    bool holds(int plane) const { return values_.store().holds(plane); }
    std::size_t bytes() const { return values_.bytes(); }

private:
    Extent<D> extent_;
    Grid<real, D> values_;
};

/// All components of a velocity with their ghosts.
template <int D>
struct PaddedVelocity {
    std::array<Padded<D>, D> face;
    PaddedVelocity() = default;
    explicit PaddedVelocity(const MacVelocity<D>& u) {
        for (int a = 0; a < D; ++a) (*this)[a] = Padded<D>(u[a].extent());
    }
    Padded<D>& operator[](int a) { return face[static_cast<std::size_t>(a)]; }
    const Padded<D>& operator[](int a) const { return face[static_cast<std::size_t>(a)]; }
};

/// The extrapolation of a quantity at one end of one axis.
struct EndRule {
    enum class Kind { periodic, dirichlet, neumann, odd_about_node, constant_beyond_node } kind = Kind::neumann;
    real value = 0;             // Dirichlet value, everywhere on the side ...
    std::vector<real> profile;  // ... or, if not empty, on each node of the side (x fastest)
    real value_at(std::size_t node) const { return profile.empty() ? value : profile[node]; }
};

/// The boundary conditions of a quantity at all ends of the domain.
template <int D>
struct Boundary {
    std::array<std::array<EndRule, 2>, D> end;
    int node_axis = -1;  // the axis on whose sides nodes lie, for a velocity component; −1 for cell fields
    /// The same conditions with zero values: those of a correction to the quantity.
    Boundary homogeneous() const;
};

template <int D>
Boundary<D> velocity_boundary(const geometry::Sides<D>& sides, const MacVelocity<D>& u, int component, real nu);
/// For the field "temperature" or "smoke": Dirichlet where the side has a value. Other fields: zero flux.
template <int D>
Boundary<D> field_boundary(const geometry::Sides<D>& sides, const std::string& field);

/// Copies `from` into the inner box of `to` and fills all ghost layers, axis by axis, corners included.
template <int D>
void fill(Padded<D>& to, const Grid<real, D>& from, const Boundary<D>& boundary);
/// Fills the ghost layers from the values of the inner box.
template <int D>
void fill_ghosts(Padded<D>& q, const Boundary<D>& boundary, int ghost_planes = ghost_layers);

/// The two halves of fill_ghosts: the ghosts within one plane, and then the planes beyond both ends of the last axis. In parallel these
/// include `ghost_planes` planes of other ranks. A subdomain boundary is a side filled by
/// another rank.
template <int D>
void fill_plane_ghosts(Padded<D>& q, const Boundary<D>& boundary, int plane);
template <int D>
void fill_end_planes(Padded<D>& q, const Boundary<D>& boundary, int ghost_planes = ghost_layers);
/// The same for several arrays, exchanged in one message. The last axis must be periodic for all of them or for none.
template <int D>
struct WithBoundary {
    Padded<D>* values;
    const Boundary<D>* boundary;
};
template <int D>
void fill_end_planes(const std::vector<WithBoundary<D>>& list, int ghost_planes = ghost_layers);
template <int D>
void refresh(const std::vector<WithBoundary<D>>& list, int ghost_planes = ghost_layers);
/// In parallel, fills only the ghost planes of other ranks: where their values have changed and those beyond the sides have not.
template <int D>
void refresh(Padded<D>& q, const Boundary<D>& boundary, int ghost_planes = ghost_layers);

/// For every row of one plane of the inner box: f(first, count, to) writes it; then fills the ghosts around it.
template <int D, class F>
void fill_plane(Padded<D>& q, const Boundary<D>& boundary, int plane, F&& f) {
    Index<D> first{};
    first[D - 1] = plane;
    const int rows = D == 2 ? 1 : q.extent()[1];
    for (int j = 0; j < rows; ++j) {
        if constexpr (D == 3) first[1] = j;
        f(first, q.extent()[0], q.at(first));
    }
    fill_plane_ghosts(q, boundary, plane);
}
/// The same for all planes, followed by the ghost planes.
template <int D, class F>
void fill_rows(Padded<D>& q, const Boundary<D>& boundary, F&& f) {
    for_each_plane(q.extent(), [&](int plane) { fill_plane(q, boundary, plane, f); });
    fill_end_planes(q, boundary);
}
/// As fill, without the planes beyond the ends of the last axis.
template <int D>
void fill_planes(Padded<D>& to, const Grid<real, D>& from, const Boundary<D>& boundary);
/// The same; also returns the largest magnitude of `from`, or NaN.
template <int D>
real fill_planes_and_measure(Padded<D>& to, const Grid<real, D>& from, const Boundary<D>& boundary);

}  // namespace weir::mac
