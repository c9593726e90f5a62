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
    const scene::Scene& scene;                    // as it was made
    const scene::Scene& read;                     // as the solver left it: it knows which defaults were read
    Snapshot state;
    int steps = 0;
};

/// States are equal to within rounding, or, where markers or particles stand at a threshold that rounding decides, alike: in what they
/// conserve and in their energy.
struct Outcome {
    Difference equal{};
    std::optional<Difference> alike{};
};

struct Property {
    std::string name;
    std::string doc;                              // what must not change
    /// Throws Untransformable where the scene has no image.
    std::function<Outcome(const Base&)> check;
    /// Largest difference of states that are equal.
    std::function<real(const Base&)> bound;
};

const std::vector<Property>& properties();

/// Largest difference of states that are alike.
inline constexpr real alike_bound = 0.02;

/// Runs a scene for some steps. Throws what the simulation throws.
Snapshot run_steps(Simulation& simulation, int steps);

}  // namespace weir::metamorphic
