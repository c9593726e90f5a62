// A scene as plain data: read from TOML against a schema, checked as a whole, defaults filled in, every value with its position.
#pragma once
#include "core/error.hpp"
#include "core/types.hpp"
#include "scene/schema.hpp"

#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace weir::scene {

/// Position of a value in its file, or in the text of an override; line 0 and override -1: a default. Columns count characters.
struct Place {
    int line = 0;
    int column = 0;
    int override_number = -1;
};

/// One problem of a scene, and the expected value.
struct Problem {
    std::string file{};     // or "--set key=value" of the invalid override
    Place place{};          // line 0: no line is shown, except for an override
    int width = 0;          // characters to underline; 0: the word, text or list at that position
    std::string message{};  // what was found and what is allowed
    std::string hint{};     // "known: ...", shown after the underline; may be empty
};

/// All problems of one scene. what() is the complete report for the user (format: file:line:column: message, line, underline).
struct BadScene : BadInput {
    BadScene(std::vector<Problem> problems, std::string_view source);
    std::vector<Problem> problems;
};

class Table;
/// Lists of integers and numbers are stored as numbers; integers are exact to 2^53.
using Value =
    std::variant<bool, std::int64_t, double, std::string, std::vector<double>, std::vector<std::string>, Table, std::vector<Table>>;

/// Checked values by key. A path "grid.cells" descends through tables. A key that is not in the schema, or an absent key without default,
/// is a programming error: std::logic_error.
class Table {
public:
    bool has(std::string_view path) const;
    bool flag(std::string_view path) const;
    std::int64_t integer(std::string_view path) const;
    real number(std::string_view path) const;
    real number_or(std::string_view path, real fallback) const { return has(path) ? number(path) : fallback; }
    const std::string& text(std::string_view path) const;
    std::string text_or(std::string_view path, std::string_view fallback) const { return has(path) ? text(path) : std::string(fallback); }
    const std::vector<double>& numbers(std::string_view path) const;
    const std::vector<std::string>& texts(std::string_view path) const;
    const Table& table(std::string_view path) const;
    const std::vector<Table>& tables(std::string_view path) const;  // an absent list is empty
    Place place(std::string_view path) const;
    template <int D>
    Vec<D> vec(std::string_view path) const {
        Vec<D> v{};
        const auto& list = numbers(path);
        for (int d = 0; d < D && d < static_cast<int>(list.size()); ++d) v[d] = list[static_cast<std::size_t>(d)];
        return v;
    }
    template <int D>
    Index<D> index(std::string_view path) const {
        Index<D> i{};
        const auto& list = numbers(path);
        for (int d = 0; d < D && d < static_cast<int>(list.size()); ++d) i[d] = static_cast<int>(list[static_cast<std::size_t>(d)]);
        return i;
    }
    /// The path of a file named by a key, relative to the folder of the scene.
    std::filesystem::path file(std::string_view path) const;
    /// Keys in the order of the file, then defaults in schema order.
    std::vector<std::string> keys() const;

    /// Returns whether a value was read by one of the typed functions since it was set or forgotten. Accesses by keys() and find(), for
    /// printing a table, do not count. A key that a scene gives but no code reads is an error (scene/given.hpp).
    bool was_read(std::string_view path) const;
    void mark_read(std::string_view path) const;
    void forget_reading();

    void set(const std::string& key, Value value, Place place = {});
    void stands_in(std::shared_ptr<const std::filesystem::path> folder) { folder_ = std::move(folder); }
    const Value* find(std::string_view path) const;
    Table* find_table(std::string_view path);  // nullptr where there is none
    void erase(std::string_view key);          // of this table only

private:
    struct Entry;
    const Entry* entry(std::string_view path) const;
    std::vector<Entry> entries_;
    std::shared_ptr<const std::filesystem::path> folder_;  // of the scene's file; nullptr: none
};

struct Table::Entry {
    std::string key;
    Value value;
    Place place;
    mutable bool read = false;  // set by readers on any thread: std::atomic_ref
};

struct Override {
    std::string key;    // "grid.cells", "effects.buoyancy.alpha", "solids[0].centre"
    std::string value;  // a TOML value: "[64, 64]", "true", "\"pic\"" (a bare word is taken as a string)
};
/// "grid.cells=[64, 64]" as it stands on the command line. Throws BadInput where there is no '=' or no key.
Override to_override(std::string_view text);

