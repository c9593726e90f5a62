// The schema: one table that defines the reader, the error messages, `weir describe` and the manual page.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace weir::scene {

enum class Type {
    flag,      // true / false
    integer,   // 64 bit
    number,    // finite double; an integer is accepted
    text,      // any string
    choice,    // one of `choices`
    numbers,   // list of numbers; `length`: 0 any, -1 the scene's dimension, n exactly n
    integers,  // list of integers, length as above
    texts,     // list of strings, each one of `choices` where those are given
    table,     // nested keys in `keys`
    tables,    // list of tables, each with `keys`
    named,     // table whose own keys are names from `variants`, each with that variant's keys (effects)
    any,       // a flag, number, text, or list of numbers or texts: the value of another key (changes)
};

/// A default as written in a scene. monostate: no default; the key is absent unless given. For a list of the scene's dimension, one entry
/// stands for all. For a table with `selector`: the default variant.
using Default = std::variant<std::monostate, bool, std::int64_t, double, std::string, std::vector<double>, std::vector<std::string>>;

struct Key;

/// One kind of shape, motion, effect, probe ... with its keys.
struct Variant {
    std::string name{};
    std::string doc{};
    std::vector<Key> keys;
    // for effects
    std::vector<std::string> strength{};  // numbers without which it has no effect: its own keys, or with a dot the scene's
    std::string along_with{};             // further keys that a scene needs for it, as TOML
};

/// One key of a scene. Only `name` and `type` are required.
struct Key {
    std::string name{};
    Type type = Type::number;
    std::string doc{};
    std::string unit{};  // "m", "s", "kg/m^3"; empty: none
    Default fallback{};  // used when the key is absent
    bool required = false;
    std::optional<double> min{}, max{};  // for numbers and integers, and each entry of lists
    bool min_open = false;               // min itself is not allowed (a size > 0)
    int length = 0;                      // of lists; see Type
    std::vector<std::string> choices{};
    std::vector<Key> keys{};          // of table and tables
    std::string selector{};           // table, tables: the key whose value selects one of `variants`, whose keys are then allowed
                                      // A text instead of such a table stands for a table with only this key.
    std::vector<Variant> variants{};  // with selector: its values; with Type::named: the known names
    const std::vector<Variant>& (*variants_from)() = nullptr;  // instead of `variants`, where those are recursive (union of shapes)
    int only_dim = 0;                                          // 2 or 3: the key exists only in scenes of that dimension
    std::string example{};                                     // as in a scene; shown where a required key is missing
    bool steerable = false;                                    // may change during a run (scene/steer.hpp)
};

/// The keys that a solver adds to the common ones, and its effects. A key with the name of a common one changes that one: its default, its
/// bounds, its choices, and adds nested keys and variants (a "mac_water" scene has cfl = 1 by default; a solver adds "initial.ink" or
/// another `initial.velocity`).
struct SolverSchema {
    std::string name{};
    std::string doc{};
    std::vector<int> dims{2, 3};
    std::vector<Key> keys{};  // top level: "scheme", ...
    std::vector<Variant> effects{};
    std::vector<std::string> without{};  // common keys that it does not use: "time.cfl", "emitters.smoke", "sides.*.temperature"
    bool columns = false;                // it uses one cell along y, for any number of cells in scenes shared with other solvers
    bool whole_columns = false;          // its memory depends on columns and their differences in height: a smaller copy keeps the height
    std::string why_without{};           // the reason, where needed, and the alternative
    bool study = false;                  // a problem of the validation suite with an exact solution, not a solver of flows
};

/// The keys that every scene has (title, solver, dim, grid, time, fluid, sides, liquid, solids, emitters, initial, probes, output).
const std::vector<Key>& common_keys();
const std::vector<Variant>& shapes();   // box, sphere, plane, ... for liquid, solids, emitters and regions of effects
const std::vector<Variant>& motions();  // constant, sinusoidal, rotation, keyframes

/// Common keys overlaid with a solver's own, without those that it does not use, and its effects as the last key.
std::vector<Key> keys_of(const SolverSchema& solver);
/// The keys of `base`, changed and completed by those of `more`.
std::vector<Key> overlay(std::vector<Key> base, const std::vector<Key>& more);

/// Returns whether `path` ("sides.x_min.temperature", "emitters[0].smoke") is one of the keys that the solver does not use.
bool is_without(const SolverSchema& solver, std::string_view path);

const std::vector<Variant>& variants_of(const Key& key);
const Key* find_key(const std::vector<Key>& keys, std::string_view name);
const Variant* find_variant(const Key& key, std::string_view name);

}  // namespace weir::scene
