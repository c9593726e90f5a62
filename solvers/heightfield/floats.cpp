#include "heightfield/floats.hpp"

#include "core/error.hpp"
#include "linear/conjugate_gradients.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace weir::heightfield {

namespace {

constexpr real exact = 1e-14;  // relative to the right-hand side: tolerance of the solve

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

Floats::Floats(std::vector<std::unique_ptr<Body>> bodies, const Plane& plane, const Field& bed, const Field& still_depth, real g, real rho,
               bool periodic_x, bool periodic_z)
    : bodies_(std::move(bodies)),
      plane_(plane),
      bed_(bed),
      depth_(still_depth),
      g_(g),
      rho_(rho),
      periodic_x_(periodic_x),
      periodic_z_(periodic_z),
      pushed_(bodies_.size()) {
    if (!bodies_.empty()) place_of_.assign(plane.count(), -1);
    stiff_.resize(bodies_.size()), given_.resize(bodies_.size());
}

void Floats::add(std::size_t column, real water, const Field& surface, const Field& rate) {
    place_of_[column] = static_cast<std::ptrdiff_t>(covered_.size());
    Covered c;
    c.column = column, c.water = water, c.surface = surface[column], c.rate = rate[column];
    covered_.push_back(c);
}

/// Finds the columns that bodies cover at time t, followed by those covered only before.
void Floats::locate(real t, const Field& surface, const Field& rate) {
    for (Covered& c : covered_) c.surface = surface[c.column], c.rate = rate[c.column];
    contacts_.clear();
    for (std::size_t b = 0; b < bodies_.size(); ++b) {
        covers_.clear();
        bodies_[b]->move(t, covers_);
        const real height = bodies_[b]->height();
        if (bodies_[b]->mass() < infinity) see_whole(b);
        for (const Cover& c : covers_) {
            if (place_of_[c.column] < 0) add(c.column, surface[c.column] - bed_[c.column], surface, rate);
            if (depth_[c.column] > 0 && !(c.underside + height > bed_[c.column]))
                throw NumericalFailure("float", fmt::format("object {} is in contact with the bed: there is no water below it", b));
            const bool clings = covered_[static_cast<std::size_t>(place_of_[c.column])].clings && !(bodies_[b]->mass() < infinity);
            const bool touches = clings || surface[c.column] > c.underside + height;
            contacts_.push_back({static_cast<std::size_t>(place_of_[c.column]), b, c.part, c.underside, touches});
        }
    }
    for (std::vector<real>* f : {&x_, &r_, &p_, &ap_, &diagonal_, &free_, &gap_, &part_}) f->assign(covered_.size(), 0);
}

/// A floating body that is not wholly above columns would sink as if it leaked.
void Floats::see_whole(std::size_t b) const {
    const Vec<3> size = bodies_[b]->size();
    const real area = size[0] * (plane_.dim == 3 ? size[2] : 1);
    real covered = 0;
    for (const Cover& c : covers_) covered += c.part * plane_.area();
    if (covered < (1 - 1e-6) * area) throw NumericalFailure("float", fmt::format("object {} has left the domain", b));
}

/// Depths of water below bodies, and between them.
void Floats::see_depths() {
    std::fill(free_.begin(), free_.end(), 1.0);
    std::fill(gap_.begin(), gap_.end(), 0.0);
    for (const Contact& c : contacts_) {
        const std::size_t column = covered_[c.place].column;
        free_[c.place] -= c.part;
        gap_[c.place] += c.part * (c.underside + bodies_[c.body]->height() - bed_[column]);
    }
    for (std::size_t i = 0; i < covered_.size(); ++i) {
        if (free_[i] < -1e-9) throw NumericalFailure("float", "two objects overlap");
        gap_[i] += free_[i] * depth_[covered_[i].column];
    }
}

void Floats::set_stiffness(Stiffness& k) {
    see_depths();
    const int nx = plane_.nx, nz = plane_.nz;
    const auto depth = [&](std::size_t c) { return place_of_[c] < 0 ? depth_[c] : gap_[static_cast<std::size_t>(place_of_[c])]; };
    const auto between = [&](std::size_t a, std::size_t b, real d) {
        return depth_[a] > 0 && depth_[b] > 0 ? g_ * 0.5 * (depth(a) + depth(b)) / (d * d) : 0;
    };
    for (const Covered& c : covered_) {
        const int i = static_cast<int>(c.column % static_cast<std::size_t>(nx)),
                  r = static_cast<int>(c.column / static_cast<std::size_t>(nx));
        const std::size_t row = static_cast<std::size_t>(r) * static_cast<std::size_t>(nx + 1);
        for (const int f : {i, i + 1}) {
            const bool end = f == 0 || f == nx;
            if (end && !periodic_x_) continue;
            const real value = between(plane_.at((f - 1 + nx) % nx, r), plane_.at(f % nx, r), plane_.dx);
            k.x[row + static_cast<std::size_t>(f)] = value;
            if (end) k.x[row + static_cast<std::size_t>(nx - f)] = value;
        }
        for (const int f : {r, r + 1}) {
            const bool end = f == 0 || f == nz;
            if (plane_.dim == 2 || (end && !periodic_z_)) continue;
            const real value = between(plane_.at(i, (f - 1 + nz) % nz), plane_.at(i, f % nz), plane_.dz);
            k.z[plane_.at(i, f)] = value;
            if (end) k.z[plane_.at(i, nz - f)] = value;
        }
    }
}

void Floats::see_neighbours(const Field& surface, const Stiffness& k) {
    const int nx = plane_.nx, nz = plane_.nz;
    for (Covered& c : covered_) {
        const int i = static_cast<int>(c.column % static_cast<std::size_t>(nx)),
                  r = static_cast<int>(c.column / static_cast<std::size_t>(nx));
        const std::size_t row = static_cast<std::size_t>(r) * static_cast<std::size_t>(nx + 1) + static_cast<std::size_t>(i);
        c.k = {k.x[row], k.x[row + 1], k.z[c.column], k.z[c.column + static_cast<std::size_t>(nx)]};
        c.beside = {plane_.at((i - 1 + nx) % nx, r), plane_.at((i + 1) % nx, r), plane_.at(i, (r - 1 + nz) % nz),
                    plane_.at(i, (r + 1) % nz)};
        for (std::size_t f = 0; f < 4; ++f) c.surface_beside[f] = surface[c.beside[f]], c.place_beside[f] = place_of_[c.beside[f]];
    }
}

void Floats::enter(const Field& surface, const Field& rate, Stiffness& k) {
    locate(0, surface, rate);
    for (const Contact& c : contacts_) {
        Covered& below = covered_[c.place];
        if (c.touches) below.water -= c.part * (below.surface - c.underside - bodies_[c.body]->height());
    }
    set_stiffness(k);
    see_neighbours(surface, k);
    for (std::size_t i = 0; i < covered_.size(); ++i) x_[i] = covered_[i].surface;
    tell();
}

void Floats::before(real t, const Field& surface, const Field& rate, Stiffness& k) {
    locate(t, surface, rate);
    set_stiffness(k);
    see_neighbours(surface, k);
}

void Floats::after(real dt, Field& surface, Field& rate) {
    constexpr int most = 8;  // maximum number of contact changes within a step
    for (int n = 0; n < most; ++n) {
        set_up(dt);
        solve(dt);
        if (!change_contacts()) break;
    }
    take(dt, surface, rate);
}

/// The system for s of the covered columns at the end of the step. A body's height Y satisfies M (Y - Y_0 - dt v)/dt^2 = rho g A sum f (s -
/// u - Y) - M g; divided by rho g A:  (m + F) Y = m (Y_0 + dt v - dt^2 g) + sum f (s - u).
void Floats::set_up(real dt) {
    std::fill(free_.begin(), free_.end(), 1.0);
    for (std::size_t b = 0; b < bodies_.size(); ++b) {
        const Body& body = *bodies_[b];
        const real m = body.mass() / (rho_ * plane_.area() * dt * dt * g_);
        stiff_[b] = m;
        given_[b] = m < infinity ? m * (body.height() + dt * body.speed() - dt * dt * g_) : body.height();
    }
    for (const Contact& c : contacts_) {
        if (!c.touches) continue;
        free_[c.place] -= c.part;
        if (stiff_[c.body] < infinity) stiff_[c.body] += c.part, given_[c.body] -= c.part * c.underside;
    }
    for (std::size_t i = 0; i < covered_.size(); ++i) {
        const Covered& c = covered_[i];
        real rhs = c.water + dt * c.rate + free_[i] * bed_[c.column], stiffness = 0;
        for (std::size_t f = 0; f < 4; ++f) {
            stiffness += c.k[f];
            if (c.place_beside[f] < 0) rhs += dt * dt * c.k[f] * c.surface_beside[f];
        }
        diagonal_[i] = free_[i] + dt * dt * stiffness;
        r_[i] = rhs;
        x_[i] = c.surface;
    }
    for (const Contact& c : contacts_) {
        if (!c.touches) continue;
        const bool free = stiff_[c.body] < infinity;
        r_[c.place] -= c.part * (c.underside - bed_[covered_[c.place].column] + (free ? given_[c.body] / stiff_[c.body] : given_[c.body]));
    }
}

/// y = A x:  (1 - f) s + dt^2 sum k (s - s_beside) + f sum f s/(m + F)
void Floats::multiply(const std::vector<real>& x, std::vector<real>& y, real dt) const {
    for (std::size_t i = 0; i < covered_.size(); ++i) {
        const Covered& c = covered_[i];
        real sum = diagonal_[i] * x[i];
        for (std::size_t f = 0; f < 4; ++f)
            if (c.place_beside[f] >= 0) sum -= dt * dt * c.k[f] * x[static_cast<std::size_t>(c.place_beside[f])];
        y[i] = sum;
    }
    for (std::size_t b = 0; b < bodies_.size(); ++b) {
        if (!(stiff_[b] < infinity)) continue;
        real sum = 0;
        for (const Contact& c : contacts_)
            if (c.body == b && c.touches) sum += c.part * x[c.place];
        for (const Contact& c : contacts_)
            if (c.body == b && c.touches) y[c.place] += c.part * sum / stiff_[b];
    }
}

/// M = 1/diagonal (Jacobi).
struct Floats::System {
    static constexpr linear::Norm norm = linear::Norm::residual;
    Floats& of;
    real dt, b_norm;

