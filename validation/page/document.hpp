// A page as one HTML file that needs no network: the style and the script of all pages, and the parts of this one.
#pragma once
#include <string>
#include <vector>

namespace weir::validation {

/// A part of a page. Its id, a word, is also its name in the list of contents.
struct Part {
    std::string id{};
    std::string title{}, html{};  // HTML both
};

struct Document {
    std::string title{};  // text, of the window
    std::string header{}, cards{};
    std::vector<Part> parts{};
    std::string footer{};
};

/// The list of contents names the parts that have a text, and the studies in them.
std::string document_html(const Document& document);

}  // namespace weir::validation
