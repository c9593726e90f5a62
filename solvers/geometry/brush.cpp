#include "geometry/brush.hpp"

#include <string>

namespace weir::geometry {

using scene::Key;
using scene::Type;

scene::Variant brush_schema() {
    const std::vector<Key> keyframe{
        {.name = "time",
         .type = Type::number,
         .doc = "Time from which it applies, until the next keyframe.",
         .unit = "s",
         .required = true,
         .min = 0},
        {.name = "kind",
         .type = Type::choice,
         .doc = "push: relax towards `velocity`. pull: relax towards the centre of the brush, with `speed` at its edge. pour: inflow with "
                "`velocity` fills the empty part of the brush (smoke, where fluid fills the domain; columns of water rise with `speed`). "
                "drain: fluid (smoke) is removed (columns sink with `speed`). heat: relax towards `temperature`; requires a substance. "
                "grab: a spring from the centre of the brush to the centre of mass of a body. off: no forcing.",
         .fallback = std::string("push"),
         .choices = {brush_kinds.begin(), brush_kinds.end()}},
        {.name = "centre", .type = Type::numbers, .doc = "Of the brush; required except for off.", .unit = "m", .length = -1},
        {.name = "radius", .type = Type::number, .doc = "Of the brush; required except for off.", .unit = "m", .min = 0, .min_open = true},
        {.name = "velocity",
         .type = Type::numbers,
         .doc = "Target velocity of push and pour.",
         .unit = "m/s",
         .fallback = std::vector<double>{0},
         .length = -1},
        {.name = "speed",
         .type = Type::number,
         .doc = "Target speed of pull; in a height field of pour and drain.",
         .unit = "m/s",
         .fallback = 0.0,
         .min = 0},
        {.name = "temperature",
         .type = Type::number,
         .doc = "Target temperature of heat, required there; at most the boiling temperature of the liquid.",
         .unit = "K",
         .min = 0,
         .min_open = true},
        {.name = "body",
         .type = Type::integer,
         .doc = "Body of grab: its number in the list `bodies`, from 0.",
         .fallback = std::int64_t{0},
         .min = 0}};
    return {"hand",
            "Interactive forcing by a round brush with keyframes. It pushes, pulls, adds or removes fluid, heats, or holds a body: du/dt = "
            "rate w (target - u) with w = (1 - r^2/radius^2)^2 inside the brush, integrated exactly over the step; targets are limited to "
            "one cell per step. The integrals hand_impulse_x .., hand_mass and hand_heat record what it has added. The brush does not "
            "extend across periodic sides.",
            {{.name = "rate",
              .type = Type::number,
              .doc = "Relaxation rate at the centre of the brush.",
              .unit = "1/s",
              .fallback = 50.0,
              .min = 0,
              .steerable = true},
             {.name = "keyframes", .type = Type::tables, .doc = "Keyframes in the order of time.", .keys = keyframe}},
            {"rate"}};
}

namespace {

BrushKind brush_kind_named(const std::string& name) {
    return static_cast<BrushKind>(std::find(brush_kinds.begin(), brush_kinds.end(), name) - brush_kinds.begin());
}

std::string kinds_of(const BrushForcing& forcing) {
    std::string list;
    for (std::size_t k = 0; k < brush_kinds.size(); ++k)
        if (forcing.can[k]) list += (list.empty() ? "" : ", ") + std::string(brush_kinds[k]);
    return list;
}

Vec<3> point(const scene::Table& t, const char* key) {
    Vec<3> p{};
    if (t.has(key)) {
        const auto& list = t.numbers(key);
        std::copy(list.begin(), list.end(), p.begin());
    }
    return p;
}

}  // namespace

std::shared_ptr<BrushForcing> make_brush(const scene::Scene& scene, std::initializer_list<BrushKind> kinds) {
    const scene::Table* table = scene.effect("hand");
    if (!table) return nullptr;
    auto forcing = std::make_shared<BrushForcing>();
    forcing->rate = table->number("rate");
    forcing->allow({BrushKind::off});
    forcing->allow(kinds);
    const auto& frames = table->tables("keyframes");
    forcing->keys.reserve(frames.size());
    for (std::size_t i = 0; i < frames.size(); ++i) {
        const scene::Table& t = frames[i];
        const std::string path = "effects.hand.keyframes[" + std::to_string(i) + "]";
        forcing->keys.push_back({t.number("time"), brush_kind_named(t.text("kind")), point(t, "centre"), t.number_or("radius", 0),
                                 point(t, "velocity"), t.number("speed"), t.number_or("temperature", 0),
                                 static_cast<int>(t.integer("body"))});
        if (i > 0 && forcing->keys[i].time < forcing->keys[i - 1].time)
            scene.refuse(path + ".time", "it is before that of the previous keyframe");
        if (!forcing->has(forcing->keys[i].kind))
            scene.refuse(path + ".kind", "the brush has no action \"" + t.text("kind") + "\" in this scene",
                         "it has " + kinds_of(*forcing));
        if (forcing->keys[i].kind == BrushKind::off) continue;
        if (forcing->keys[i].kind == BrushKind::heat && !t.has("temperature"))
            scene.refuse(path, path + " has no \"temperature\"", "action heat requires it");
        for (const char* key : {"centre", "radius"})
            if (!t.has(key)) scene.refuse(path, path + " has no \"" + key + "\"", "only action \"off\" does not require it");
    }
    return forcing;
}

std::initializer_list<BrushKind> kinds_of_brush(bool heats, bool holds) {
    using enum BrushKind;
    static constexpr auto on_fluid = {push, pull, pour, drain}, heating = {push, pull, pour, drain, heat},
                          holding = {push, pull, pour, drain, grab}, both = {push, pull, pour, drain, heat, grab};
    return heats && holds ? both : heats ? heating : holds ? holding : on_fluid;
}

scene::Table to_table(const BrushKeyframe& key, int dim) {
    const scene::Place given{1, 1};
    const auto list = [&](const Vec<3>& v) { return std::vector<double>(v.begin(), v.begin() + dim); };
    scene::Table t;
    t.set("time", key.time, given);
    t.set("kind", std::string(brush_kinds[static_cast<std::size_t>(key.kind)]), given);
    if (key.kind == BrushKind::off) return t;
    t.set("centre", list(key.centre), given);
    t.set("radius", key.radius, given);
    if (key.speed != 0) t.set("speed", key.speed, given);
    if (key.kind == BrushKind::heat) t.set("temperature", key.temperature, given);
    if (key.kind == BrushKind::grab) t.set("body", std::int64_t{key.body}, given);
    if (key.kind == BrushKind::push || key.kind == BrushKind::pour) t.set("velocity", list(key.velocity), given);
    return t;
}

void sum_up(const BrushForcing& forcing, int dim, std::vector<Integral>& list) {
    const std::string per_depth = dim == 2 ? "/m" : "";
    for (int a = 0; a < dim; ++a) list.push_back({std::string("hand_impulse_") + "xyz"[a], "kg m/s" + per_depth, forcing.impulse[a]});
    list.push_back({"hand_mass", "kg" + per_depth, forcing.mass});
    if (forcing.has(BrushKind::heat)) list.push_back({"hand_heat", "J" + per_depth, forcing.heat});
}

}  // namespace weir::geometry
