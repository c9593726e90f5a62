// Volume, centroid and second moments of shapes: by closed formulas for box, ball, capsule, cylinder and meshes, otherwise by adaptive
// quadrature over rays along the last axis inside the shape's signed distance.
#pragma once
#include "core/types.hpp"
#include "geometry/shape.hpp"
#include "scene/scene.hpp"

#include <array>

namespace weir::rigid {

/// Quadrature error relative to the volume of the shape's bounding box.
inline constexpr real quadrature_tolerance = 3e-7;

/// Of unit density. second[a][b] = ∫ (x − centre)_a (x − centre)_b.
template <int D>
struct Moments {
    real volume = 0;  // [m^D]
    Vec<D> centre{};
    std::array<Vec<D>, D> second{};
};

/// A bounding box of a shape; infinite for unbounded shapes.
template <int D>
struct Bounds {
    Vec<D> min = Vec<D>::constant(infinity), max = Vec<D>::constant(-infinity);
    bool finite() const;
    void join(const Bounds& other);
};

template <int D>
Bounds<D> bounds_of(const scene::Table& shape);

template <int D>
Moments<D> moments_of(const scene::Table& shape);

/// The same by quadrature, for any shape.
template <int D>
Moments<D> integrate(const geometry::Shape<D>& shape, const Bounds<D>& bounds, real tolerance = quadrature_tolerance);

}  // namespace weir::rigid
