#include "rigid/moments.hpp"

#include "geometry/mesh/mesh.hpp"

#include <algorithm>
#include <cmath>

namespace weir::rigid {

template <int D>
bool Bounds<D>::finite() const {
    for (int a = 0; a < D; ++a)
        if (!(min[a] > -infinity && max[a] < infinity)) return false;
    return true;
}

template <int D>
void Bounds<D>::join(const Bounds& other) {
    for (int a = 0; a < D; ++a) min[a] = std::min(min[a], other.min[a]), max[a] = std::max(max[a], other.max[a]);
}

namespace {

template <int D>
Bounds<D> around(const Vec<D>& from, const Vec<D>& to, const Vec<D>& reach) {
    Bounds<D> box;
    for (int a = 0; a < D; ++a) box.min[a] = std::min(from[a], to[a]) - reach[a], box.max[a] = std::max(from[a], to[a]) + reach[a];
    return box;
}

/// Second moments of a body of revolution about the axis u (unit length).
template <int D>
std::array<Vec<D>, D> about_axis(const Vec<D>& u, real along, real across) {
    std::array<Vec<D>, D> m{};
    for (int a = 0; a < D; ++a)
        for (int b = 0; b < D; ++b) m[static_cast<std::size_t>(a)][b] = (along - across) * u[a] * u[b] + (a == b ? across : 0);
    return m;
}

template <int D>
Moments<D> of_box(const Vec<D>& min, const Vec<D>& max) {
    Moments<D> m;
    m.volume = 1;
    m.centre = 0.5 * (min + max);
    for (int a = 0; a < D; ++a) m.volume *= max[a] - min[a];
    for (int a = 0; a < D; ++a) m.second[static_cast<std::size_t>(a)][a] = m.volume * (max[a] - min[a]) * (max[a] - min[a]) / 12;
    return m;
}

template <int D>
Moments<D> of_ball(const Vec<D>& centre, real r) {
    Moments<D> m;
    m.volume = D == 2 ? pi * r * r : 4 * pi / 3 * r * r * r;
    m.centre = centre;
    for (int a = 0; a < D; ++a) m.second[static_cast<std::size_t>(a)][a] = m.volume * r * r / (D + 2);
    return m;
}

template <int D>
Moments<D> of_cylinder(const Vec<D>& from, const Vec<D>& to, real r) {
    Moments<D> m;
    const real length = norm(to - from);
    m.volume = length * (D == 2 ? 2 * r : pi * r * r);
    m.centre = 0.5 * (from + to);
    m.second = about_axis<D>((to - from) / length, m.volume * length * length / 12, m.volume * r * r / (D == 2 ? 3 : 4));
    return m;
}

/// A cylinder and two half balls (half discs), whose centroids lie 3r/8 (4r/3π) beyond its ends.
template <int D>
Moments<D> of_capsule(const Vec<D>& from, const Vec<D>& to, real r) {
    const real length = norm(to - from);
    if (length == 0) return of_ball<D>(from, r);
    Moments<D> m = of_cylinder<D>(from, to, r);
    const real ends = D == 2 ? pi * r * r : 4 * pi / 3 * r * r * r, beyond = D == 2 ? 4 * r / (3 * pi) : 3 * r / 8;
    const real own = ends * r * r / (D + 2), along = ends * (length * length / 4 + length * beyond) + own;
    const auto more = about_axis<D>((to - from) / length, along, own);
    for (std::size_t a = 0; a < D; ++a) m.second[a] += more[a];
    m.volume += ends;
    return m;
}

/// Moments of a mesh by the divergence theorem, transformed: lengths by the scale s, moments by s^5 R S R^T.
template <int D>
Moments<D> of_mesh(const geometry::PosedMesh& posed) {
    Moments<D> m;
    if constexpr (D == 3) {
        const real s3 = posed.scale * posed.scale * posed.scale;
        m.volume = s3 * posed.mesh->volume();
        m.centre = posed.to_scene(posed.mesh->centre());
        for (std::size_t i = 0; i < 3; ++i)
            for (std::size_t j = 0; j < 3; ++j)
                for (std::size_t k = 0; k < 3; ++k)
                    m.second[i][j] +=
                        s3 * posed.scale * posed.scale * posed.rotation[i][k] * dot(posed.rotation[j], posed.mesh->second()[k]);
    }
    return m;
}

/// 1, x_a, x_a x_b (a <= b).
template <int D>
struct Sums : std::array<real, 1 + D + D*(D + 1) / 2> {
    Sums() { this->fill(0); }
    void add(real f, const Sums& s) {
        for (std::size_t i = 0; i < this->size(); ++i) (*this)[i] += f * s[i];
    }
    real largest_difference(const Sums& s) const {
        real d = 0;
        for (std::size_t i = 0; i < this->size(); ++i) d = std::max(d, std::abs((*this)[i] - s[i]));
        return d;
    }
};

/// Nested adaptive Simpson rules over all axes except the last, in coordinates of the unit cube of the box.
template <int D>
class Quadrature {
public:
    Quadrature(const geometry::Shape<D>& shape, const Bounds<D>& box, real tolerance)
        : shape_(shape), box_(box), size_(box.max - box.min), tolerance_(tolerance) {}

