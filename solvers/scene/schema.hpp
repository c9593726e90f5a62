// The schema: one table that the reader, the error messages, `weir describe` and the manual page are all made from.
#pragma once
#include <optional>
#include <string>
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
};

/// A default as the scene would write it. monostate: no default; the key is absent unless given.
using Default = std::variant<std::monostate, bool, std::int64_t, double, std::string, std::vector<double>, std::vector<std::string>>;

struct Key;

/// One kind of shape, motion, effect, probe ... with the keys that belong to it.
struct Variant {
    std::string name;
    std::string doc;
    std::vector<Key> keys;
};

/// One key of a scene. Only `name` and `type` are obligatory.
struct Key {
    std::string name;
    Type type = Type::number;
    std::string doc;
    std::string unit;  // "m", "s", "kg/m^3"; empty: none
    Default fallback;  // used when the key is absent
    bool required = false;
    std::optional<double> min, max;  // for numbers and integers, and each entry of lists
    bool min_open = false;           // min itself is not allowed (a size > 0)
    int length = 0;                  // of lists; see Type
    std::vector<std::string> choices;
    std::vector<Key> keys;          // of table and tables
    std::string selector;           // table, tables: the key whose value picks one of `variants`, whose keys are allowed too
    std::vector<Variant> variants;  // with selector: its values; with Type::named: the known names
};

/// What a solver adds to the common keys, and the effects that it has.
struct SolverSchema {
    std::string name;
    std::string doc;
    std::vector<int> dims;  // 2, 3
    std::vector<Key> keys;  // top level: "scheme", ...
    std::vector<Variant> effects;
};

/// The keys that every scene has (title, solver, dim, grid, time, fluid, gravity, sides, liquid, solids, emitters, probes, output, ...).
const std::vector<Key>& common_keys();

}  // namespace weir::scene
