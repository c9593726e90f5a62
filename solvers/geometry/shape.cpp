#include "geometry/shape.hpp"

#include "core/error.hpp"
#include "core/hex_number.hpp"
#include "geometry/mesh/mesh.hpp"

#include <algorithm>
#include <cmath>

namespace weir::geometry {

namespace {

template <int D>
std::string code(const Vec<D>& x) {
    return "(double4)(" + hex_number(x[0]) + ", " + hex_number(x[1]) + ", " + hex_number(D == 3 ? x[D - 1] : 0) + ", 0)";
}
std::string code(real x) { return hex_number(x); }
/// The text of a function call with the position x.
template <class... Arguments>
std::string call(const std::string& function, const Arguments&... arguments) {
    return function + "(x" + ((", " + code(arguments)) + ...) + ")";
}

template <int D>
struct Box final : Shape<D> {
    Vec<D> min, max;
    Box(const Vec<D>& a, const Vec<D>& b) : min(a), max(b) {}
    real distance(const Vec<D>& x) const override {
        real outside = 0, inside = -infinity;
        for (int d = 0; d < D; ++d) {
            const real q = std::max(min[d] - x[d], x[d] - max[d]);
            inside = std::max(inside, q);
            outside += q > 0 ? q * q : 0;
        }
        return inside > 0 ? std::sqrt(outside) : inside;
    }
    bool convex_along(const Vec<D>&) const override { return true; }
    Vec<D> centre() const override { return 0.5 * (min + max); }
    std::string code() const override { return call("shape_box", min, max); }
};

template <int D>
struct Sphere final : Shape<D> {
    Vec<D> c;
    real radius;
    Sphere(const Vec<D>& c_, real r) : c(c_), radius(r) {}
    real distance(const Vec<D>& x) const override { return norm(x - c) - radius; }
    bool convex_along(const Vec<D>&) const override { return true; }
    Vec<D> centre() const override { return c; }
    std::string code() const override { return call("shape_sphere", c, radius); }
};

template <int D>
struct Plane final : Shape<D> {
    Vec<D> point, n;
    Plane(const Vec<D>& p, const Vec<D>& normal) : point(p), n(normal / norm(normal)) {}
    real distance(const Vec<D>& x) const override { return dot(n, x - point); }
    bool convex_along(const Vec<D>&) const override { return true; }
    Vec<D> centre() const override { return point; }
    std::string code() const override { return call("shape_plane", point, n); }
};

/// Vertical distance times the cosine of the local slope: exact where the surface is flat, with an error of (slope x curvature) near it.
template <int D>
struct Wave final : Shape<D> {
    real level, amplitude, k;
    Wave(real level_, real amplitude_, real wavelength) : level(level_), amplitude(amplitude_), k(2 * pi / wavelength) {}
    real distance(const Vec<D>& x) const override {
        const real slope = amplitude * k * std::sin(k * x[0]);
        return (x[1] - level - amplitude * std::cos(k * x[0])) / std::sqrt(1 + slope * slope);
    }
    real steepest() const override { return 2; }  // within a tenth of 1/(amplitude k²) from the surface; larger distances are not used
    bool convex_along(const Vec<D>& direction) const override { return direction[0] == 0; }  // linear: the slope is of x alone
    Vec<D> centre() const override { return level * Vec<D>::unit(1); }
    std::string code() const override { return call("shape_wave", level, amplitude, k); }
};

template <int D>
struct Capsule final : Shape<D> {
    Vec<D> a, b;
    real radius;
    Capsule(const Vec<D>& from, const Vec<D>& to, real r) : a(from), b(to), radius(r) {}
    real distance(const Vec<D>& x) const override {
        const Vec<D> axis = b - a;
        const real length2 = dot(axis, axis);
        const real s = length2 > 0 ? std::clamp(dot(x - a, axis) / length2, 0.0, 1.0) : 0.0;
        return norm(x - a - s * axis) - radius;
    }
    bool convex_along(const Vec<D>&) const override { return true; }
    Vec<D> centre() const override { return 0.5 * (a + b); }
    std::string code() const override { return call("shape_capsule", a, b, radius); }
};

/// In coordinates along the axis (z, from the centre) and across it (r) the cylinder is the box |z| <= half, r <= radius.
template <int D>
struct Cylinder final : Shape<D> {
    Vec<D> middle, axis;
    real half, radius;
    Cylinder(const Vec<D>& from, const Vec<D>& to, real r)
        : middle(0.5 * (from + to)), axis((to - from) / norm(to - from)), half(0.5 * norm(to - from)), radius(r) {}
    real distance(const Vec<D>& x) const override {
        const Vec<D> y = x - middle;
        const real z = dot(y, axis), dz = std::abs(z) - half, dr = norm(y - z * axis) - radius;
        if (dz <= 0 || dr <= 0) return std::max(dz, dr);
        return std::sqrt(dz * dz + dr * dr);
    }
    bool convex_along(const Vec<D>&) const override { return true; }
    Vec<D> centre() const override { return middle; }
    std::string code() const override { return call("shape_cylinder", middle, axis, half, radius); }
};

template <int D>
struct Union final : Shape<D> {
    std::vector<ShapePtr<D>> parts_of;
    explicit Union(std::vector<ShapePtr<D>> p) : parts_of(std::move(p)) {}
    real distance(const Vec<D>& x) const override {
        real d = infinity;
        for (const auto& part : parts_of) d = std::min(d, part->distance(x));
        return d;
    }
    real steepest() const override {
        real most = 1;
        for (const auto& part : parts_of) most = std::max(most, part->steepest());
        return most;
    }
    Parts<D> parts() const override { return {parts_of, {}}; }
    Vec<D> centre() const override {
        Vec<D> sum{};
        for (const auto& part : parts_of) sum += part->centre();
        return sum / static_cast<real>(std::max<std::size_t>(1, parts_of.size()));
    }
    std::string code() const override {
        std::string least = hex_number(infinity);
        for (const auto& part : parts_of) least = "fmin(" + least + ", " + part->code() + ")";
        return least;
    }
};

template <int D>
struct Difference final : Shape<D> {
    ShapePtr<D> from;
    std::vector<ShapePtr<D>> minus;
    Difference(ShapePtr<D> f, std::vector<ShapePtr<D>> m) : from(std::move(f)), minus(std::move(m)) {}
    real distance(const Vec<D>& x) const override {
        real d = from->distance(x);
        for (const auto& hole : minus) d = std::max(d, -hole->distance(x));
        return d;
    }
    real steepest() const override {
        real most = from->steepest();
        for (const auto& hole : minus) most = std::max(most, hole->steepest());
        return most;
    }
    Parts<D> parts() const override { return {{from}, minus}; }
    Vec<D> centre() const override { return from->centre(); }
    std::string code() const override {
        std::string most = from->code();
        for (const auto& hole : minus) most = "fmax(" + most + ", -" + hole->code() + ")";
        return most;
    }
};

struct OfTriangles final : Shape<3> {
    PosedMesh posed;
    explicit OfTriangles(PosedMesh p) : posed(std::move(p)) {}
    real distance(const Vec<3>& x) const override { return posed.scale * posed.mesh->distance(posed.to_file(x)); }
    real steepest() const override { return std::sqrt(3.0); }  // linear between nodes with exact values
    Vec<3> centre() const override { return posed.to_scene(posed.mesh->centre()); }
    std::string code() const override {
        throw BadInput("a shape \"mesh\" is not supported on OpenCL devices: set scheme.backend = \"threads\"");
    }
    const PosedMesh* mesh() const override { return &posed; }
};

template <int D>
ShapePtr<D> triangles(const scene::Table& table) {
    if constexpr (D == 3)
        return std::make_shared<OfTriangles>(make_mesh(table));
    else
        throw BadInput("a shape \"mesh\" has three dimensions, and this scene has two");
}

}  // namespace

template <int D>
ShapePtr<D> box(const Vec<D>& min, const Vec<D>& max) {
    return std::make_shared<Box<D>>(min, max);
}
template <int D>
ShapePtr<D> sphere(const Vec<D>& centre, real radius) {
    return std::make_shared<Sphere<D>>(centre, radius);
}
template <int D>
ShapePtr<D> plane(const Vec<D>& point, const Vec<D>& normal) {
    return std::make_shared<Plane<D>>(point, normal);
}
template <int D>
ShapePtr<D> wave(real level, real amplitude, real wavelength) {
    return std::make_shared<Wave<D>>(level, amplitude, wavelength);
}
template <int D>
ShapePtr<D> capsule(const Vec<D>& from, const Vec<D>& to, real radius) {
    return std::make_shared<Capsule<D>>(from, to, radius);
}
template <int D>
ShapePtr<D> cylinder(const Vec<D>& from, const Vec<D>& to, real radius) {
    return std::make_shared<Cylinder<D>>(from, to, radius);
}
template <int D>
ShapePtr<D> unite(std::vector<ShapePtr<D>> parts) {
    return std::make_shared<Union<D>>(std::move(parts));
}
template <int D>
ShapePtr<D> subtract(ShapePtr<D> from, std::vector<ShapePtr<D>> minus) {
    return std::make_shared<Difference<D>>(std::move(from), std::move(minus));
}

template <int D>
ShapePtr<D> make_shape(const scene::Table& table) {
    const std::string& kind = table.text("shape");
    if (kind == "box") return box<D>(table.vec<D>("min"), table.vec<D>("max"));
    if (kind == "sphere") return sphere<D>(table.vec<D>("centre"), table.number("radius"));
    if (kind == "plane") return plane<D>(table.vec<D>("point"), table.vec<D>("normal"));
    if (kind == "wave") return wave<D>(table.number("level"), table.number("amplitude"), table.number("wavelength"));
    if (kind == "capsule") return capsule<D>(table.vec<D>("from"), table.vec<D>("to"), table.number("radius"));
    if (kind == "cylinder") return cylinder<D>(table.vec<D>("from"), table.vec<D>("to"), table.number("radius"));
    if (kind == "mesh") return triangles<D>(table);
    if (kind == "union") return unite<D>(make_shapes<D>(table.tables("of")));
    if (kind == "difference") return subtract<D>(make_shape<D>(table.table("from")), make_shapes<D>(table.tables("minus")));
    throw std::logic_error("shape \"" + kind + "\" is in the schema but has no maker");
}

template <int D>
std::vector<ShapePtr<D>> make_shapes(const std::vector<scene::Table>& tables) {
    std::vector<ShapePtr<D>> shapes;
    shapes.reserve(tables.size());
    for (const auto& table : tables) shapes.push_back(make_shape<D>(table));
    return shapes;
}

#define WEIR_INSTANTIATE(D)                                                  \
    template ShapePtr<D> box<D>(const Vec<D>&, const Vec<D>&);               \
    template ShapePtr<D> sphere<D>(const Vec<D>&, real);                     \
    template ShapePtr<D> plane<D>(const Vec<D>&, const Vec<D>&);             \
    template ShapePtr<D> wave<D>(real, real, real);                          \
    template ShapePtr<D> capsule<D>(const Vec<D>&, const Vec<D>&, real);     \
    template ShapePtr<D> cylinder<D>(const Vec<D>&, const Vec<D>&, real);    \
    template ShapePtr<D> unite<D>(std::vector<ShapePtr<D>>);                 \
    template ShapePtr<D> subtract<D>(ShapePtr<D>, std::vector<ShapePtr<D>>); \
    template ShapePtr<D> make_shape<D>(const scene::Table&);                 \
    template std::vector<ShapePtr<D>> make_shapes<D>(const std::vector<scene::Table>&);
WEIR_INSTANTIATE(2)
WEIR_INSTANTIATE(3)
#undef WEIR_INSTANTIATE

}  // namespace weir::geometry
