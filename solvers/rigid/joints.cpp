#include "rigid/joints.hpp"

#include "scene/names.hpp"

#include <algorithm>
#include <cmath>

namespace weir::rigid {

using scene::Key;
using scene::Type;

/// One list: its entries are data, not steps.
Key joints_key() {
    const Key body{.name = "body",
                   .type = Type::text,
                   .doc = "First body of the joint: its name, or its number from 0.",
                   .required = true,
                   .example = "body = \"0\""};
    const Key to{.name = "to", .type = Type::text, .doc = "Second body of the joint, by name or number; the world if absent."};
    const auto point = [](const char* name, const char* doc) {
        return Key{.name = name, .type = Type::numbers, .doc = doc, .unit = "m", .required = true, .length = -1};
    };
    Key joints{
        .name = "joints", .type = Type::tables, .doc = "Joints between bodies, or between a body and the world.", .selector = "kind"};
    joints.variants = {
        {"hinge",
         "Hinge: the body rotates about a point, in 3D about an axis through it.",
         {body,
          to,
          point("at", "The point, at t = 0."),
          {.name = "axis",
           .type = Type::numbers,
           .doc = "The axis at t = 0; its length does not matter.",
           .fallback = std::vector<double>{0, 0, 1},
           .length = 3,
           .only_dim = 3}}},
        {"slider",
         "Slider: the body moves along a line without rotation.",
         {body,
          to,
          point("at", "A point of the body that stays on the line, at t = 0."),
          {.name = "axis",
           .type = Type::numbers,
           .doc = "The line's direction at t = 0; its length does not matter.",
           .required = true,
           .length = -1}}},
        {"mooring",
         "Mooring line: a spring and a damper that act only where the line is longer than its rest length.",
         {body,
          to,
          point("at", "Attachment point on the body, at t = 0."),
          point("anchor", "Attachment point of its other end, at t = 0."),
          {.name = "length",
           .type = Type::number,
           .doc = "Rest length; if absent, the distance of its ends at t = 0.",
           .unit = "m",
           .min = 0},
          {.name = "stiffness",
           .type = Type::number,
           .doc = "Stiffness: tension per elongation; per metre of depth in 2D.",
           .unit = "N/m",
           .required = true,
           .min = 0,
           .min_open = true},
          {.name = "damping",
           .type = Type::number,
           .doc = "Damping: tension per rate of elongation; per metre of depth in 2D.",
           .unit = "N s/m",
           .fallback = 0.0,
           .min = 0}}},
    };
    return joints;
}

namespace {

/// The row of one body's rotation relative to another's, about an axis (2D: about z).
template <int D>
Row<D> turning_row(const Joint<D>& joint, const Vec<3>& axis) {
    Row<D> row;
    row.body = joint.body, row.other = joint.other;
    for (std::size_t k = D; k < freedoms<D>; ++k) {
        row.sees[k] = D == 2 ? 1 : axis[k - D];
        if (joint.other >= 0) row.sees[freedoms<D> + k] = -row.sees[k];
    }
    return row;
}

template <int D>
const Body<D>* other_of(const Joint<D>& joint, const std::vector<Body<D>>& bodies) {
    return joint.other < 0 ? nullptr : &bodies[static_cast<std::size_t>(joint.other)];
}

template <int D>
Vec<D> turned(const Body<D>* body, const Vec<D>& direction) {
    if (!body) return direction;
    const auto rows = rotation<D>(body->orientation);
    Vec<D> d;
    for (std::size_t a = 0; a < D; ++a) d[a] = dot(rows[a], direction);
    return d;
}

template <int D>
std::size_t named(const scene::Scene& scene, const std::string& path, const std::string& name, const std::vector<Body<D>>& bodies) {
    std::vector<std::string> names;
    for (std::size_t b = 0; b < bodies.size(); ++b) {
        if (bodies[b].name == name) return b;
        names.push_back(bodies[b].name);
    }
    for (std::size_t b = 0; b < bodies.size(); ++b)
        if (std::to_string(b) == name) return b;
    scene.refuse(path, path + " is " + scene::quote(name) + "; no body has this name" + scene::did_you_mean(name, names),
                 scene::known(names));
}

}  // namespace

template <int D>
Joints<D>::Joints(const scene::Scene& scene, const std::vector<Body<D>>& bodies) {
    if (!scene.has("joints")) return;
    for (std::size_t i = 0; i < scene.root().tables("joints").size(); ++i) read(scene, i, bodies);
}

template <int D>
void Joints<D>::read(const scene::Scene& scene, std::size_t number, const std::vector<Body<D>>& bodies) {
    const scene::Table& table = scene.root().tables("joints")[number];
    const std::string path = "joints[" + std::to_string(number) + "]", &kind = table.text("kind");
    Joint<D> joint;
    joint.kind = kind == "hinge" ? JointKind::hinge : kind == "slider" ? JointKind::slider : JointKind::mooring;
    joint.body = named(scene, path + ".body", table.text("body"), bodies);
    if (table.has("to")) joint.other = static_cast<std::ptrdiff_t>(named(scene, path + ".to", table.text("to"), bodies));
    if (joint.other == static_cast<std::ptrdiff_t>(joint.body)) scene.refuse(path + ".to", path + " connects a body to itself");
    for (const std::ptrdiff_t b : {static_cast<std::ptrdiff_t>(joint.body), joint.other})
        if (b >= 0 && !(bodies[static_cast<std::size_t>(b)].mass > 0))
            scene.refuse(path + (b == joint.other ? ".to" : ".body"),
                         path + " holds the body " + scene::quote(bodies[static_cast<std::size_t>(b)].name) +
                             ", which has no mass: outside the water its acceleration would be unbounded",
                         "give the body a mass greater than 0");
    joint.at = joint.anchor = table.vec<D>("at");
    if (joint.kind == JointKind::mooring) {
        joint.anchor = table.vec<D>("anchor");
        joint.length = table.number_or("length", norm(joint.at - joint.anchor));
        joint.stiffness = table.number("stiffness"), joint.damping = table.number("damping");
    } else if (D == 3 || joint.kind == JointKind::slider) {
        joint.axis = table.vec<D>("axis");
        if (norm(joint.axis) == 0) scene.refuse(path + ".axis", path + ".axis is the zero vector; it must have a direction");
        joint.axis = joint.axis / norm(joint.axis);
    }
    list_.push_back(joint);
}

template <int D>
std::array<Vec<D>, 2> Joints<D>::ends(const Joint<D>& joint, const std::vector<Body<D>>& bodies) const {
    const Body<D>* other = other_of(joint, bodies);
    return {bodies[joint.body].pose().to_world(joint.at), other ? other->pose().to_world(joint.anchor) : joint.anchor};
}

/// Both forces act at one point, half way between the ends, so that angular momentum is conserved.
template <int D>
void Joints<D>::hold_point(const Joint<D>& joint, const std::vector<Body<D>>& bodies, real dt, std::vector<Row<D>>& rows) const {
    const auto end = ends(joint, bodies);
    for (int a = 0; a < D; ++a) {
        rows.push_back(row_at<D>(bodies, joint.body, joint.other, 0.5 * (end[0] + end[1]), Vec<D>::unit(a)));
        rows.back().target = (end[1][a] - end[0][a]) / dt;
    }
}

template <int D>
void Joints<D>::hold_axis(const Joint<D>& joint, const std::vector<Body<D>>& bodies, real dt, std::vector<Row<D>>& rows) const {
    if constexpr (D == 3) {
        const Vec<3> own = turned(&bodies[joint.body], joint.axis), theirs = turned(other_of(joint, bodies), joint.axis);
        const Vec<3> off = cross(own, theirs);  // the rotation error
        for (const Vec<3>& t : both_across(theirs)) {
            rows.push_back(turning_row<D>(joint, t));
            rows.back().target = dot(off, t) / dt;
        }
    }
}

template <int D>
void Joints<D>::slide(const Joint<D>& joint, const std::vector<Body<D>>& bodies, real dt, std::vector<Row<D>>& rows) const {
    const auto end = ends(joint, bodies);
    const Vec<D> axis = turned(other_of(joint, bodies), joint.axis);
    const auto hold = [&](const Vec<D>& t) {
        rows.push_back(row_at<D>(bodies, joint.body, joint.other, end[0], t));
        rows.back().target = dot(end[1] - end[0], t) / dt;
    };
    if constexpr (D == 2)
        hold(Vec<2>{{-axis[1], axis[0]}});
    else
        for (const Vec<3>& t : both_across(axis)) hold(t);
}

template <int D>
void Joints<D>::hold_turning(const Joint<D>& joint, const std::vector<Body<D>>& bodies, real dt, std::vector<Row<D>>& rows) const {
    const Body<D>* other = other_of(joint, bodies);
    if constexpr (D == 2) {
        rows.push_back(turning_row<D>(joint, {}));
        rows.back().target = ((other ? other->orientation[0] : 0) - bodies[joint.body].orientation[0]) / dt;
    } else {
        // half of the skew part of the relative rotation R: its axis times the sine of its angle
        Vec<3> off{};
        for (int a = 0; a < 3; ++a) off += 0.5 * cross(turned(&bodies[joint.body], Vec<3>::unit(a)), turned(other, Vec<3>::unit(a)));
        for (int a = 0; a < 3; ++a) {
            rows.push_back(turning_row<D>(joint, Vec<3>::unit(a)));
            rows.back().target = off[a] / dt;
        }
    }
}

/// A slack line has no damping.
template <int D>
void Joints<D>::pull(const Joint<D>& joint, const std::vector<Body<D>>& bodies, real dt, std::vector<Row<D>>& rows) const {
    const auto end = ends(joint, bodies);
    const Vec<D> line = end[0] - end[1];
    const real length = norm(line), stretch = length - joint.length;
    const Vec<D> along = length > 0 ? line / length : Vec<D>::unit(1);
    rows.push_back(row_at<D>(bodies, joint.body, joint.other, end[0], along));
    Row<D>& row = rows.back();
    real rate = 0;  // rate of the stretch that led to the present ends
    for (std::size_t k = 0; k < freedoms<D>; ++k) {
        rate += row.sees[k] * bodies[joint.body].velocity[k];
        if (const Body<D>* other = other_of(joint, bodies)) rate += row.sees[freedoms<D> + k] * other->velocity[k];
    }
    row.spring = {joint.stiffness, stretch > 0 ? joint.damping : 0, stretch, rate, dt};
    row.limit = Limit::pulls;
}

template <int D>
void Joints<D>::add_rows(const std::vector<Body<D>>& bodies, real dt, std::vector<Row<D>>& rows) const {
    for (const Joint<D>& joint : list_) {
        if (joint.kind == JointKind::hinge) hold_point(joint, bodies, dt, rows), hold_axis(joint, bodies, dt, rows);
        if (joint.kind == JointKind::slider) slide(joint, bodies, dt, rows), hold_turning(joint, bodies, dt, rows);
        if (joint.kind == JointKind::mooring) pull(joint, bodies, dt, rows);
    }
}

template <int D>
bool Joints<D>::tie(std::size_t a, std::size_t b) const {
    const auto i = static_cast<std::ptrdiff_t>(a), j = static_cast<std::ptrdiff_t>(b);
    return std::any_of(list_.begin(), list_.end(), [&](const Joint<D>& joint) {
        const auto body = static_cast<std::ptrdiff_t>(joint.body);
        return joint.kind != JointKind::mooring && ((body == i && joint.other == j) || (body == j && joint.other == i));
    });
}

template <int D>
void Joints<D>::mark(std::vector<Body<D>>& bodies) const {
    for (const Joint<D>& joint : list_) {
        if (joint.kind == JointKind::mooring) continue;
        bodies[joint.body].touches = true;
        if (joint.other >= 0) bodies[static_cast<std::size_t>(joint.other)].touches = true;
    }
}

template class Joints<2>;
template class Joints<3>;

}  // namespace weir::rigid
