#include "output/xml_tags.hpp"

#include "core/error.hpp"
#include "core/words.hpp"

#include <cctype>
#include <charconv>
#include <cmath>

namespace weir::output {

namespace {

[[noreturn]] void refuse(const std::filesystem::path& file, std::size_t at, const std::string& what) {
    throw BadInput(file.string() + ": damaged at byte " + std::to_string(at) + ": " + what);
}

bool is_space(char c) { return c == ' ' || c == '\n' || c == '\r' || c == '\t'; }
bool is_name(char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == ':' || c == '-' || c == '.'; }

std::string name_at(std::string_view text, std::size_t& at) {
    const std::size_t begin = at;
    while (at < text.size() && is_name(text[at])) ++at;
    return std::string(text.substr(begin, at - begin));
}

void skip_space(std::string_view text, std::size_t& at) {
    while (at < text.size() && is_space(text[at])) ++at;
}

/// name="value"; other quotes do not occur in these files.
void read_attribute(const std::filesystem::path& file, std::string_view text, std::size_t& at, XmlTag& tag) {
    const std::size_t begin = at;
    const std::string name = name_at(text, at);
    if (name.empty() || text.substr(at, 2) != "=\"") refuse(file, begin, "name=\"value\" is expected");
    at += 2;
    const std::size_t end = text.find('"', at);
    if (end == std::string_view::npos) refuse(file, begin, "the value of \"" + name + "\" has no end");
    const std::string value(text.substr(at, end - at));
    for (const char c : value)
        if (static_cast<unsigned char>(c) < 0x20 || static_cast<unsigned char>(c) >= 0x7f || c == '<' || c == '&')
            refuse(file, begin, "the value of \"" + name + "\" is no text");
    if (!tag.attributes.emplace(name, value).second) refuse(file, begin, "\"" + name + "\" is given twice");
    at = end + 1;
}

}  // namespace

std::string XmlTag::text(const std::string& attribute) const {
    const auto found = attributes.find(attribute);
    return found == attributes.end() ? "" : found->second;
}

XmlTag next_tag(const std::filesystem::path& file, std::string_view text, std::size_t& at) {
    XmlTag tag;
    for (;;) {
        tag.begin = text.find('<', at);
        if (tag.begin == std::string_view::npos) refuse(file, at, "a tag is expected");
        at = tag.begin + 1;
        if (at >= text.size() || text[at] != '?') break;
        at = text.find('>', at);  // <?xml ...?>
        if (at == std::string_view::npos) refuse(file, tag.begin, "a tag has no end");
    }
    if (at < text.size() && text[at] == '/') tag.kind = XmlTag::closes, ++at;
    tag.name = name_at(text, at);
    if (tag.name.empty()) refuse(file, at, "the name of a tag is expected");
    for (skip_space(text, at); at < text.size() && text[at] != '>' && text[at] != '/'; skip_space(text, at))
        read_attribute(file, text, at, tag);
    if (at < text.size() && text[at] == '/' && tag.kind == XmlTag::opens) tag.kind = XmlTag::whole, ++at;
    if (at >= text.size() || text[at] != '>') refuse(file, at, "the end of the tag \"" + tag.name + "\" is expected");
    tag.end = ++at;
    return tag;
}

std::vector<double> numbers_of(const std::filesystem::path& file, const XmlTag& tag, const std::string& attribute, std::size_t count) {
    const std::string text = tag.text(attribute);
    std::vector<double> numbers;
    for (std::size_t at = 0; skip_space(text, at), at < text.size();) {
        double value = 0;
        const auto [end, error] = std::from_chars(text.data() + at, text.data() + text.size(), value);
        at = static_cast<std::size_t>(end - text.data());
        if (error != std::errc() || !std::isfinite(value) || (at < text.size() && !is_space(text[at]))) {
            numbers.clear();
            break;
        }
        numbers.push_back(value);
    }
    if (numbers.size() != count)
        refuse(file, tag.begin,
               '"' + attribute + "\" of " + tag.name + " is \"" + Words::shown(text) + "\"; " + std::to_string(count) +
                   " numbers are expected");
    return numbers;
}

std::uint64_t count_of(const std::filesystem::path& file, const XmlTag& tag, const std::string& attribute, std::uint64_t otherwise) {
    if (!tag.has(attribute)) return otherwise;
    const double value = numbers_of(file, tag, attribute, 1)[0];
    if (!(value >= 0 && value <= 0x1p53 && value == std::floor(value)))
        refuse(file, tag.begin, '"' + attribute + "\" of " + tag.name + " is " + tag.text(attribute) + ", which is no count");
    return static_cast<std::uint64_t>(value);
}

}  // namespace weir::output
