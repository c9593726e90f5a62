// Boxes of the scene's list "floats": prescribed or free vertical motion, and the columns that a box covers.
#include "heightfield/floats.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace weir::heightfield {

namespace {

/// An axis-aligned box with vertical sides.
template <int D>
class Box final : public Body {
public:
    Box(const scene::Table& table, const Plane& plane, real rho) : plane_(plane), size_(table.vec<D>("size")), at_(table.vec<D>("at")) {
        moves_ = table.has("motion");
        if (moves_) motion_ = geometry::Motion<D>::make(table.table("motion"), at_);
        heaves_ = table.flag("heave");
        height_ = at_[1];
        real volume = 1;
        for (int a = 0; a < D; ++a) volume *= size_[a];
        mass_ = heaves_ ? rho * table.number("density") * volume : infinity;
    }
    void move(real t, std::vector<Cover>& covers) override {
        const geometry::Pose<D> pose = motion_.pose(t);
        if (!heaves_) height_ = at_[1] + pose.offset[1], speed_ = pose.velocity[1];
        offset_ = pose.offset;
        const real x = at_[0] + pose.offset[0], x0 = x - size_[0] / 2 - plane_.x0, x1 = x + size_[0] / 2 - plane_.x0;
        real z0 = 0, z1 = plane_.dz;
        if constexpr (D == 3) {
            const real z = at_[2] + pose.offset[2];
            z0 = z - size_[2] / 2 - plane_.z0, z1 = z + size_[2] / 2 - plane_.z0;
        }
        const real soft = moves_ ? 1 : 0;  // columns on either side of an edge
        const auto first = [&](real from, real d) { return std::max(0, static_cast<int>(std::floor(from / d - soft))); };
        const auto behind = [&](real to, real d, int n) { return std::min(n, static_cast<int>(std::ceil(to / d + soft))); };
        const auto part = [&](real from, real to, int i, real d) { return before(to / d - i) - before(from / d - i); };
        const auto along_z = [&](int k) { return D == 3 ? part(z0, z1, k, plane_.dz) : 1; };
        for (int k = first(z0, plane_.dz); k < behind(z1, plane_.dz, plane_.nz); ++k)
            for (int i = first(x0, plane_.dx); i < behind(x1, plane_.dx, plane_.nx); ++i)
                if (const real covered = part(x0, x1, i, plane_.dx) * along_z(k); covered > 1e-12)
                    covers.push_back({plane_.at(i, k), std::min(1.0, covered), 0});
    }
    /// The part of a column from 0 to 1 that lies before an edge at u. A moving edge is spread evenly over two columns: coverage begins and
    /// ends smoothly, and the shortest wave of the grid (two columns), which remains as an oscillation, has a quarter of the height.
    real before(real u) const {
        if (!moves_) return std::clamp(u, 0.0, 1.0);
        const real v = std::clamp(u + 1, 0.0, 3.0);
        return v < 1 ? 0.25 * v * v : v < 2 ? 0.5 * v - 0.25 : 1 - 0.25 * (3 - v) * (3 - v);
    }
    real pace(real t) const override {
        const Vec<D> v = motion_.pose(t).velocity;
        return std::abs(v[0]) / plane_.dx + (D == 3 ? std::abs(v[D - 1]) / plane_.dz : 0);
    }
    real mass() const override { return mass_; }
    real height() const override { return height_; }
    real speed() const override { return speed_; }
    void set(real height, real speed) override {
        if (heaves_) height_ = height, speed_ = speed;
    }
    real top() const override { return size_[1]; }
    Vec<3> middle() const override {
        Vec<3> x{{at_[0] + offset_[0], height_ + size_[1] / 2, 0}};
        if constexpr (D == 3) x[2] = at_[2] + offset_[2];
        return x;
    }
    Vec<3> size() const override { return {{size_[0], size_[1], D == 3 ? size_[D - 1] : 0}}; }
    void save(Checkpoint& to, const std::string& name) const override {
        to.put_value(name + "height", height_);
        to.put_value(name + "speed", speed_);
    }
    void restore(const Checkpoint& from, const std::string& name) override {
        height_ = from.get_value<real>(name + "height");
        speed_ = from.get_value<real>(name + "speed");
    }

private:
    Plane plane_;
    Vec<D> size_, at_, offset_{};
    geometry::Motion<D> motion_;
    bool heaves_ = true, moves_ = false;
    real height_ = 0, speed_ = 0, mass_ = 0;
};

/// Rejects floating boxes that start beyond the sides; a dragged box may enter from outside.
void refuse_beyond_sides(const scene::Scene& scene, const scene::Table& box, const std::string& path, const Plane& plane) {
    const auto &at = box.numbers("at"), &size = box.numbers("size");
    const bool heaves = box.flag("heave");
    const auto along = [&](char name, std::size_t a, real low, real high) {
        const real slack = 1e-9 * (high - low), first = at[a] - size[a] / 2, last = at[a] + size[a] / 2;
        const bool all = first >= low - slack && last <= high + slack, none = last <= low || first >= high;
        if (heaves ? all : !none || box.has("motion")) return;
        scene.refuse(path + ".at", fmt::format("this object extends from {0} = {1:g} to {2:g} m; the domain from {3:g} to {4:g} m {5}",
                                               name, first, last, low, high, none ? "does not contain it" : "does not contain all of it"));
    };
    along('x', 0, plane.x0, plane.x0 + plane.nx * plane.dx);
    if (plane.dim == 3) along('z', 2, plane.z0, plane.z0 + plane.nz * plane.dz);
}

template <int D>
std::unique_ptr<Body> make_box(const scene::Scene& scene, std::size_t n, const Plane& plane, real rho) {
    const scene::Table& table = scene.root().tables("floats")[n];
    const std::string path = fmt::format("floats[{}]", n);
    if (!scene.effect("gravity")) scene.refuse(path, "floats require gravity", "effects.gravity.g = [0, -9.81]");
    for (const double s : table.numbers("size"))
        if (!(s > 0)) scene.refuse(path + ".size", "an object has a size greater than 0 along each axis");
    if (table.flag("heave") && table.number("density") >= 1)
        scene.refuse(path + ".density", "an object at least as dense as water sinks, and a height field has no objects below the surface",
                     "density is relative to the water's; heave = false prescribes the height by motion");
    refuse_beyond_sides(scene, table, path, plane);
    if (table.has("motion"))
        if (const std::string& kind = table.text("motion.kind"); kind == "rotation")
            scene.refuse(path + ".motion", "floats do not rotate", "known: constant, sinusoidal, keyframes without angle");
    return std::make_unique<Box<D>>(table, plane, rho);
}

}  // namespace

std::vector<std::unique_ptr<Body>> make_floats(const scene::Scene& scene, const Plane& plane) {
    std::vector<std::unique_ptr<Body>> list;
    const real rho = scene.number("fluid.density");
    for (std::size_t n = 0; n < scene.root().tables("floats").size(); ++n)
        list.push_back(scene.dim() == 2 ? make_box<2>(scene, n, plane, rho) : make_box<3>(scene, n, plane, rho));
    return list;
}

}  // namespace weir::heightfield
