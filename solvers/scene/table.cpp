// Look-ups by path in a checked table. A miss is a programming error, not an error in the scene.
#include "scene/scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <charconv>
#include <stdexcept>

namespace weir::scene {
namespace {

/// "solids[0].centre" is split into "solids", 0, "centre".
struct Step {
    std::string_view key;
    int index = -1;  // into a list of tables
};

Step first_step(std::string_view& path) {
    Step step{path.substr(0, path.find_first_of(".[")), -1};
    path.remove_prefix(step.key.size());
    if (path.starts_with('[')) {
        const auto close = std::min(path.find(']'), path.size());
        std::from_chars(path.data() + 1, path.data() + close, step.index);
        path.remove_prefix(std::min(close + 1, path.size()));
    }
    if (path.starts_with('.')) path.remove_prefix(1);
    return step;
}

template <class T>
const T& get(const Table& table, std::string_view path, const char* type) {
    const Value* value = table.find(path);
    if (!value) throw std::logic_error(fmt::format("the scene has no key \"{}\"", path));
    const T* typed = std::get_if<T>(value);
    if (!typed) throw std::logic_error(fmt::format("the scene's key \"{}\" is not {}", path, type));
    table.mark_read(path);
    return *typed;
}

}  // namespace

const Table::Entry* Table::entry(std::string_view path) const {
    const Step step = first_step(path);
    const auto found = std::find_if(entries_.begin(), entries_.end(), [&](const Entry& e) { return e.key == step.key; });
    if (found == entries_.end()) return nullptr;
    const auto* list = std::get_if<std::vector<Table>>(&found->value);
    if (path.empty() && (step.index < 0 || !list)) return &*found;
    if (const auto* table = std::get_if<Table>(&found->value)) return step.index < 0 ? table->entry(path) : nullptr;
    if (!list || step.index < 0 || step.index >= static_cast<int>(list->size()) || path.empty()) return nullptr;
    return (*list)[static_cast<std::size_t>(step.index)].entry(path);
}

const Value* Table::find(std::string_view path) const {
    const Entry* e = entry(path);
    return e ? &e->value : nullptr;
}

Table* Table::find_table(std::string_view path) {
    const Value* value = find(path);
    return value ? const_cast<Table*>(std::get_if<Table>(value)) : nullptr;
}

void Table::erase(std::string_view key) {
    std::erase_if(entries_, [&](const Entry& e) { return e.key == key; });
}

std::filesystem::path Table::file(std::string_view path) const {
    const std::filesystem::path file = text(path);
    return file.is_absolute() || !folder_ ? file : *folder_ / file;
}

bool Table::has(std::string_view path) const { return find(path) != nullptr; }
bool Table::flag(std::string_view path) const { return get<bool>(*this, path, "true or false"); }
std::int64_t Table::integer(std::string_view path) const { return get<std::int64_t>(*this, path, "an integer"); }

real Table::number(std::string_view path) const {
    const Value* value = find(path);
    if (value && std::holds_alternative<std::int64_t>(*value)) return static_cast<real>(integer(path));
    return get<double>(*this, path, "a number");
}

const std::string& Table::text(std::string_view path) const { return get<std::string>(*this, path, "a text"); }
const std::vector<double>& Table::numbers(std::string_view path) const {
    return get<std::vector<double>>(*this, path, "a list of numbers");
}
const std::vector<std::string>& Table::texts(std::string_view path) const {
    return get<std::vector<std::string>>(*this, path, "a list of texts");
}
const Table& Table::table(std::string_view path) const { return get<Table>(*this, path, "a table"); }

const std::vector<Table>& Table::tables(std::string_view path) const {
    static const std::vector<Table> none;
    return has(path) ? get<std::vector<Table>>(*this, path, "a list of tables") : none;
}

bool Table::was_read(std::string_view path) const {
    const Entry* e = entry(path);
    return e && std::atomic_ref(e->read).load(std::memory_order_relaxed);
}

void Table::mark_read(std::string_view path) const {
    if (const Entry* e = entry(path)) std::atomic_ref(e->read).store(true, std::memory_order_relaxed);
}

void Table::forget_reading() {
    for (Entry& e : entries_) {
        e.read = false;
        if (auto* table = std::get_if<Table>(&e.value)) table->forget_reading();
        if (auto* list = std::get_if<std::vector<Table>>(&e.value))
            for (Table& t : *list) t.forget_reading();
    }
}

Place Table::place(std::string_view path) const {
    const Entry* e = entry(path);
    return e ? e->place : Place{};
}

std::vector<std::string> Table::keys() const {
    std::vector<std::string> names;
    for (const Entry& e : entries_) names.push_back(e.key);
    return names;
}

void Table::set(const std::string& key, Value value, Place place) {
    for (Entry& e : entries_)
        if (e.key == key) {
            e.value = std::move(value), e.place = place;
            return;
        }
    entries_.push_back({key, std::move(value), place});
}

}  // namespace weir::scene
