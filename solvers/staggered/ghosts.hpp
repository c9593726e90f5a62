// Ghost values: a copy of a component or a cell field with three layers around it that continue it by the conditions on the sides.
// Every kernel then reads its neighbours without asking where it stands.
//
//   half-way nodes (cell fields; components along another axis):   q(−k) = 2 v − q(k−1)  Dirichlet v,   q(−k) = q(k−1)  Neumann
//   nodes on the side itself (component a at the ends of axis a):  q(−k) = 2 q(0) − q(k) closed or inflow,   q(−k) = q(0)  open
#pragma once
#include "core/grid.hpp"
#include "geometry/sides.hpp"
#include "staggered/velocity.hpp"

#include <array>
#include <vector>

namespace weir::staggered {

inline constexpr int ghost_layers = 3;  // a cubic stencil about a point moved to the domain's edge reaches two nodes out

/// Values on a box with ghost layers. Indices are those of the inner box; they may run from -ghost_layers.
template <int D>
class Padded {
public:
    Padded() { extent_.fill(0); }
    explicit Padded(const Index<D>& extent) : extent_(extent), values_(extent + Index<D>::constant(2 * ghost_layers), 0, ghost_layers) {}

    const Index<D>& extent() const { return extent_; }
    bool empty() const { return values_.empty(); }
    std::ptrdiff_t stride(int axis) const { return values_.stride(axis); }
    std::size_t linear(const Index<D>& I) const { return values_.linear(I + Index<D>::constant(ghost_layers)); }
    real& operator()(const Index<D>& I) { return values_[linear(I)]; }
    const real& operator()(const Index<D>& I) const { return values_[linear(I)]; }
    real* at(const Index<D>& I) { return values_.data() + linear(I); }
    const real* at(const Index<D>& I) const { return values_.data() + linear(I); }
    /// The planes of the slowest axis, each with the ghosts within it.
    Planes planes() {
        const std::ptrdiff_t plane = stride(D - 1);
        return {values_.data() + ghost_layers * plane, sizeof(real) * static_cast<std::size_t>(plane), extent_[D - 1], ghost_layers,
                values_.store().held()};
    }
    /// Over ranks, makes sure of so many planes beyond the cuts.
    void open(int deep, bool ring) { values_.store().open(deep, ring); }
    bool holds(int plane) const { return values_.store().holds(plane); }
    std::size_t bytes() const { return values_.bytes(); }

private:
    Index<D> extent_;
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

/// How one end of one axis continues a quantity.
struct EndRule {
    enum class Kind { periodic, dirichlet, neumann, odd_about_node, constant_beyond_node } kind = Kind::neumann;
    real value = 0;             // Dirichlet value, everywhere on the side ...
    std::vector<real> profile;  // ... or, if not empty, on each node of the side (x fastest)
    real value_at(std::size_t node) const { return profile.empty() ? value : profile[node]; }
};

/// The rules of one quantity at all ends of the domain.
template <int D>
struct Boundary {
    std::array<std::array<EndRule, 2>, D> end;
    int node_axis = -1;  // the axis on whose sides nodes lie: the component of a velocity; none for cell fields
    /// The same kinds with zero values: what a correction to the quantity obeys.
    Boundary homogeneous() const;
};

template <int D>
Boundary<D> velocity_boundary(const geometry::Sides<D>& sides, const MacVelocity<D>& u, int component, real nu);
/// For the field "temperature" or "smoke": Dirichlet where the side names a value. Other fields: no flux.
template <int D>
Boundary<D> field_boundary(const geometry::Sides<D>& sides, const std::string& field);

/// Copies `from` into the inner box of `to` and fills all ghost layers, axis by axis, corners included.
template <int D>
void fill(Padded<D>& to, const Grid<real, D>& from, const Boundary<D>& boundary);
/// Fills the ghost layers from the inner box that is already there.
template <int D>
void fill_ghosts(Padded<D>& q, const Boundary<D>& boundary, int deep = 0);

/// The two halves of fill_ghosts: those of one plane across the last axis, within it, and then the planes beyond both ends of that axis;
/// over ranks, those of other ranks too, as deep as the step wants them or as is said. A cut is a side that another rank continues.
template <int D>
void fill_plane_ghosts(Padded<D>& q, const Boundary<D>& boundary, int plane);
template <int D>
void fill_end_planes(Padded<D>& q, const Boundary<D>& boundary, int deep = 0);
/// The same of several arrays, whose planes travel together. Sides repeat for all of them or for none.
template <int D>
struct WithBoundary {
    Padded<D>* values;
    const Boundary<D>* boundary;
};
template <int D>
void fill_end_planes(const std::vector<WithBoundary<D>>& list, int deep = 0);
template <int D>
void refresh(const std::vector<WithBoundary<D>>& list, int deep = 0);
/// Over ranks, what other ranks own: where their values have changed and those beyond the sides have not.
template <int D>
void refresh(Padded<D>& q, const Boundary<D>& boundary, int deep = 0);

/// f(first, count, to) on every row of one plane of the inner box, which it writes, and the ghosts around it.
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
/// The same for all planes, and then the ghosts beyond them.
template <int D, class F>
void fill_rows(Padded<D>& q, const Boundary<D>& boundary, F&& f) {
    for_each_plane(0, q.extent()[D - 1], [&](int plane) { fill_plane(q, boundary, plane, f); });
    fill_end_planes(q, boundary);
}
/// As fill, without the planes beyond the ends of the last axis.
template <int D>
void fill_planes(Padded<D>& to, const Grid<real, D>& from, const Boundary<D>& boundary);
/// The same; the largest magnitude of `from`, or NaN, is found on the way.
template <int D>
real fill_planes_and_measure(Padded<D>& to, const Grid<real, D>& from, const Boundary<D>& boundary);

}  // namespace weir::staggered
