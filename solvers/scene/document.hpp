// A TOML text as a tree in which every key and value has its position. Syntax only; the schema defines the meaning of keys.
#pragma once
#include "scene/scene.hpp"

#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace weir::scene {

struct Member;

struct Node {
    enum class Kind { flag, integer, number, text, date, list, table };
    Kind kind = Kind::table;
    bool flag = false;
    std::int64_t integer = 0;
    double number = 0;
    std::string text{};
    std::vector<Node> list{};
    std::vector<Member> members;  // in the order of the file
    Place place{};

    Member* member(std::string_view key);
    const Member* member(std::string_view key) const;
};

struct Member {
    std::string key;
    Place place;
    Node value;
};

/// The tree, and the syntax errors of the text. A line with an error is treated as empty and reading continues, so that later errors are
/// also reported. `complete` is then false, and keys may be missing only because of it.
struct Document {
    Node root;
    std::vector<Problem> problems;
    bool complete = true;
    bool readable = true;  // false: the text could not be read to its end, and the tree must not be checked further
};

Document parse_document(std::string_view source, const std::string& file);
/// Parses a single TOML value; returns false, with a message and its position after "v = ", if it is invalid.
bool parse_value(std::string_view value, Node& node, std::string& error, Place& where);
/// The value of an override, with positions in "key=value"; returns false, with the reason, if it is invalid.
bool override_value(const Override& change, int number, Node& value, std::vector<Problem>& problems);
/// Applies "key=value" to the tree; missing tables on the path are created.
void apply_override(Node& root, const Override& change, int number, std::vector<Problem>& problems);

/// Longer texts are rejected; far above any hand-written scene, or half an hour of recorded interactive forcing.
inline constexpr std::size_t max_source_bytes = std::size_t{1} << 23;

}  // namespace weir::scene
