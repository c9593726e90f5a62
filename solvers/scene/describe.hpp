// The schema as text for users: `weir describe` on the terminal, and the manual page in Markdown. Both are generated from the tables that
// the reader checks against, so they are always consistent with it.
#pragma once
#include "scene/schema.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace weir::scene {

/// Describes a topic: a solver, an effect, a key ("grid", "time.cfl", "scheme.poisson"), a shape, a motion, or any other kind; all with
/// this name. Without a topic: an overview. Throws BadInput for an unknown topic, with the nearest known one.
std::string describe(std::string_view topic, const std::vector<SolverSchema>& solvers);

/// The manual page of scenes, docs/scene.md.
std::string manual(const std::vector<SolverSchema>& solvers);

/// The keys that a solver adds to the common ones or changes: single keys by path, including the inherited text; and for tables with
/// variants, the solver's own variants, with all paths that have the same ones.
struct OwnKeys {
    struct Leaf {
        std::string path;
        Key key;
    };
    struct Choice {
        std::vector<std::string> paths;
        std::string selector;
        std::vector<Variant> variants;
    };
    std::vector<Leaf> leaves;
    std::vector<Choice> choices;
};
OwnKeys own_keys(const SolverSchema& solver);

/// "a number [s], greater than 0 s", "one of ...": the allowed values of a key.
std::string value_text(const Key& key);
/// Its default as in a scene file; empty where there is none.
std::string default_text(const Key& key);

}  // namespace weir::scene