/// A scene that was read. root() has every key; the shortcuts are the most frequent ones.
class Scene {
public:
    const Table& root() const { return root_; }  // every key, defaults filled in
    const std::string& file() const { return file_; }
    const std::string& source() const { return source_; }
    const std::string& solver() const { return solver_; }
    int dim() const { return dim_; }
    /// The table of an effect of the scene; nullptr where it does not name it.
    const Table* effect(std::string_view name) const;
    /// The same scene with a key changed during the run. Throws BadInput where the key or the value is not allowed (scene/steer.hpp).
    Scene steered(const Override& change, const std::vector<SolverSchema>& solvers) const;
    /// The same scene without the effect.
    Scene without_effect(std::string_view name) const;
    /// A problem at a key of this scene ("solids[0].centre"), for checks beyond the schema, such as geometry. For a default the position is
    /// that of the nearest enclosing table. `refuse` throws BadScene.
    Problem problem(std::string_view path, const std::string& message, const std::string& hint = "") const;
    [[noreturn]] void refuse(std::string_view path, const std::string& message, const std::string& hint = "") const;
    [[noreturn]] void refuse(std::vector<Problem> problems) const;
    const std::vector<Override>& overrides() const { return overrides_; }
    /// Starts recording which keys are read.
    void forget_reading() { root_.forget_reading(); }

    bool has(std::string_view path) const { return root_.has(path); }
    real number(std::string_view path) const { return root_.number(path); }
    std::int64_t integer(std::string_view path) const { return root_.integer(path); }
    const std::string& text(std::string_view path) const { return root_.text(path); }
    bool flag(std::string_view path) const { return root_.flag(path); }
    template <int D>
    Vec<D> vec(std::string_view path) const {
        return root_.vec<D>(path);
    }
    template <int D>
    Index<D> index(std::string_view path) const {
        return root_.index<D>(path);
    }

private:
    friend Scene parse(std::string_view, const std::string&, const std::vector<SolverSchema>&, const std::vector<Override>&);
    Table root_;
    std::string file_, source_, solver_;
    int dim_ = 2;
    std::vector<Override> overrides_;
};

/// A scene constructed in code: key by key, as text, so that it is read and checked like a file.
///   Builder scene;
///   scene.set("solver", "mac_water").set("grid.cells", {64, 32}).set("effects.gravity.g", {0, -9.81});
///   scene.add("liquid", Builder().set("shape", "box").set("min", {0, 0}).set("max", {0.25, 0.5}));
class Builder {
public:
    /// Sets a key by its path; a repeated key is replaced. Integers and numbers must match the schema.
    Builder& set(const std::string& key, const Value& value);
    Builder& set(const std::string& key, std::initializer_list<double> values);
    Builder& set(const std::string& key, const std::vector<std::string>& values);
    /// An empty table: an effect with its defaults.
    Builder& name(const std::string& key);
    /// Appends an entry to a list of tables: liquid, solids, emitters, probes.
    Builder& add(const std::string& list, const Builder& entry);
    /// TOML, one key per line, in the order in which they were set; messages refer to its lines.
    std::string text() const;
    /// Reads and checks the scene against these solvers; `file` is its name in messages. Throws BadScene with all problems.
    Scene scene(const std::vector<SolverSchema>& solvers, const std::string& file = "scene") const;

private:
    struct Line {
        std::string key, text;
        bool list = false;
    };
    Line& line(const std::string& key);
    std::vector<Line> lines_;
};

/// Reads and checks a scene from text; `file` is its name in messages. Throws BadScene with every problem found.
Scene parse(std::string_view source, const std::string& file, const std::vector<SolverSchema>& solvers,
            const std::vector<Override>& overrides = {});
/// Reads any TOML text against any keys: `parse` without the rules of scenes. For additional files beside a scene.
Table parse_table(std::string_view source, const std::string& file, const std::vector<Key>& keys, int dim = 0);
/// A folder means its scene.toml. Throws BadInput when it cannot be read.
Scene read(const std::filesystem::path& path, const std::vector<SolverSchema>& solvers, const std::vector<Override>& overrides = {});
/// The whole text of a scene file. Throws BadInput when it cannot be read, is empty, too long, or not text.
std::string read_text(const std::filesystem::path& path);

/// A table as text that reads back identically: numbers in their shortest exact form.
std::string to_toml(const Table& table);
std::string to_json(const Table& table);
/// A value as the text of an override: a number, a list, a quoted text.
std::string to_toml(const Value& value);
/// The scene without defaults, as text. Effects and their list entries have lines of their own.
std::string to_scene_text(const Table& root);

}  // namespace weir::scene
