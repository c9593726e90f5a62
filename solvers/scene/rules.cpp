#include "scene/rules.hpp"

#include "scene/names.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace weir::scene {
namespace {

class Rules {
public:
    Rules(Table& root, int dim, const std::string& file, std::vector<Problem>& problems)
        : root_(root), dim_(dim), file_(file), problems_(problems) {}

    void periodic_axes() {
        std::vector<std::string> both;
        for (int axis = 0; axis < dim_; ++axis) {
            const std::string name = axis_name(axis);
            const bool listed = contains(listed_axes(), name);
            std::array<bool, 2> side{};
            for (int end = 0; end < 2; ++end) side[static_cast<std::size_t>(end)] = kind(axis, end) == "periodic";
            if (side[0] != side[1] && !listed) one_end(axis, side[0] ? 0 : 1);
            if (listed) make_sides_periodic(axis);
            if (listed || (side[0] && side[1])) both.push_back(name);
        }
        if (auto* grid = root_.find_table("grid")) grid->set("periodic", both, grid->place("periodic"));
    }

    void open_is_outflow() {
        for (int axis = 0; axis < dim_; ++axis)
            for (int end = 0; end < 2; ++end)
                if (Table* side = root_.find_table(side_path(axis, end)); side && kind(axis, end) == "open")
                    side->set("kind", std::string("outflow"), side->place("kind"));
    }

private:
    static std::string axis_name(int axis) { return std::string(1, "xyz"[axis]); }
    static std::string side_path(int axis, int end) { return fmt::format("sides.{}_{}", axis_name(axis), end ? "max" : "min"); }
    static bool contains(const std::vector<std::string>& list, const std::string& name) {
        return std::find(list.begin(), list.end(), name) != list.end();
    }
    std::string kind(int axis, int end) const { return root_.text_or(side_path(axis, end) + ".kind", ""); }
    std::vector<std::string> listed_axes() const {
        return root_.has("grid.periodic") ? root_.texts("grid.periodic") : std::vector<std::string>{};
    }

    void report(const std::string& path, std::string message, std::string hint = "") {
        problems_.push_back({.file = file_, .place = root_.place(path), .message = std::move(message), .hint = std::move(hint)});
    }

    void one_end(int axis, int end) {
        const auto other = side_path(axis, 1 - end);
        report(side_path(axis, end) + ".kind",
               fmt::format("{} is periodic, but {} is {}", side_path(axis, end), other, quote(kind(axis, 1 - end))),
               "both ends of an axis are periodic, or neither");
    }

    /// `grid.periodic` names the axis: its sides may say so too, but nothing else.
    void make_sides_periodic(int axis) {
        for (int end = 0; end < 2; ++end) {
            Table* side = root_.find_table(side_path(axis, end));
            if (!side || kind(axis, end) == "periodic") continue;
            if (root_.place(side_path(axis, end)).column > 0) {
                report(side_path(axis, end), fmt::format("{} is {}, but grid.periodic names {}", side_path(axis, end),
                                                         quote(kind(axis, end)), quote(axis_name(axis))));
                continue;
            }
            Table periodic;
            periodic.set("kind", std::string("periodic"));
            *side = periodic;
        }
    }

    Table& root_;
    int dim_;
    const std::string& file_;
    std::vector<Problem>& problems_;
};

}  // namespace

void check_rules(Table& root, int dim, const std::string& file, std::vector<Problem>& problems) {
    Rules rules(root, dim, file, problems);
    rules.periodic_axes();
    rules.open_is_outflow();
}

}  // namespace weir::scene
