#include "validation/cost/study.hpp"

#include "validation/harness/variants.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace weir::validation {
namespace {

using scene::Key;
using scene::Type;

std::vector<Key> keys_of_studies() {
    std::vector<Key> method = variant_keys();
    method.insert(method.begin(), {.name = "name", .type = Type::text, .doc = "Its name in tables and plots.", .required = true});
    method.insert(method.begin() + 1,
                  {.name = "size", .type = Type::choice, .doc = "Run only at this size; absent: at both.", .choices = {"ci", "full"}});
    method.insert(method.begin() + 2,
                  {.name = "threads", .type = Type::integer, .doc = "Its own number of threads; 0: all that the machine has.", .min = 0});
    std::vector<Key> keys = {
        {.name = "question", .type = Type::text, .doc = "Question of the study.", .required = true},
        {.name = "error", .type = Type::text, .doc = "The metric that is the error.", .required = true},
        {.name = "also", .type = Type::texts, .doc = "Further metrics for the table."},
        {.name = "good_enough", .type = Type::number, .doc = "The error at which methods are compared.", .min = 0, .min_open = true},
        {.name = "why", .type = Type::text, .doc = "Rationale of that error."},
        {.name = "known_to", .type = Type::number, .doc = "Uncertainty of the reference.", .min = 0, .min_open = true},
        {.name = "known_why", .type = Type::text, .doc = "Rationale."},
        {.name = "diverged_above", .type = Type::number, .doc = "An error beyond which a run has diverged.", .min = 0, .min_open = true},
        {.name = "diverged_why", .type = Type::text, .doc = "Rationale."},
        {.name = "price",
         .type = Type::choice,
         .doc = "Cost per simulated second, or per step.",
         .fallback = "second",
         .choices = {"second", "step"}},
        {.name = "methods", .type = Type::tables, .doc = "The methods compared; keys of the study apply to all.", .keys = method},
        {.name = "over",
         .type = Type::table,
         .doc = "One method for each value of a key of the scene, named by the value.",
         .keys = {{.name = "key", .type = Type::text, .doc = "The key.", .required = true},
                  {.name = "values", .type = Type::texts, .doc = "Its values at full size.", .required = true},
                  {.name = "ci", .type = Type::texts, .doc = "Its values at ci size; absent: the same."}}}};
    for (const Key& k : variant_keys()) keys.push_back(k);
    return keys;
}

/// A case as a study: its variants, each with the error that it claims most about.
Study study_of(const Case& c) {
    Study study{.name = c.name, .folder = c.folder, .question = c.question, .error = {}, .size = c.size, .methods = c.variants};
    for (const Variant& v : c.variants)
        for (const Criterion& claim : v.accept) {
            if (claim.is_monotone()) continue;
            if (study.error.empty()) study.error = claim.metric;
            const bool known = claim.metric == study.error || std::count(study.also.begin(), study.also.end(), claim.metric) > 0;
            if (!known) study.also.push_back(claim.metric);
        }
    if (study.error.empty()) throw BadInput(c.name + ": the case measures no error that could be compared with computing time");
    return study;
}

}  // namespace

const std::vector<Key>& study_keys() {
    static const std::vector<Key> keys = keys_of_studies();
    return keys;
}

Study parse_study(std::string_view text, const std::string& file, const std::filesystem::path& folder, Size size) {
    const scene::Table root = scene::parse_table(text, file, study_keys());
    VariantReader reader(file, folder, size);
    Study study{.name = folder.filename().string(),
                .folder = folder,
                .question = reader.said(root, "question"),
                .error = reader.said(root, "error"),
                .good_enough = root.number_or("good_enough", 0),
                .why = root.text_or("why", ""),
                .known_to = root.number_or("known_to", 0),
                .known_why = root.text_or("known_why", ""),
                .diverged_above = root.number_or("diverged_above", infinity),
                .diverged_why = root.text_or("diverged_why", ""),
                .price = root.text("price") == "step" ? Price::step : Price::second,
                .size = size};
    if (root.has("also")) study.also = root.texts("also");
    for (const auto& [bound, why] : {std::pair{"good_enough", "why"}, {"known_to", "known_why"}, {"diverged_above", "diverged_why"}})
        if (root.has(bound) && root.text_or(why, "").empty())
            reader.problem(root.place(bound), fmt::format("\"{}\" needs a \"{}\"", bound, why));
    if (study.good_enough > 0 && study.good_enough < study.known_to)
        reader.problem(root.place("good_enough"),
                       "\"good_enough\" is below \"known_to\", the uncertainty of the reference: raise good_enough");
    study.methods = reader.read(root, "methods", [](Variant& v, const scene::Table& t) {
        if (t.has("threads")) v.threads = static_cast<int>(t.integer("threads"));
    });
    if (!reader.problems().empty()) throw scene::BadScene(reader.problems(), text);
    return study;
}

Study read_study(const std::filesystem::path& folder, Size size) {
    const auto file = folder / "cost.toml";
    if (!std::filesystem::exists(file)) return study_of(read_case(folder, size));
    return parse_study(scene::read_text(file), file.string(), folder, size);
}

Study study_of_row(const Study& study, const std::string& method, std::size_t index) {
    Study one = study;
    std::erase_if(one.methods, [&](const Variant& v) { return v.name != method || index >= v.runs(); });
    if (one.methods.empty() || !one.methods.front().sweep) return one;
    Sweep& sweep = *one.methods.front().sweep;
    const auto only = [index](std::vector<real>& values) { values = {values.at(index)}; };
    only(sweep.values);
    for (auto& follower : sweep.also) only(follower.values);
    return one;
}

std::vector<std::filesystem::path> find_studies(const std::filesystem::path& root) {
    std::vector<std::filesystem::path> found;
    std::error_code unreadable;
    for (const auto& entry : std::filesystem::directory_iterator(root, unreadable))
        if (std::filesystem::exists(entry.path() / "cost.toml")) found.push_back(entry.path());
    std::sort(found.begin(), found.end());
    return found;
}

}  // namespace weir::validation