    static real dot(const std::vector<real>& a, const std::vector<real>& b) {
        return std::inner_product(a.begin(), a.end(), b.begin(), real{0});
    }
    real M(std::size_t i) const { return of.diagonal_[i] > 0 ? 1 / of.diagonal_[i] : 0; }
    real relative_residual() const { return std::sqrt(dot(of.r_, of.r_)) / b_norm; }

    real precondition() const {
        real rz = 0;
        for (std::size_t i = 0; i < of.r_.size(); ++i) rz += M(i) * of.r_[i] * of.r_[i];
        return rz;
    }
    void update_direction(real beta) {
        for (std::size_t i = 0; i < of.p_.size(); ++i) of.p_[i] = M(i) * of.r_[i] + (beta == 0 ? 0 : beta * of.p_[i]);
    }
    real multiply() {
        of.multiply(of.p_, of.ap_, dt);
        return dot(of.p_, of.ap_);
    }
    real advance(real alpha) {
        for (std::size_t i = 0; i < of.x_.size(); ++i) of.x_[i] += alpha * of.p_[i], of.r_[i] -= alpha * of.ap_[i];
        return relative_residual();
    }
};

/// Round-off may end the convergence, since the tolerance is close to it. Water at rest has b = 0 up to round-off: a failure is a residual
/// that is large relative to the initial one also.
void Floats::solve(real dt) {
    constexpr real nothing = 1e-200;  // where b = 0 any residual is too large
    System system{*this, dt, std::max(std::sqrt(System::dot(r_, r_)), nothing)};
    multiply(x_, ap_, dt);
    for (std::size_t i = 0; i < r_.size(); ++i) r_[i] -= ap_[i];
    iterations_ = 0;
    linear::StopTest stop(exact, static_cast<int>(4 * r_.size() + 50), iterations_);
    const real initial = system.relative_residual();
    linear::Outcome outcome = linear::conjugate_gradients(system, stop, initial);
    outcome.relative_residual /= std::max(initial, real{1});
    if (!outcome.broke_down) linear::require_converged("float", "solve for floats", outcome, stop);
}

real Floats::height_of(std::size_t b) const {
    if (!(stiff_[b] < infinity)) return given_[b];
    real sum = given_[b];
    for (const Contact& c : contacts_)
        if (c.body == b && c.touches) sum += c.part * x_[c.place];
    return sum / stiff_[b];
}

/// Water pushes but does not pull: contact ends where the pressure would be negative, and begins where water is higher than the underside.
/// A body of prescribed height keeps contact: columns do not model how air would get below it.
bool Floats::change_contacts() {
    bool changed = false;
    for (std::size_t b = 0; b < bodies_.size(); ++b) {
        const real height = height_of(b);
        for (Contact& c : contacts_) {
            if (c.body != b || (c.touches && !(bodies_[b]->mass() < infinity))) continue;
            const bool touches = x_[c.place] > c.underside + height;
            changed = changed || touches != c.touches;
            c.touches = touches;
        }
    }
    return changed;
}

/// Rates and heights from the solution. The volume through each face leaves one column and enters the other, so volume is conserved for any
/// residual.
void Floats::take(real dt, Field& surface, Field& rate) {
    for (std::size_t b = 0; b < bodies_.size(); ++b)
        if (const real height = height_of(b); bodies_[b]->mass() < infinity) bodies_[b]->set(height, (height - bodies_[b]->height()) / dt);
    for (std::size_t i = 0; i < covered_.size(); ++i) {
        Covered& c = covered_[i];
        real w = c.rate;
        for (std::size_t f = 0; f < 4; ++f) {
            const std::ptrdiff_t place = c.place_beside[f];
            if (place >= 0) {
                w += dt * c.k[f] * (x_[static_cast<std::size_t>(place)] - x_[i]);
            } else {
                w += dt * c.k[f] * (c.surface_beside[f] - x_[i]);
                const real more = dt * c.k[f] * (x_[i] - c.surface);  // the sweep used the old height
                rate[c.beside[f]] += more;
                surface[c.beside[f]] += dt * more;
            }
        }
        rate[c.column] = w;
        c.water += dt * w;
        surface[c.column] = free_[i] < 1 ? x_[i] : bed_[c.column] + c.water;
    }
    for (Covered& c : covered_) c.clings = false;
    for (const Contact& c : contacts_)
        if (c.touches && !(bodies_[c.body]->mass() < infinity)) covered_[c.place].clings = true;
    tell();
    forget_free_columns();
}

/// Displaced volume and forces. Along x and z the pressure force rho g d^2/2 acts on vertical sides of draught d.
void Floats::tell() {
    for (std::size_t b = 0; b < bodies_.size(); ++b) {
        Pushed& push = pushed_[b];
        push = {};
        const real height = bodies_[b]->height();
        std::fill(part_.begin(), part_.end(), 0.0);
        std::fill(p_.begin(), p_.end(), 0.0);
        for (const Contact& c : contacts_) {
            if (c.body != b || !c.touches) continue;
            const real depth = x_[c.place] - c.underside - height;
            push.displaced += plane_.area() * c.part * depth;
            part_[c.place] = c.part;
            p_[c.place] = 0.5 * rho_ * g_ * depth * depth;
        }
        push.up = rho_ * g_ * push.displaced;
        for (std::size_t i = 0; i < covered_.size(); ++i)
            for (std::size_t f = 0; f < 4; ++f) {
                const std::ptrdiff_t place = covered_[i].place_beside[f];
                const real there = place >= 0 ? part_[static_cast<std::size_t>(place)] : 0;
                if (!(part_[i] > there)) continue;  // each face once, from the side with more coverage
                const real q = place >= 0 ? p_[static_cast<std::size_t>(place)] : 0;
                const real force = (part_[i] * p_[i] + there * q) / (part_[i] + there) * (part_[i] - there);
                (f < 2 ? push.along_x : push.along_z) += (f % 2 == 0 ? force : -force) * (f < 2 ? plane_.dz : plane_.dx);
            }
    }
}

/// Columns that are no longer covered become ordinary columns.
void Floats::forget_free_columns() {
    std::fill(part_.begin(), part_.end(), 0.0);
    for (const Contact& c : contacts_) part_[c.place] = 1;
    bool all = true;
    for (const real p : part_) all = all && p > 0;
    if (all) return;
    std::size_t kept = 0;
    for (std::size_t i = 0; i < covered_.size(); ++i) {
        place_of_[covered_[i].column] = part_[i] > 0 ? static_cast<std::ptrdiff_t>(kept) : -1;
        for (Contact& c : contacts_)
            if (c.place == i) c.place = kept;
        if (part_[i] > 0) covered_[kept++] = covered_[i];
    }
    covered_.resize(kept);
}

void Floats::displaced(const Field& surface, Field& to) const {
    to.fill(0);
    for (const Contact& c : contacts_) {
        const std::size_t column = covered_[c.place].column;
        if (c.touches) to[column] += c.part * (surface[column] - c.underside - bodies_[c.body]->height());
    }
}

real Floats::pace(real t) const {
    real most = 0;
    for (const auto& body : bodies_) most = std::max(most, body->pace(t));
    return most;
}

/// Uses the neighbouring columns: below a body the height is equivalent to the pressure, which a fast object raises far.
real Floats::over_top(const Field& surface) const {
    real most = 0;
    for (const Contact& c : contacts_) {
        const Covered& below = covered_[c.place];
        const real top = c.underside + bodies_[c.body]->height() + bodies_[c.body]->top();
        for (std::size_t f = 0; f < 4; ++f)
            if (below.place_beside[f] < 0) most = std::max(most, surface[below.beside[f]] - top);
    }
    return most;
}

void Floats::show(FieldSet& fields) const {
    for (std::vector<real>& f : shown_) f.resize(bodies_.size());
    for (std::size_t b = 0; b < bodies_.size(); ++b) {
        const Vec<3> middle = bodies_[b]->middle(), size = bodies_[b]->size();
        for (std::size_t a = 0; a < 3; ++a) shown_[a][b] = middle[static_cast<int>(a)], shown_[3 + a][b] = size[static_cast<int>(a)];
    }
    const auto add = [&](const char* name, std::size_t first) {
        FieldView field{name, "m", Where::particle, box_set_name, {shown_[first], shown_[first + 1]}};
        if (plane_.dim == 3) field.data.push_back(shown_[first + 2]);
        fields.fields.push_back(std::move(field));
    };
    add("position", 0), add("size", 3);
}

real Floats::missing(const Field& surface) const {
    real sum = 0;
    for (const Covered& c : covered_) sum += c.water - (surface[c.column] - bed_[c.column]);
    return plane_.area() * sum;
}

std::size_t Floats::bytes() const {
    std::size_t total = place_of_.capacity() * sizeof(std::ptrdiff_t) + covered_.capacity() * sizeof(Covered) +
                        contacts_.capacity() * sizeof(Contact) + covers_.capacity() * sizeof(Cover);
    for (const std::vector<real>* f : {&x_, &r_, &p_, &ap_, &diagonal_, &free_, &gap_, &part_, &stiff_, &given_})
        total += f->capacity() * sizeof(real);
    for (const std::vector<real>& f : shown_) total += f.capacity() * sizeof(real);
    return total;
}

void Floats::save(Checkpoint& to) const {
    std::vector<std::size_t> columns;
    std::vector<real> water;
    std::vector<char> clings;
    for (const Covered& c : covered_) columns.push_back(c.column), water.push_back(c.water), clings.push_back(c.clings ? 1 : 0);
    to.put("covered_clings", clings);
    to.put("covered_columns", columns);
    to.put("covered_water", water);
    to.put("pushed", pushed_);
    for (std::size_t b = 0; b < bodies_.size(); ++b) bodies_[b]->save(to, fmt::format("float{}_", b));
}

void Floats::restore(const Checkpoint& from, real t, const Field& surface, const Field& rate, Stiffness& k) {
    contacts_.clear();
    set_stiffness(k);  // open water again at the bodies' old positions
    for (const Covered& c : covered_) place_of_[c.column] = -1;
    covered_.clear();
    std::vector<std::size_t> columns;
    std::vector<real> water;
    from.get("covered_columns", columns);
    from.get("covered_water", water);
    std::vector<char> clings;
    from.get("covered_clings", clings);
    from.get("pushed", std::span<Pushed>(pushed_));
    if (water.size() != columns.size() || clings.size() != columns.size())
        throw std::runtime_error("checkpoint blocks \"covered_columns\", \"covered_water\" and \"covered_clings\" are not of one length");
    Checkpoint::require_finite("covered_water", water);
    for (std::size_t i = 0; i < columns.size(); ++i) {
        if (columns[i] >= place_of_.size() || place_of_[columns[i]] >= 0)
            throw std::runtime_error("checkpoint block \"covered_columns\" names column " + std::to_string(columns[i]) + " of " +
                                     std::to_string(place_of_.size()) + ", or one twice");
        add(columns[i], water[i], surface, rate);
        covered_.back().clings = clings[i] != 0;
    }
    for (std::size_t b = 0; b < bodies_.size(); ++b) bodies_[b]->restore(from, fmt::format("float{}_", b));
    locate(t, surface, rate);
}

}  // namespace weir::heightfield
