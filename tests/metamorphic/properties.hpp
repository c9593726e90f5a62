// The properties: in each a scene is described in another way, and what must not change is compared.
#pragma once
#include "metamorphic/snapshot.hpp"

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace weir::metamorphic {

/// A scene that has been run as it is.
struct Base {
    const scene::Scene& scene;  // as it was made
    const scene::Scene& read;   // as the solver left it: it knows which defaults were read
    Snapshot state;
    int steps = 0;
    real noise = 0;  // what other rounding and another seed of the markers do to its statistics
};

/// States are equal to within rounding; or, where that is not asked for, or where markers and particles stand at thresholds that rounding
/// decides, alike: as much of the volume is kept, and energy, force and the speeds of bodies are the same.
struct Outcome {
    std::optional<real> equal_bound{};
    Difference equal{};
    std::optional<real> alike_bound{};
    Statistics alike{};

    bool is_equal() const { return equal_bound && equal.value <= *equal_bound; }
    bool is_alike() const { return alike_bound && alike.kept.value <= kept_bound && alike.moved.value <= *alike_bound; }
    /// Volume and mass may differ by a hundredth: what counting cut cells does to a small scene.
    static constexpr real kept_bound = 0.01;
};

struct Property {
    std::string name;
    std::string doc;                            // what is described otherwise
    std::function<Outcome(const Base&)> check;  // throws Untransformable where the scene has no image
};

const std::vector<Property>& properties();

/// The noise of a scene: see Base.
real noise_of(const Base& base);

/// Runs a scene for some steps. Throws what the simulation throws.
Snapshot run_steps(Simulation& simulation, int steps);

}  // namespace weir::metamorphic
