// A TOML text as a tree in which every key and value knows its place. Knows syntax only; what keys mean is the schema's business.
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

/// The tree, and what is wrong with the text itself. After a mistake that stays on its own line the rest is read as if that line were
/// empty, so that later mistakes are found too; `complete` is false then, and keys may be missing only because of it.
struct Document {
    Node root;
    std::vector<Problem> problems;
    bool complete = true;
    bool readable = true;  // false: the text could not be read to its end, and nothing should be concluded from the tree
};

Document parse_document(std::string_view source, const std::string& file);
/// A TOML value by itself; false, with a message and its place behind "v = ", where it is none.
bool parse_value(std::string_view value, Node& node, std::string& error, Place& where);
/// The value of an override, its places in "key=value"; false, and why, where it is none.
bool override_value(const Override& change, int number, Node& value, std::vector<Problem>& problems);
/// "key=value" laid over the tree; tables on the way to the key are made where they are missing.
void apply_override(Node& root, const Override& change, int number, std::vector<Problem>& problems);

/// A longer text is refused; far above any scene that people write, and half an hour of what a hand does in one that is recorded.
inline constexpr std::size_t max_source_bytes = std::size_t{1} << 23;

}  // namespace weir::scene
