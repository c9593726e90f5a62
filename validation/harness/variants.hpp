// What case.toml and cost.toml say alike: a list of configurations of a scene, each with changes and a sweep, and what holds for all.
#pragma once
#include "validation/harness/case.hpp"

#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace weir::validation {

/// Keys of a table that VariantReader reads: scene, reference, set, sweep, ci, full.
std::vector<scene::Key> variant_keys();

/// Reads variants of one size; collects what the schema alone cannot see.
class VariantReader {
public:
    VariantReader(std::string file, std::filesystem::path folder, Size size)
        : file_(std::move(file)), folder_(std::move(folder)), size_(size) {}

    /// Called with each table that is laid over a variant: first the file's own, then the variant's.
    using More = std::function<void(Variant&, const scene::Table&)>;
    /// One variant for each entry of the list called `list`, or for each value of [over], or one without a name. A variant whose entry
    /// belongs to another size stays out.
    std::vector<Variant> read(const scene::Table& root, std::string_view list, const More& more);

    /// Changes, sweep, scene and reference that one more table says, over `v`.
    void lay_over(Variant& v, const scene::Table& t) { merge(v, t, nullptr); }

    /// A text that must say something.
    std::string said(const scene::Table& t, const std::string& key);
    void problem(scene::Place at, std::string message, std::string hint = "");
    const std::vector<scene::Problem>& problems() const { return problems_; }
    Size size() const { return size_; }

private:
    std::vector<real> numbers_of_size(const scene::Table& t) const;
    std::vector<Variant> over(const scene::Table& t, const Variant& common, std::string_view names);
    void check_name(scene::Place at, const std::vector<Variant>& list, const std::string& hint = "");
    void merge(Variant& v, const scene::Table& t, const More& more);
    void add_changes(Variant& v, const scene::Table& t);
    Sweep sweep(const scene::Table& t);

    std::string file_;
    std::filesystem::path folder_;
    Size size_;
    std::vector<scene::Problem> problems_;
};

}  // namespace weir::validation