    Sums<D> total() {
        Vec<D> x{};
        return over<0>(x, tolerance_);
    }

private:
    static constexpr int panels = 8, deepest = 24;

    template <int A>
    Sums<D> over(Vec<D>& x, real tolerance) const {
        if constexpr (A == D - 1) {
            return along_ray(x);
        } else {
            const auto f = [&](real at) {
                x[A] = at;
                return over<A + 1>(x, tolerance);
            };
            Sums<D> sum;
            Sums<D> left = f(0);
            for (int i = 0; i < panels; ++i) {
                const real a = static_cast<real>(i) / panels, b = static_cast<real>(i + 1) / panels;
                const Sums<D> middle = f(0.5 * (a + b)), right = f(b);
                sum.add(1, simpson(f, a, b, left, middle, right, tolerance, 0));
                left = right;
            }
            return sum;
        }
    }

    template <class F>
    Sums<D> simpson(F&& f, real a, real b, const Sums<D>& left, const Sums<D>& middle, const Sums<D>& right, real tolerance,
                    int depth) const {
        const real m = 0.5 * (a + b);
        const Sums<D> lower = f(0.5 * (a + m)), upper = f(0.5 * (m + b));
        const auto rule = [](real width, const Sums<D>& x, const Sums<D>& y, const Sums<D>& z) {
            Sums<D> s;
            s.add(width / 6, x), s.add(4 * width / 6, y), s.add(width / 6, z);
            return s;
        };
        const Sums<D> whole = rule(b - a, left, middle, right);
        Sums<D> halves = rule(m - a, left, lower, middle);
        halves.add(1, rule(b - m, middle, upper, right));
        if (depth == deepest || halves.largest_difference(whole) <= 15 * tolerance * (b - a)) return halves;
        Sums<D> sum = simpson(f, a, m, left, lower, middle, tolerance, depth + 1);
        sum.add(1, simpson(f, m, b, middle, upper, right, tolerance, depth + 1));
        return sum;
    }

    real distance(Vec<D> x, real z) const {
        x[D - 1] = z;
        for (int a = 0; a < D; ++a) x[a] = box_.min[a] + size_[a] * x[a];
        return shape_.distance(x);
    }

    /// Steps as far as the signed distance guarantees no change, at least a thousandth of the box; bisects changes of sign.
    Sums<D> along_ray(const Vec<D>& x) const {
        constexpr real least = 1e-3;
        Sums<D> sum;
        real z = 0, d = distance(x, 0), begin = d < 0 ? 0 : -1;
        while (z < 1) {
            const real next = std::min(1.0, z + std::max(least, std::abs(d) / size_[D - 1])), after = distance(x, next);
            if ((after < 0) != (d < 0)) {
                const real crossing = root(x, z, next, d, after);
                if (after < 0)
                    begin = crossing;
                else
                    add_interval(x, begin, crossing, sum);
            }
            z = next, d = after;
        }
        if (d < 0) add_interval(x, begin, 1, sum);
        return sum;
    }

    /// Regula falsi, Illinois variant.
    real root(const Vec<D>& x, real a, real b, real fa, real fb) const {
        for (int i = 0; i < 60 && b - a > 1e-14; ++i) {
            const real c = std::clamp((a * fb - b * fa) / (fb - fa), a, b), fc = distance(x, c);
            if (std::abs(fc) < 1e-13 * size_[D - 1]) return c;
            if ((fc < 0) == (fa < 0))
                a = c, fa = fc, fb *= 0.5;
            else
                b = c, fb = fc, fa *= 0.5;
        }
        return 0.5 * (a + b);
    }

