// Checks a TOML tree against the schema: every value is checked, every default is filled in, every problem is stored with its position.
#pragma once
#include "scene/document.hpp"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace weir::scene {

class Reader {
public:
    /// dim 0: unknown, 2 and 3 are both accepted. `complete` false: some lines of the file could not be read, so missing keys are not
    /// reported.
    Reader(std::string file, int dim, bool complete, std::vector<Problem>& problems)
        : file_(std::move(file)),
          folder_(std::make_shared<std::filesystem::path>(std::filesystem::path(file_).parent_path())),
          dim_(dim),
          complete_(complete),
          problems_(problems) {}

    /// `solvers` and `solver` are used in messages about keys and effects of other solvers only.
    void know(const std::vector<SolverSchema>& solvers, std::string solver) { solvers_ = &solvers, solver_ = std::move(solver); }

    /// Reads a whole file.
    Table root(const Node& node, const std::vector<Key>& keys);
    Table table(const Node& node, const std::vector<Key>& keys, const std::string& path);
    /// Reads a single value; nullopt, with a problem, where the key does not accept it.
    std::optional<Value> one(const Node& node, const Key& key, const std::string& path) { return value(node, key, path); }

private:
    /// The keys allowed in one table: its own, and those of the selected variant.
    struct Allowed {
        std::vector<const Key*> keys;
        const Key* owner = nullptr;        // the key of the table, if it has variants
        const Variant* variant = nullptr;  // the selected one
        std::string name() const { return variant ? variant->name : std::string(); }
    };

    void fill(const Node& node, const Allowed& allowed, const std::string& path, Table& out);
    bool misspelt(const Node& node, const Allowed& allowed, const Key& key) const;
    void absent(const Key& key, const Node& around, const std::string& path, const std::string& owner_path, Table& out);
    std::optional<Value> value(const Node& node, const Key& key, const std::string& path);
    std::optional<Value> scalar(const Node& node, const Key& key, const std::string& path);
    std::optional<Value> any(const Node& node, const Key& key, const std::string& path);
    std::optional<Value> list(const Node& node, const Key& key, const std::string& path);
    std::optional<Table> table_of(const Node& node, const Key& key, const std::string& path);
    std::optional<Table> chosen(const Node& node, const Key& key, const std::string& path);
    std::optional<Table> named(const Node& node, const Key& key, const std::string& path);
    std::optional<Value> tables(const Node& node, const Key& key, const std::string& path);
    Value default_value(const Key& key) const;

    bool in_range(double v, const Node& node, const Key& key, const std::string& path);
    bool right_length(const Node& node, const Key& key, const std::string& path);
    void unknown_key(const Member& member, const Allowed& allowed, const std::string& path);
    void unknown_variant(const Node& node, const Key& key, std::string_view name, const std::string& path);
    void unknown_effect(const Member& member, const Key& key, const std::string& path);
    void wrong_type(const Node& node, const Key& key, const std::string& path);
    void unknown_choice(const Node& node, const Key& key, const std::string& path);
    const SolverSchema* without(std::string_view path) const;
    std::string place_elsewhere(const std::string& key) const;
    std::vector<std::string> solvers_with(std::string_view key, bool effect) const;
    void report(Place place, std::string message, std::string hint = "", int width = 0);

    std::string file_;
    std::shared_ptr<const std::filesystem::path> folder_;
    int dim_;
    bool complete_;
    std::vector<Problem>& problems_;
    const std::vector<Key>* root_keys_ = nullptr;
    const std::vector<SolverSchema>* solvers_ = nullptr;
    std::string solver_;
};

/// "a list of 2 numbers [m]", "true or false", ...: the type required by a key.
std::string expected(const Key& key, int dim);
/// "greater than 0 m", "between 0 and 1"; empty without bounds.
std::string allowed_range(const Key& key);
/// "the text \"64\"", "a list of 3 entries", ...: a value in words.
std::string found(const Node& node);

}  // namespace weir::scene
