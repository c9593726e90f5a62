// TOML to tree, by toml++. The only file that includes it: its header takes seconds to compile.
#define TOML_EXCEPTIONS 0          // errors are returned as values and reworded here
#define TOML_HEADER_ONLY 1         // no shared library to depend on
#define TOML_MAX_NESTED_VALUES 64  // SourceText rejects deeper nesting
#include "scene/document.hpp"

#include "scene/source_text.hpp"

#if __has_include(<toml++/impl/preprocessor.hpp>)
#include <toml++/impl/preprocessor.hpp>
#else
#include <toml++/impl/preprocessor.h>
#endif
// Invalid text may violate toml++'s assertions, such as "[ {", which is not a key; it has an error message behind the assertion. Without
// these lines a build with assertions aborts there, and a clang build without them may optimize on a false assumption.
#undef TOML_ASSERT
#undef TOML_ASSERT_ASSUME
#define TOML_ASSERT(expr) static_assert(true)
#define TOML_ASSERT_ASSUME(expr) static_assert(true)
#include <toml++/toml.h>

#include <algorithm>

namespace weir::scene {

const Member* Node::member(std::string_view key) const {
    const auto found = std::find_if(members.begin(), members.end(), [&](const Member& m) { return m.key == key; });
    return found == members.end() ? nullptr : &*found;
}

Member* Node::member(std::string_view key) { return const_cast<Member*>(std::as_const(*this).member(key)); }

namespace {

Place to_place(const toml::source_position& p) { return {static_cast<int>(p.line), static_cast<int>(p.column)}; }

bool before(const Place& a, const Place& b) { return a.line != b.line ? a.line < b.line : a.column < b.column; }

Node to_node(const toml::node& value) {
    Node node;
    node.place = to_place(value.source().begin);
    if (const auto* table = value.as_table()) {
        node.kind = Node::Kind::table;
        for (const auto& [key, child] : *table)
            node.members.push_back({std::string(key.str()), to_place(key.source().begin), to_node(child)});
        std::stable_sort(node.members.begin(), node.members.end(),
                         [](const Member& a, const Member& b) { return before(a.place, b.place); });
    } else if (const auto* list = value.as_array()) {
        node.kind = Node::Kind::list;
        for (const auto& child : *list) node.list.push_back(to_node(child));
    } else if (const auto* flag = value.as_boolean()) {
        node.kind = Node::Kind::flag;
        node.flag = flag->get();
    } else if (const auto* integer = value.as_integer()) {
        node.kind = Node::Kind::integer;
        node.integer = integer->get();
    } else if (const auto* number = value.as_floating_point()) {
        node.kind = Node::Kind::number;
        node.number = number->get();
    } else if (const auto* text = value.as_string()) {
        node.kind = Node::Kind::text;
        node.text = text->get();
    } else {
        node.kind = Node::Kind::date;
    }
    return node;
}

Problem to_problem(const toml::parse_error& error, const SourceText& text, const std::string& file) {
    Problem problem = word_syntax_error(std::string(error.description()), to_place(error.source().begin), text);
    problem.file = file;
    return problem;
}

}  // namespace

Document parse_document(std::string_view source, const std::string& file) {
    Document document;
    SourceText text{source};
    if (auto problem = text.unreadable()) {
        problem->file = file;
        document.problems.push_back(*problem);
        document.readable = false;
        return document;
    }
    constexpr int max_syntax_errors = 20;
    while (true) {
        const auto result = toml::parse(text.text());
        if (result) {
            document.root = to_node(result.table());
            return document;
        }
        document.complete = false;
        document.problems.push_back(to_problem(result.error(), text, file));
        const int line = static_cast<int>(result.error().source().begin.line);
        if (static_cast<int>(document.problems.size()) >= max_syntax_errors || !text.blank_statement(line)) {
            document.readable = false;
            return document;
        }
    }
}

bool parse_value(std::string_view value, Node& node, std::string& error, Place& where) {
    const std::string line = "v = " + std::string(value);
    const SourceText text{line};
    if (auto problem = text.unreadable()) {
        error = problem->message;
        return false;
    }
    const auto result = toml::parse(line);
    if (!result) {
        const auto problem = to_problem(result.error(), text, "");
        error = problem.message;
        where = problem.place;
        return false;
    }
    if (result.table().size() != 1 || !result.table().contains("v")) return error = "more than one value", false;
    node = to_node(*result.table().get("v"));
    return true;
}

}  // namespace weir::scene
