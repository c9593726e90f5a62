#include "rigid/bodies.hpp"

#include "geometry/mesh/mesh.hpp"
#include "geometry/sides.hpp"
#include "rigid/contact_spheres.hpp"
#include "rigid/overlaps.hpp"
#include "scene/names.hpp"

#include <algorithm>
#include <cmath>
#include <set>

namespace weir::rigid {

using scene::Key;
using scene::Type;

Key bodies_key() {
    return {
        .name = "bodies",
        .type = Type::tables,
        .doc = "Rigid bodies with two-way coupling to the fluid. Each requires a density or a mass.",
        .keys = {{.name = "name", .type = Type::text, .doc = "Name for probes; if absent, its number from 0."},
                 {.name = "density", .type = Type::number, .doc = "Density; 0 is allowed.", .unit = "kg/m^3", .min = 0},
                 {.name = "mass",
                  .type = Type::number,
                  .doc = "Mass instead of a density, distributed uniformly; per metre of depth in 2D.",
                  .unit = "kg",
                  .min = 0},
                 {.name = "centre_of_mass",
                  .type = Type::numbers,
                  .doc = "Centre of mass, if it is not the centroid of the shape: the moments of inertia are those of a uniform shape "
                         "about this point.",
                  .unit = "m",
                  .length = -1},
                 {.name = "velocity",
                  .type = Type::numbers,
                  .doc = "Velocity of the centre of mass at t = 0.",
                  .unit = "m/s",
                  .fallback = std::vector<double>{0},
                  .length = -1},
                 {.name = "spin",
                  .type = Type::numbers,
                  .doc = "Angular velocity at t = 0: one number in 2D, anticlockwise; about x, y and z in 3D.",
                  .unit = "rad/s"},
                 {.name = "fixed",
                  .type = Type::texts,
                  .doc = "Fixed degrees of freedom: translation along an axis, rotation about one, or all rotation.",
                  .fallback = std::vector<std::string>{},
                  .choices = {"x", "y", "z", "turning", "turning_x", "turning_y", "turning_z"}},
                 {.name = "slip",
                  .type = Type::choice,
                  .doc = "Boundary condition of the tangential velocity: free slip or no slip.",
                  .fallback = std::string("free"),
                  .choices = {"free", "no"}},
                 {.name = "friction",
                  .type = Type::number,
                  .doc = "Coulomb's coefficient of friction in contact with walls and solids; the geometric mean in contact of two bodies.",
                  .fallback = 0.0,
                  .min = 0},
                 {.name = "restitution",
                  .type = Type::number,
                  .doc = "Coefficient of restitution; the larger one in contact of two bodies.",
                  .fallback = 0.0,
                  .min = 0,
                  .max = 1}},
        .selector = "shape",
        .variants_from = &scene::shapes};
}

Key probe_key() {
    Key probes{.name = "probes", .type = Type::tables};
    probes.variants = {
        {"body",
         "Position and motion of a body, and the force and torque of the fluid on it.",
         {{.name = "body", .type = Type::text, .doc = "Its name, or its number from 0.", .required = true, .example = "body = \"0\""}}}};
    return probes;
}

namespace {

/// The rotation axis times the angle, at most half a turn.
Vec<3> rotation_vector(const Orientation& q) {
    const Vec<3> v{{q[1], q[2], q[3]}};
    const real sine = norm(v), half = std::atan2(sine, std::abs(q[0]));
    return sine > 0 ? ((q[0] < 0 ? -2 : 2) * half / sine) * v : Vec<3>{};
}
Orientation orientation_of(const Vec<3>& rotation) {
    const real angle = norm(rotation), scale = angle > 0 ? std::sin(0.5 * angle) / angle : 0;
    return {std::cos(0.5 * angle), scale * rotation[0], scale * rotation[1], scale * rotation[2]};
}

std::string path_of(std::size_t number) { return "bodies[" + std::to_string(number) + "]"; }

std::vector<double> spin_of(const scene::Scene& scene, const scene::Table& table, const std::string& path) {
    const std::size_t wanted = scene.dim() == 2 ? 1 : 3;
    if (!table.has("spin")) return std::vector<double>(wanted, 0.0);
    const auto& spin = table.numbers("spin");
    if (spin.size() != wanted)
        scene.refuse(path + ".spin", path + ".spin has " + std::to_string(spin.size()) + (spin.size() == 1 ? " entry" : " entries"),
                     scene.dim() == 2 ? "in 2D a body turns about z alone: spin = [1.0]" : "about x, y and z: spin = [0.0, 0.0, 1.0]");
    return spin;
}

template <int D>
std::array<bool, freedoms<D>> held_by(const scene::Scene& scene, const scene::Table& table, const std::string& path) {
    std::array<bool, freedoms<D>> held{};
    for (const std::string& word : table.texts("fixed")) {
        if (D == 2 && (word == "z" || word == "turning_x" || word == "turning_y"))
            scene.refuse(path + ".fixed", path + ".fixed names \"" + word + "\"; this scene has dim = 2", "known: x, y, turning");
        if (word.size() == 1)
            held[static_cast<std::size_t>(word[0] - 'x')] = true;
        else if (word == "turning" || D == 2)
            std::fill(held.begin() + D, held.end(), true);
        else
            held[static_cast<std::size_t>(D + word.back() - 'x')] = true;
    }
    return held;
}

real mass_by(const scene::Scene& scene, const scene::Table& table, const std::string& path, real volume) {
    if (table.has("mass") == table.has("density"))
        scene.refuse(path,
                     path + (table.has("mass") ? " has both a mass and a density: give one of them" : " has neither density nor mass"),
                     "density = 500.0, or mass = 2.0");
    return table.has("mass") ? table.number("mass") : table.number("density") * volume;
}

}  // namespace

template <int D>
Bodies<D>::Bodies(const scene::Scene& scene) {
    if (!scene.has("bodies")) return;
    const geometry::Sides<D> sides(scene);
    around_.min = scene.vec<D>("grid.origin");
    around_.max = around_.min + scene.vec<D>("grid.size");
    for (int a = 0; a < D; ++a)
        for (const int end : {0, 1}) {
            const auto kind = sides.side(a, end).kind;
            around_.wall[static_cast<std::size_t>(2 * a + end)] =
                kind == geometry::SideKind::wall || kind == geometry::SideKind::moving_wall;
            around_.reach = std::max(around_.reach, 2 * (around_.max[a] - around_.min[a]) / scene.vec<D>("grid.cells")[a]);
        }
    for (std::size_t i = 0; i < scene.root().tables("bodies").size(); ++i) {
        for (int a = 0; a < D; ++a)
            if (sides.periodic(a))
                scene.refuse(path_of(i),
                             "bodies cannot cross periodic sides, and this scene is periodic along " + std::string(1, "xyz"[a]));
        read(scene, i);
    }
    joints_ = Joints<D>(scene, list_);
    refuse_overlaps<D>(scene, list_, joints_, around_);
}

template <int D>
void Bodies<D>::read(const scene::Scene& scene, std::size_t number) {
    const scene::Table& table = scene.root().tables("bodies")[number];
    const std::string path = path_of(number);
    const Bounds<D> box = bounds_of<D>(table);
    if (!box.finite())
        scene.refuse(path + ".shape", path + " is a " + table.text("shape") + ", which is unbounded", "a body has a finite volume");
    Body<D> body;
    body.moments = moments_of<D>(table);
    if (!(body.moments.volume > 0)) scene.refuse(path + ".shape", path + " has no volume: its shape is empty");
    for (int a = 0; a < D; ++a)
        if (body.moments.centre[a] < around_.min[a] || body.moments.centre[a] > around_.max[a])
            scene.refuse(path + ".shape", path + " lies outside the domain: its centre is at " +
                                              scene::number_text(body.moments.centre[a]) + " m along " + "xyz"[a]);
    body.name = table.text_or("name", std::to_string(number));
    for (const Body<D>& other : list_)
        if (other.name == body.name) scene.refuse(path, "two bodies have the name \"" + body.name + "\"");
    body.shape = geometry::make_shape<D>(table);
    body.contact_spheres = contact_spheres_of<D>(table);
    body.weigh(mass_by(scene, table, path, body.moments.volume),
               table.has("centre_of_mass") ? table.vec<D>("centre_of_mass") : body.moments.centre);
    Vec<D> far;
    for (int a = 0; a < D; ++a) far[a] = std::max(box.max[a] - body.centre[a], body.centre[a] - box.min[a]);
    body.radius = norm(far);
    if (D == 2) body.orientation = {0, 0, 0, 0};
    const Vec<D> velocity = table.vec<D>("velocity");
    const auto spin = spin_of(scene, table, path);
    for (int a = 0; a < D; ++a) body.velocity[static_cast<std::size_t>(a)] = velocity[a];
    for (std::size_t a = 0; a < spin.size(); ++a) body.velocity[D + a] = spin[a];
    body.held = held_by<D>(scene, table, path);
    for (std::size_t k = 0; k < body.held.size(); ++k)
        if (body.held[k]) body.velocity[k] = 0;
    body.no_slip = table.text("slip") == "no";
    body.friction = table.number("friction"), body.restitution = table.number("restitution");
    list_.push_back(std::move(body));
}

template <int D>
void Bodies<D>::join(geometry::Solids<D>& solids) {
    around_.prescribed = solids.count();
    for (const Body<D>& body : list_) solids.add_free(body.shape, body.no_slip, {body.centre, body.radius});
    place(solids);
}

template <int D>
void Bodies<D>::place(geometry::Solids<D>& solids) const {
    for (std::size_t b = 0; b < list_.size(); ++b) solids.place(around_.prescribed + b, list_[b].pose());
}

template <int D>
void Bodies<D>::recall(const std::function<real(const char*, std::size_t, std::size_t)>& value) {
    for (std::size_t b = 0; b < count(); ++b) {
        Body<D>& body = list_[b];
        for (std::size_t a = 0; a < D; ++a) body.at[a] = value("position", a, b), body.velocity[a] = value("velocity", a, b);
        if (D == 2)
            body.orientation[0] = value("angle", 0, b);
        else
            body.orientation = orientation_of({{value("rotation", 0, b), value("rotation", 1, b), value("rotation", 2, b)}});
    }
}

template <int D>
ShownSolids<D>::ShownSolids(const scene::Scene& scene, bool lines) : bodies_(scene) {
    still_ = geometry::Solids<D>(scene);
    constexpr real part = 1.0 / 500;  // relative to the domain: a line still visible in pictures
    if (lines) thin_ = part * norm(scene.vec<D>("grid.size"));
}

template <int D>
const geometry::Solids<D>& ShownSolids<D>::at(real t, const std::function<real(const char*, std::size_t, std::size_t)>& value) {
    solids_ = still_;
    if (!bodies_.empty()) bodies_.recall(value);
    for (const Joint<D>& joint : bodies_.joints().all())
        if (thin_ > 0 && joint.kind == JointKind::mooring) {
            const auto end = bodies_.joints().ends(joint, bodies_.all());
            solids_.add_free(geometry::capsule<D>(end[0], end[1], 0.5 * thin_), false,
                             {0.5 * (end[0] + end[1]), 0.5 * (norm(end[1] - end[0]) + thin_)});
        }
    bodies_.join(solids_);
    solids_.set_time(t);
    return solids_;
}

template <int D>
Surroundings<D> Bodies<D>::surroundings(const geometry::Solids<D>& solids) const {
    Surroundings<D> around = around_;
    around.solids = &solids;
    around.joints = &joints_;
    return around;
}

template <int D>
real Bodies<D>::max_rate(real h) const {
    real fastest = 0;
    for (const Body<D>& body : list_) fastest = std::max(fastest, body.max_speed());
    return fastest / h;
}

template <int D>
void Bodies<D>::show(FieldSet& set) const {
    if (empty()) return;
    constexpr std::size_t n = freedoms<D>, turns = n - D, angles = D == 2 ? 1 : 3;
    const bool has_viscous = std::any_of(list_.begin(), list_.end(), [](const Body<D>& b) { return b.has_viscous; });
    shown_.assign(D + 2 * n + angles + (has_viscous ? n : 0), std::vector<real>(count()));
    std::size_t at = 0;
    const auto add = [&](const char* name, const char* unit, std::size_t components, auto&& value) {
        FieldView view{name, unit, Where::particle, body_set_name, {}};
        for (std::size_t k = 0; k < components; ++k, ++at) {
            for (std::size_t b = 0; b < count(); ++b) shown_[at][b] = value(list_[b], k);
            view.data.push_back(shown_[at]);
        }
        set.fields.push_back(std::move(view));
    };
    add("position", "m", D, [](const Body<D>& b, std::size_t k) { return b.at[k]; });
    add("velocity", "m/s", D, [](const Body<D>& b, std::size_t k) { return b.velocity[k]; });
    add(D == 2 ? "angle" : "rotation", "rad", angles,
        [](const Body<D>& b, std::size_t k) { return D == 2 ? b.orientation[k] : rotation_vector(b.orientation)[k]; });
    add("spin", "rad/s", turns, [](const Body<D>& b, std::size_t k) { return b.velocity[D + k]; });
    add("force", D == 2 ? "N/m" : "N", D, [](const Body<D>& b, std::size_t k) { return b.force[k]; });
    add("torque", D == 2 ? "N" : "N m", turns, [](const Body<D>& b, std::size_t k) { return b.force[D + k]; });
    if (!has_viscous) return;
    add("viscous_force", D == 2 ? "N/m" : "N", D, [](const Body<D>& b, std::size_t k) { return b.viscous[k]; });
    add("viscous_torque", D == 2 ? "N" : "N m", turns, [](const Body<D>& b, std::size_t k) { return b.viscous[D + k]; });
}

template <int D>
std::vector<Integral> Bodies<D>::integrals(const Vec<D>& gravity) const {
    if (empty()) return {};
    real kinetic = 0, potential = 0;
    Vec<D> momentum{};
    for (const Body<D>& b : list_) {
        kinetic += b.kinetic_energy();
        potential -= b.mass * dot(gravity, b.at);
        for (int a = 0; a < D; ++a) momentum[a] += b.mass * b.velocity[static_cast<std::size_t>(a)];
    }
    const std::string per_depth = D == 2 ? "/m" : "";
    std::vector<Integral> list = {{"bodies_kinetic_energy", "J" + per_depth, kinetic},
                                  {"bodies_potential_energy", "J" + per_depth, potential}};
    for (int a = 0; a < D; ++a) list.push_back({std::string("bodies_momentum_") + "xyz"[a], "kg m/s" + per_depth, momentum[a]});
    return list;
}

template <int D>
void Bodies<D>::save(Checkpoint& to) const {
    for (std::size_t b = 0; b < count(); ++b) list_[b].save(to, "body." + std::to_string(b) + '.');
}

template <int D>
void Bodies<D>::restore(const Checkpoint& from) {
    for (std::size_t b = 0; b < count(); ++b) list_[b].restore(from, "body." + std::to_string(b) + '.');
}

template <int D>
std::size_t Bodies<D>::bytes() const {
    std::size_t total = list_.capacity() * sizeof(Body<D>);
    std::set<const geometry::Mesh*> meshes;  // bodies from the same file share it
    for (const Body<D>& body : list_) {
        total += body.contact_spheres.capacity() * sizeof(ContactSphere<D>);
        if (const auto* posed = body.shape->mesh(); posed && meshes.insert(posed->mesh.get()).second) total += posed->mesh->bytes();
    }
    for (const auto& values : shown_) total += values.capacity() * sizeof(real);
    return total;
}

template class Bodies<2>;
template class Bodies<3>;
template class ShownSolids<2>;
template class ShownSolids<3>;

}  // namespace weir::rigid
