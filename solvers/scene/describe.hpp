// The schema as text for people: `weir describe` on the terminal, and the manual page in Markdown. Both from the tables that the reader
// checks against, so they cannot say anything else.
#pragma once
#include "scene/schema.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace weir::scene {

/// What a topic is: a solver, an effect, a key ("grid", "time.cfl", "scheme.poisson"), a shape, a motion, or any other kind; all that
/// bear the name. Without a topic: what there is. Throws BadInput for an unknown topic, naming the nearest.
std::string describe(std::string_view topic, const std::vector<SolverSchema>& solvers);

/// The manual page of scenes, docs/scene.md.
std::string manual(const std::vector<SolverSchema>& solvers);

/// What a solver adds to the common keys or changes in them: single keys by path, complete with what the common key says; and for
/// tables that choose a variant, the variants that are its own, with all paths that have the same ones.
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

/// "a number [s], greater than 0 s", "one of ...": what may be written for a key.
std::string value_text(const Key& key);
/// Its default as a scene would write it; empty where there is none.
std::string default_text(const Key& key);

}  // namespace weir::scene
