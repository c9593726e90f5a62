#include "app/live/session.hpp"

#include "geometry/brush.hpp"
#include "geometry/mesh/mesh.hpp"
#include "output/atomic_file.hpp"
#include "rigid/bodies.hpp"
#include "scene/names.hpp"
#include "sim/loop.hpp"
#include "sim/registry.hpp"

#include <fmt/format.h>

namespace weir::live {

namespace {

constexpr real no_end = 1e6;  // [s]: eleven days

void put_text(Checkpoint& to, const std::string& name, const std::string& text) { to.put(name, std::span<const char>(text)); }

/// Whether the scene's solver has a brush, on the backend that the scene names.
bool may_have_brush(const scene::Scene& scene) {
    const auto& effects = sim::kind_named(scene.solver()).schema.effects;
    const bool known = std::any_of(effects.begin(), effects.end(), [](const auto& effect) { return effect.name == "hand"; });
    return known && scene.root().text_or("scheme.backend", "threads").starts_with("threads");
}

}  // namespace

scene::Scene endless(const std::filesystem::path& path, std::vector<scene::Override> overrides) {
    overrides.push_back({"time.end", scene::number_text(no_end)});
    const auto scene = scene::read(path, sim::schemas(), overrides);
    if (scene.effect("hand") || !may_have_brush(scene)) return scene;
    overrides.push_back({"effects.hand.rate", "50"});
    return scene::read(path, sim::schemas(), overrides);
}

Session::Session(scene::Scene scene, std::filesystem::path folder) : scene_(std::move(scene)), folder_(std::move(folder)) { reset(); }

void Session::reset() { simulation_ = std::make_unique<Simulation>(scene_); }

void Session::brush(BrushKeyframe key) {
    BrushForcing* forcing = simulation_->solver().brush();
    if (!forcing) return;
    if (!forcing->has(key.kind)) key = {};
    key.time = simulation_->time();
    auto& keys = forcing->keys;
    const auto next =
        std::upper_bound(keys.begin(), keys.end(), key.time, [](real time, const BrushKeyframe& other) { return time < other.time; });
    const bool first = next == keys.begin();
    const BrushKeyframe before = first ? BrushKeyframe{} : *std::prev(next);
    if (key.kind == BrushKind::grab) key.body = before.kind == BrushKind::grab ? before.body : nearest_body(key.centre);
    const bool same =
        key.kind == before.kind &&
        (key.kind == BrushKind::off || (key.centre == before.centre && key.radius == before.radius && key.velocity == before.velocity &&
                                        key.speed == before.speed && key.temperature == before.temperature));
    if (same) return;
    if (!first && before.time == key.time)
        *std::prev(next) = key;
    else
        keys.insert(next, key);
}

/// By its centre of mass.
int Session::nearest_body(const Vec<3>& place) const {
    const FieldSet fields = simulation_->fields();
    const FieldView* x = fields.find(rigid::body_set_name, "position");
    int nearest = 0;
    real least = infinity;
    for (std::size_t b = 0; x && b < x->data[0].size(); ++b) {
        Vec<3> apart = place;
        for (std::size_t a = 0; a < x->data.size(); ++a) apart[static_cast<int>(a)] -= x->data[a][b];
        if (norm(apart) < least) least = norm(apart), nearest = static_cast<int>(b);
    }
    return nearest;
}

std::string Session::text(const std::vector<Change>& more) const {
    const scene::Place given{1, 1};
    scene::Table root = scene_.root();
    if (const BrushForcing* forcing = simulation_->solver().brush()) {
        std::vector<scene::Table> frames;
        for (const BrushKeyframe& key : forcing->keys) frames.push_back(geometry::to_table(key, scene_.dim()));
        root.find_table("effects.hand")->set("keyframes", std::move(frames), given);
    }
    if (root.has("terrain.file"))  // its path is from the scene's folder
        root.find_table("terrain")->set(
            "file",
            std::filesystem::proximate(std::filesystem::path(scene_.file()).parent_path() / root.text("terrain.file"), folder_).string(),
            given);
    geometry::name_meshes_from(folder_, root);
    root.erase("changes");
    std::string changes;
    auto all = simulation_->changes();
    all.insert(all.end(), more.begin(), more.end());
    for (const auto& change : all)
        changes += fmt::format("    {{ time = {}, key = \"{}\", value = {} }},\n", scene::number_text(change.time), change.what.key,
                               change.what.value);
    return "# A recorded session of interactive forcing, as a scene: `weir run` repeats it bit for bit.\n" + scene::to_scene_text(root) +
           (changes.empty() ? "" : "changes = [\n" + changes + "]\n");
}

/// Some numbers of a solver may follow from time.end, such as the length of even steps: so it stays what it was, until it is changed.
std::vector<Change> Session::ending() const {
    if (simulation_->finished()) return {};
    const real from = simulation_->horizon();
    return {{from, {"time.end", scene::number_text(from + (from - simulation_->time()))}}};
}

std::filesystem::path Session::checkpoint() const {
    Checkpoint checkpoint;
    simulation_->save(checkpoint);
    put_text(checkpoint, "sim.source", text(ending()));
    put_text(checkpoint, "sim.file", (folder_ / "session.toml").string());
    put_text(checkpoint, "sim.overrides", "");
    std::filesystem::create_directories(folder_);
    const auto file = folder_ / "checkpoint.weir";
    checkpoint.write(file);
    return file;
}

std::filesystem::path Session::finish() {
    brush({});  // it lets go
    for (const auto& end : ending()) simulation_->set_at(end.time, end.what);
    try {
        sim::advance(*simulation_);
    } catch (const NumericalFailure&) {
        // the scene fails there as the session did
    }
    std::filesystem::create_directories(folder_);
    const auto file = folder_ / "session.toml";
    output::write_file(file, text());
    return file;
}

}  // namespace weir::live
