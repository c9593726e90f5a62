// Shapes as signed distances (negative inside), constructed from a scene's tables: the common description of liquid, solids and emitters.
// Distances of box, sphere, plane, capsule and cylinder are exact; that of a union is exact outside, that of a difference is a lower bound
// of the magnitude (Quilez 2008, "Modeling with distance functions"; Ericson 2005, ch. 5).
#pragma once
#include "core/types.hpp"
#include "scene/scene.hpp"

#include <memory>
#include <string>
#include <vector>

namespace weir::geometry {

struct PosedMesh;

template <int D>
class Shape;
template <int D>
using ShapePtr = std::shared_ptr<const Shape<D>>;

/// The parts of a compound shape: added and subtracted shapes. Empty for a simple shape.
template <int D>
struct Parts {
    std::vector<ShapePtr<D>> united{}, removed{};
};

/// A closed region of space at rest. Immutable, cheap to copy by pointer.
template <int D>
class Shape {
public:
    virtual ~Shape() = default;
    /// Signed distance from x to the surface [m], negative inside.
    virtual real distance(const Vec<D>& x) const = 0;
    /// Upper bound of the gradient of the distance.
    virtual real steepest() const { return 1; }
    /// Returns whether the distance is convex along lines of a direction.
    virtual bool convex_along(const Vec<D>& /*direction*/) const { return false; }
    virtual Parts<D> parts() const { return {}; }
    /// The default centre of rotation.
    virtual Vec<D> centre() const = 0;
    /// distance(x) on devices: an expression of OpenCL C with the functions of particles/kernels/shapes.cl.
    virtual std::string code() const = 0;
    /// Its triangles, if any: for drawing and mass properties.
    virtual const PosedMesh* mesh() const { return nullptr; }
    bool contains(const Vec<D>& x) const { return distance(x) < 0; }
};

template <int D>
ShapePtr<D> box(const Vec<D>& min, const Vec<D>& max);
/// A circle in 2D.
template <int D>
ShapePtr<D> sphere(const Vec<D>& centre, real radius);
/// The half space behind the normal (which need not have unit length).
template <int D>
ShapePtr<D> plane(const Vec<D>& point, const Vec<D>& normal);
/// All points below y = level + amplitude cos(2 pi x / wavelength). The distance is of second order in the slope.
template <int D>
ShapePtr<D> wave(real level, real amplitude, real wavelength);
template <int D>
ShapePtr<D> capsule(const Vec<D>& from, const Vec<D>& to, real radius);
/// Flat-ended; in 2D a rectangle of half width `radius` about the axis.
template <int D>
ShapePtr<D> cylinder(const Vec<D>& from, const Vec<D>& to, real radius);
template <int D>
ShapePtr<D> unite(std::vector<ShapePtr<D>> parts);
template <int D>
ShapePtr<D> subtract(ShapePtr<D> from, std::vector<ShapePtr<D>> minus);

/// The shape of a scene's table: { shape = "sphere", centre = [...], radius = ... }.
template <int D>
ShapePtr<D> make_shape(const scene::Table& table);
/// All shapes of a list of tables ("liquid", ...), in order.
template <int D>
std::vector<ShapePtr<D>> make_shapes(const std::vector<scene::Table>& tables);

}  // namespace weir::geometry
