// Reader of the tags of a small XML text: the headers of VTK's files.
#pragma once
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace weir::output {

struct XmlTag {
    enum Kind { opens, closes, whole };  // <a>, </a>, <a/>
    std::string name;
    Kind kind = opens;
    std::map<std::string, std::string> attributes{};
    std::size_t begin = 0, end = 0;  // in the text

    bool has(const std::string& attribute) const { return attributes.count(attribute) != 0; }
    /// Empty where there is no such attribute.
    std::string text(const std::string& attribute) const;
};

/// The first tag at or after `at`, which is moved behind it. Text between tags is skipped. Throws BadInput naming `file` and the byte.
XmlTag next_tag(const std::filesystem::path& file, std::string_view text, std::size_t& at);

/// The numbers of an attribute. Throws BadInput for a wrong count, or a value that is not finite.
std::vector<double> numbers_of(const std::filesystem::path& file, const XmlTag& tag, const std::string& attribute, std::size_t count);
/// A count: an integer from 0 to 2^53; `otherwise` where the tag has no such attribute.
std::uint64_t count_of(const std::filesystem::path& file, const XmlTag& tag, const std::string& attribute, std::uint64_t otherwise = 0);

}  // namespace weir::output
