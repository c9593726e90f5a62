// From a file to a checked scene: text, tree, overrides, schema, rules; all problems found are reported together.
#include "scene/scene.hpp"

#include "core/words.hpp"
#include "scene/document.hpp"
#include "scene/names.hpp"
#include "scene/reader.hpp"
#include "scene/rules.hpp"
#include "scene/solver_kind.hpp"
#include "scene/steer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <iterator>

namespace weir::scene {
namespace {

std::string set_text(const Override& o) { return fmt::format("--set {}={}", o.key, o.value); }

/// Problems in overrides name the override instead of the file.
void name_overrides(std::vector<Problem>& problems, const std::vector<Override>& overrides) {
    for (Problem& p : problems)
        if (p.place.override_number >= 0) p.file = set_text(overrides[static_cast<std::size_t>(p.place.override_number)]);
}

const SolverSchema* chosen_solver(const Node& root, const std::string& file, const std::vector<SolverSchema>& solvers,
                                  std::vector<Problem>& problems) {
    const Member* member = root.member("solver");
    if (!member || member->value.kind != Node::Kind::text) return nullptr;  // missing, or not a text: the reader reports it
    std::vector<std::string> names;
    for (const SolverSchema& s : solvers) {
        if (s.name == member->value.text) return &s;
        if (!s.study) names.push_back(s.name);
    }
    problems.push_back({.file = file,
                        .place = member->value.place,
                        .message = fmt::format("unknown solver {}{}", quote(member->value.text), did_you_mean(member->value.text, names)),
                        .hint = known(names)});
    return nullptr;
}

/// 2 or 3; 0 where the scene's value is missing or invalid, which is reported.
int dimension(const Node& root, const std::string& file, const SolverSchema* solver, std::vector<Problem>& problems) {
    const Member* member = root.member("dim");
    if (!member || member->value.kind != Node::Kind::integer) return 0;
    const auto dim = member->value.integer;
    if (dim != 2 && dim != 3) return 0;
    if (solver && std::find(solver->dims.begin(), solver->dims.end(), dim) == solver->dims.end()) {
        problems.push_back({.file = file,
                            .place = member->value.place,
                            .message = fmt::format("solver \"{}\" works only with dim = {}", solver->name, fmt::join(solver->dims, ", "))});
    }
    return static_cast<int>(dim);
}

}  // namespace

namespace {

void one_cell_along_y(Table& root) {
    Table* grid = root.find_table("grid");
    if (!grid || !grid->has("cells")) return;
    auto cells = grid->numbers("cells");
    if (cells.size() > 1) cells[1] = 1;
    grid->set("cells", cells, grid->place("cells"));
}

}  // namespace

Scene parse(std::string_view source, const std::string& file, const std::vector<SolverSchema>& solvers,
            const std::vector<Override>& overrides) {
    Document document = parse_document(source, file);
    std::vector<Problem>& problems = document.problems;
    if (!document.readable) throw BadScene(problems, source);
    for (std::size_t i = 0; i < overrides.size(); ++i) apply_override(document.root, overrides[i], static_cast<int>(i), problems);

    Scene scene;
    const SolverSchema* solver = chosen_solver(document.root, file, solvers, problems);
    scene.dim_ = dimension(document.root, file, solver, problems);
    Reader reader(file, scene.dim_, document.complete, problems);
    reader.know(solvers, solver ? solver->name : "");
    const auto keys = keys_of(solver ? *solver : SolverSchema{});
    scene.root_ = reader.root(document.root, keys);
    if (solver && solver->columns) one_cell_along_y(scene.root_);
    check_rules(scene.root_, scene.dim_, file, problems);
    if (solver && problems.empty()) check_changes(scene.root_, scene.dim_, file, *solver, problems);
    name_overrides(problems, overrides);
    if (!problems.empty()) throw BadScene(problems, source);

    scene.file_ = file;
    scene.source_ = source;
    scene.solver_ = scene.root_.text("solver");
    scene.overrides_ = overrides;
    return scene;
}

Table parse_table(std::string_view source, const std::string& file, const std::vector<Key>& keys, int dim) {
    Document document = parse_document(source, file);
    if (!document.readable) throw BadScene(document.problems, source);
    Table table = Reader(file, dim, document.complete, document.problems).root(document.root, keys);
    if (!document.problems.empty()) throw BadScene(document.problems, source);
    return table;
}

std::string read_text(const std::filesystem::path& path) {
    const std::string name = path.string();
    std::error_code failed;
    if (!std::filesystem::exists(path, failed))
        throw BadInput(failed ? fmt::format("{}: cannot be read: {}", name, failed.message())
                              : fmt::format("{}: there is no such file", name));
    const std::string text = first_bytes_of(path, max_source_bytes + 1);  // one byte more, to detect that it is too long
    if (text.empty()) throw BadInput(fmt::format("{}: the file is empty", name));
    return text;
}

Scene read(const std::filesystem::path& path, const std::vector<SolverSchema>& solvers, const std::vector<Override>& overrides) {
    std::error_code ignored;
    auto file = path;
    if (std::filesystem::is_directory(path, ignored)) {
        file = path / "scene.toml";
        if (!std::filesystem::exists(file, ignored)) throw BadInput(fmt::format("{}: this folder has no scene.toml", path.string()));
    }
    return parse(read_text(file), file.string(), solvers, overrides);
}

const Table* Scene::effect(std::string_view name) const {
    const Value* effects = root_.find("effects");
    const Value* found = effects ? std::get<Table>(*effects).find(name) : nullptr;
    if (!found) return nullptr;
    std::get<Table>(*effects).mark_read(name);
    return &std::get<Table>(*found);
}

Scene Scene::steered(const Override& change, const std::vector<SolverSchema>& solvers) const {
    const auto own = std::find_if(solvers.begin(), solvers.end(), [&](const SolverSchema& s) { return s.name == solver_; });
    Scene other = *this;
    other.overrides_.push_back(change);
    std::vector<Problem> problems;
    steer(other.root_, dim_, *own, change, static_cast<int>(overrides_.size()), problems);
    name_overrides(problems, other.overrides_);
    if (!problems.empty()) throw BadScene(std::move(problems), source_);
    return other;
}

Scene Scene::without_effect(std::string_view name) const {
    Scene other = *this;
    if (Table* effects = other.root_.find_table("effects")) effects->erase(name);
    return other;
}

namespace {

/// Returns whether the number, or any entry of the list, is nonzero; false for an absent key.
bool acts(const Table& table, const std::string& key) {
    const Value* value = table.find(key);
    if (!value) return false;
    if (const auto* list = std::get_if<std::vector<double>>(value))
        return std::any_of(list->begin(), list->end(), [](double v) { return v != 0; });
    return table.number(key) != 0;
}

/// Returns whether the scene has the key that accompanies the effect. Without it, the effect may replace something built into a scheme, and
/// zero strength disables that.
bool says(const Scene& scene, const std::string& along_with) {
    const auto equals = along_with.find(" = ");
    if (equals == std::string::npos) return true;
    const Value* value = scene.root().find(along_with.substr(0, equals));
    const std::string wanted = along_with.substr(equals + 3);
    if (const auto* text = value ? std::get_if<std::string>(value) : nullptr) return quote(*text) == wanted;
    const auto* flag = value ? std::get_if<bool>(value) : nullptr;
    return flag && wanted == (*flag ? "true" : "false");
}

}  // namespace

std::vector<SolverSchema> schemas_of(const std::vector<SolverKind>& kinds) {
    std::vector<SolverSchema> list;
    for (const auto& kind : kinds) list.push_back(kind.schema);
    return list;
}

std::vector<std::string> idle_effects(const Scene& scene, const SolverSchema& schema) {
    std::vector<std::string> idle;
    for (const Variant& effect : schema.effects) {
        const Table* table = scene.effect(effect.name);
        const auto& keys = effect.strength;
        const auto acts_by = [&](const std::string& key) {
            return key.find('.') == std::string::npos ? acts(*table, key) : acts(scene.root(), key);
        };
        if (table && says(scene, effect.along_with) && !keys.empty() && std::none_of(keys.begin(), keys.end(), acts_by))
            idle.push_back(effect.name);
    }
    return idle;
}

Problem Scene::problem(std::string_view path, const std::string& message, const std::string& hint) const {
    Place place = root_.place(path);
    std::string_view around = path;
    while (place.column == 0 && around.find_last_of(".[") != std::string_view::npos) {
        around = around.substr(0, around.find_last_of(".["));
        place = root_.place(around);
    }
    Problem p{.file = file_, .place = place, .width = around == path ? 0 : 1, .message = message, .hint = hint};
    if (place.override_number >= 0) p.file = set_text(overrides_[static_cast<std::size_t>(place.override_number)]);
    return p;
}

void Scene::refuse(std::string_view path, const std::string& message, const std::string& hint) const {
    refuse({problem(path, message, hint)});
}

void Scene::refuse(std::vector<Problem> problems) const { throw BadScene(std::move(problems), source_); }

}  // namespace weir::scene
