// A run that is steered interactively and that is a scene: what was done is kept as keyframes and changes, and the scene that names them
// repeats the run bit for bit.
#pragma once
#include "sim/simulation.hpp"

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace weir::live {

/// A scene for a session: without an end, and with a brush where its solver has one.
scene::Scene endless(const std::filesystem::path& path, std::vector<scene::Override> overrides);

class Session {
public:
    /// `folder`: where sessions and checkpoints are written.
    Session(scene::Scene scene, std::filesystem::path folder);

    Simulation& simulation() { return *simulation_; }
    const Simulation& simulation() const { return *simulation_; }
    const scene::Scene& scene() const { return scene_; }
    const std::filesystem::path& folder() const { return folder_; }
    bool has_brush() const { return simulation_->solver().brush() != nullptr; }
    /// One step: the window decides after each whether another follows, so it has no use for sim::advance.
    StepReport step() { return simulation_->step(); }
    /// From the next step on; its time is now. What the solver does not have is ignored. A brush that grabs a body grabs the
    /// nearest, and keeps that until it lets go.
    void brush(BrushKeyframe key);
    /// As soon as it can be told in a scene: some steps from now.
    void steer(const scene::Override& change) { simulation_->set_at(simulation_->horizon(), change); }
    /// From the start again; what was done before is forgotten.
    void reset();

    /// The scene that repeats the run; with `more` changes that wait.
    std::string text(const std::vector<Change>& more = {}) const;
    /// Where the run stands, as a checkpoint of that scene. The file's path.
    std::filesystem::path checkpoint() const;
    /// Goes on, with the brush off, to an end that no step before it would have been cut for, and writes session.toml. The file's path.
    std::filesystem::path finish();

private:
    int nearest_body(const Vec<3>& place) const;
    /// As a change in the scene; none where it has ended.
    std::vector<Change> ending() const;

    scene::Scene scene_;
    std::filesystem::path folder_;
    std::unique_ptr<Simulation> simulation_;
};

}  // namespace weir::live
