// docs/book/studies.md names every key of cost.toml and stability.toml.
#include "support/test.hpp"
#include "validation/cost/study.hpp"
#include "validation/stability/limit.hpp"

#include <fstream>
#include <iterator>

namespace weir::validation::studies_page_tests {
namespace {

void expect_named(const std::vector<scene::Key>& keys, const std::string& page, const std::string& where) {
    for (const scene::Key& key : keys) {
        const bool named = page.find("`" + key.name + "`") != std::string::npos || page.find(" " + key.name + ",") != std::string::npos ||
                           page.find(" " + key.name + " }") != std::string::npos;
        EXPECT_TRUE(named) << where << key.name;
        expect_named(key.keys, page, where + key.name + ".");
    }
}

TEST("the page of the files of a case names all their keys") {
    std::ifstream file(WEIR_SOURCE_DIR "/docs/book/studies.md");
    const std::string page{std::istreambuf_iterator<char>(file), {}};
    expect_named(study_keys(), page, "cost.toml: ");
    expect_named(stability_keys(), page, "stability.toml: ");
}

}  // namespace
}  // namespace weir::validation::studies_page_tests
