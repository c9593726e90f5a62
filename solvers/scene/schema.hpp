// The schema: one table that the reader, the error messages, `weir describe` and the manual page are all made from.
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
    named,     // table whose own keys are names out of `variants`, each with that variant's keys (effects)
    any,       // a flag, number, text, or list of numbers or texts: whatever another key takes (changes)
};

/// A default as the scene would write it. monostate: no default; the key is absent unless given. For a list as long as the scene's
/// dimension, one entry stands for all. For a table with `selector`: the variant taken when the scene does not choose.
using Default = std::variant<std::monostate, bool, std::int64_t, double, std::string, std::vector<double>, std::vector<std::string>>;

struct Key;

/// One kind of shape, motion, effect, probe ... with the keys that belong to it.
struct Variant {
    std::string name{};
    std::string doc{};
    std::vector<Key> keys;
    // Of effects:
    std::vector<std::string> strength{};  // numbers without which it does nothing: its own keys, or with a dot the scene's
    std::string along_with{};             // what else a scene must say for it, as TOML
};

/// One key of a scene. Only `name` and `type` are obligatory.
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
    std::string selector{};           // table, tables: the key whose value picks one of `variants`, whose keys are allowed too.
                                      // A text where such a table is expected stands for a table with only this key.
    std::vector<Variant> variants{};  // with selector: its values; with Type::named: the known names
    const std::vector<Variant>& (*variants_from)() = nullptr;  // in place of `variants`, where those contain themselves (union of shapes)
    int only_dim = 0;                                          // 2 or 3: the key exists only in scenes of that dimension
    std::string example{};                                     // as a scene would write it; shown where a required key is missing
    bool steerable = false;                                    // may change while a run goes on (scene/steer.hpp)
};

/// What a solver adds to the common keys, and the effects that it has. A key with the name of a common one changes that one: its
/// default, its bounds, its choices, and adds nested keys and variants (a "mac_water" scene has cfl = 1 by default; a solver adds
/// "initial.ink" or another `initial.velocity`).
struct SolverSchema {
    std::string name{};
    std::string doc{};
    std::vector<int> dims{2, 3};
    std::vector<Key> keys{};  // top level: "scheme", ...
    std::vector<Variant> effects{};
    std::vector<std::string> without{};  // common keys that it has no use for: "time.cfl", "emitters.smoke", "sides.*.temperature"
    bool columns = false;                // it has one cell along y, however many a scene that other solvers share names
    bool whole_columns = false;          // its memory goes with columns and how they differ in height: a smaller copy keeps the height
    std::string why_without{};           // where it needs saying, why, and what has
};

/// The keys that every scene has (title, solver, dim, grid, time, fluid, sides, liquid, solids, emitters, initial, probes, output).
const std::vector<Key>& common_keys();
const std::vector<Variant>& shapes();   // box, sphere, plane, ... for liquid, solids, emitters and wherever an effect acts in a place
const std::vector<Variant>& motions();  // constant, sinusoidal, rotation, keyframes

/// Common keys with a solver's own laid over them and those left out that it is without, and its effects as the last key.
std::vector<Key> keys_of(const SolverSchema& solver);
/// The keys of `base`, changed and completed by those of `more`.
std::vector<Key> overlay(std::vector<Key> base, const std::vector<Key>& more);

/// Whether `path` ("sides.x_min.temperature", "emitters[0].smoke") is one of the keys that the solver is without.
bool is_without(const SolverSchema& solver, std::string_view path);

const std::vector<Variant>& variants_of(const Key& key);
const Key* find_key(const std::vector<Key>& keys, std::string_view name);
const Variant* find_variant(const Key& key, std::string_view name);

}  // namespace weir::scene