    static void add_interval(const Vec<D>& x, real from, real to, Sums<D>& sum) {
        const real n0 = to - from, n1 = 0.5 * (to * to - from * from), n2 = (to * to * to - from * from * from) / 3;
        std::size_t at = 0;
        sum[at++] += n0;
        for (int a = 0; a < D; ++a) sum[at++] += a == D - 1 ? n1 : x[a] * n0;
        for (int a = 0; a < D; ++a)
            for (int b = a; b < D; ++b) sum[at++] += a == D - 1 ? n2 : b == D - 1 ? x[a] * n1 : x[a] * x[b] * n0;
    }

    const geometry::Shape<D>& shape_;
    Bounds<D> box_;
    Vec<D> size_;
    real tolerance_;
};

}  // namespace

template <int D>
Bounds<D> bounds_of(const scene::Table& shape) {
    const std::string& kind = shape.text("shape");
    const auto all = [](real r) { return Vec<D>::constant(r); };
    if (kind == "box") return around<D>(shape.vec<D>("min"), shape.vec<D>("max"), all(0));
    if (kind == "sphere") return around<D>(shape.vec<D>("centre"), shape.vec<D>("centre"), all(shape.number("radius")));
    if (kind == "capsule") return around<D>(shape.vec<D>("from"), shape.vec<D>("to"), all(shape.number("radius")));
    if (kind == "cylinder") {
        const Vec<D> from = shape.vec<D>("from"), to = shape.vec<D>("to"), u = (to - from) / norm(to - from);
        Vec<D> reach;
        for (int a = 0; a < D; ++a) reach[a] = shape.number("radius") * std::sqrt(std::max(0.0, 1 - u[a] * u[a]));
        return around<D>(from, to, reach);
    }
    if constexpr (D == 3)
        if (kind == "mesh") {
            Bounds<D> box;
            const geometry::PosedMesh posed = geometry::make_mesh(shape);
            for (const Vec<3>& y : posed.mesh->triangles().points) {
                const Vec<3> x = posed.to_scene(y);
                box.join({x, x});
            }
            return box;
        }
    if (kind == "union") {
        Bounds<D> box;
        for (const auto& part : shape.tables("of")) box.join(bounds_of<D>(part));
        return box;
    }
    if (kind == "difference") return bounds_of<D>(shape.table("from"));
    return {all(-infinity), all(infinity)};
}

template <int D>
Moments<D> moments_of(const scene::Table& shape) {
    const std::string& kind = shape.text("shape");
    if (kind == "box") return of_box<D>(shape.vec<D>("min"), shape.vec<D>("max"));
    if (kind == "sphere") return of_ball<D>(shape.vec<D>("centre"), shape.number("radius"));
    if (kind == "capsule") return of_capsule<D>(shape.vec<D>("from"), shape.vec<D>("to"), shape.number("radius"));
    if (kind == "cylinder") return of_cylinder<D>(shape.vec<D>("from"), shape.vec<D>("to"), shape.number("radius"));
    const auto whole = geometry::make_shape<D>(shape);
    return whole->mesh() ? of_mesh<D>(*whole->mesh()) : integrate<D>(*whole, bounds_of<D>(shape));
}

template <int D>
Moments<D> integrate(const geometry::Shape<D>& shape, const Bounds<D>& box, real tolerance) {
    const Sums<D> sums = Quadrature<D>(shape, box, tolerance).total();
    const Vec<D> size = box.max - box.min;
    real volume = 1;
    for (int a = 0; a < D; ++a) volume *= size[a];
    Moments<D> m;
    m.volume = volume * sums[0];
    if (!(sums[0] > 0)) return m;
    Vec<D> unit{};  // the centroid in the unit cube
    for (int a = 0; a < D; ++a) unit[a] = sums[1 + static_cast<std::size_t>(a)] / sums[0];
    std::size_t at = 1 + D;
    for (int a = 0; a < D; ++a) {
        m.centre[a] = box.min[a] + size[a] * unit[a];
        for (int b = a; b < D; ++b) {
            const real s = volume * size[a] * size[b] * (sums[at++] - sums[0] * unit[a] * unit[b]);
            m.second[static_cast<std::size_t>(a)][b] = m.second[static_cast<std::size_t>(b)][a] = s;
        }
    }
    return m;
}

#define WEIR_INSTANTIATE(D)                                 \
    template struct Bounds<D>;                              \
    template Bounds<D> bounds_of<D>(const scene::Table&);   \
    template Moments<D> moments_of<D>(const scene::Table&); \
    template Moments<D> integrate<D>(const geometry::Shape<D>&, const Bounds<D>&, real);
WEIR_INSTANTIATE(2)
WEIR_INSTANTIATE(3)
#undef WEIR_INSTANTIATE

}  // namespace weir::rigid
