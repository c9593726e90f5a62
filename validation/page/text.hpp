// Small pieces of a page: text made safe for HTML, numbers as people read them, files as data URLs.
#pragma once
#include <nlohmann/json_fwd.hpp>

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace weir::validation {

/// &, <, > and quotes as entities; control characters as U+FFFD.
std::string escaped(std::string_view text);
/// Four digits, with thin exponents: 1.2e-7 is "1.2×10⁻⁷". Not a number is "not a number".
std::string number_text(double value);
std::string base64(std::string_view bytes);
/// The bytes of a file; empty where it cannot be read.
std::string bytes_of(const std::filesystem::path& file);
/// The parsed file; null where it is missing or not JSON.
nlohmann::json json_of(const std::filesystem::path& file);

std::string text_at(const nlohmann::json& entry, const char* key);
/// The verdicts that are claimed, without open targets; and the open targets alone.
nlohmann::json claimed(const nlohmann::json& verdicts);
nlohmann::json open_targets(const nlohmann::json& verdicts);
/// Cases that were published without numbers of the ci size that the tests could compare.
std::vector<std::string> unpinned_cases(const nlohmann::json& verdicts);
std::optional<double> number_at(const nlohmann::json& entry, const char* key);

/// A table whose columns sort by a click on their heads; a cell's `key` is what it sorts by where that is not its text.
class HtmlTable {
public:
    struct Cell {
        std::string html{};
        std::optional<double> key{};
        bool number = false;  // set to the right
    };
    HtmlTable(std::vector<std::string> heads, std::string caption) : heads_(std::move(heads)), caption_(std::move(caption)) {}
    /// `id` may be empty; `mark` is the row's class: "fail", "front", or nothing.
    void row(std::vector<Cell> cells, std::string_view mark = "", std::string_view id = "");
    std::string html() const;

private:
    std::vector<std::string> heads_;
    std::string caption_, rows_;
};

HtmlTable::Cell word(std::string_view text);
HtmlTable::Cell value(std::optional<double> number);
HtmlTable::Cell raw(std::string html, std::optional<double> key = std::nullopt);

}  // namespace weir::validation
