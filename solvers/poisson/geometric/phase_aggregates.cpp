#include "poisson/geometric/phase_aggregates.hpp"

#include <algorithm>

namespace weir::poisson {

namespace {

template <int D>
Index<D> index_of(int box, const Index<D>& boxes) {
    Index<D> I;
    for (int a = 0; a < D; ++a) I[a] = box % boxes[a], box /= boxes[a];
    return I;
}

/// Finds or makes the aggregate of a key: a box and a component. The aggregates of one box are a linked list.
class Finder {
public:
    Finder(std::size_t boxes, std::size_t components) : first_(boxes, -1), whole_(components, -1) {}
    int of_box(int box, int component) {
        for (int k = at(first_, box); k >= 0; k = at(next_, k))
            if (at(component_, k) == component) return k;
        next_.push_back(at(first_, box));
        return at(first_, box) = make(box, component, false);
    }
    int of_whole(int box, int component) {
        int& k = at(whole_, component);
        if (k < 0) next_.push_back(-1), k = make(box, component, true);
        return k;
    }
    int count() const { return static_cast<int>(box_.size()); }
    int box(int k) const { return box_[static_cast<std::size_t>(k)]; }
    int component(int k) const { return component_[static_cast<std::size_t>(k)]; }
    bool is_whole(int k) const { return is_whole_[static_cast<std::size_t>(k)] != 0; }

private:
    static int& at(std::vector<int>& v, int i) { return v[static_cast<std::size_t>(i)]; }
    int make(int box, int component, bool whole) {
        box_.push_back(box), component_.push_back(component), is_whole_.push_back(whole);
        return count() - 1;
    }
    std::vector<int> first_, whole_, next_, box_, component_;
    std::vector<char> is_whole_;
};

/// New numbers by colour.
template <int D>
std::vector<int> numbers_by_colour(const Finder& found, const Index<D>& boxes) {
    const auto colour = [&](int k) -> std::size_t {
        if (found.is_whole(k)) return 2;
        const Index<D> I = index_of<D>(found.box(k), boxes);
        int sum = 0;
        for (int a = 0; a < D; ++a) sum += I[a];
        return static_cast<std::size_t>(sum & 1);
    };
    std::array<int, 4> first{};
    for (int k = 0; k < found.count(); ++k) ++first[colour(k) + 1];
    for (std::size_t c = 1; c < 4; ++c) first[c] += first[c - 1];
    std::vector<int> number(static_cast<std::size_t>(found.count()));
    for (int k = 0; k < found.count(); ++k) number[static_cast<std::size_t>(k)] = first[colour(k)]++;
    return number;
}

}  // namespace

template <int D>
PhaseUnknowns<D> unknown_cells(const Natural<D>& problem, const LightComponents& light) {
    constexpr auto fluid = static_cast<std::uint8_t>(Cell::fluid);
    PhaseUnknowns<D> cells;
    cells.boxes = problem.extent();
    cells.component = light.of;
    const int n = cells.boxes[0], rows = problem.planes() * problem.rows_in_plane();
    cells.box.assign(light.of.size(), -1);
    for (int row = 0; row < rows; ++row)
        for (int i = 0; i < n; ++i)
            if (problem.cells(row)[i] == fluid) cells.box[static_cast<std::size_t>(row * n + i)] = row * n + i;
    return cells;
}

template <int D>
Aggregation join_by_phase(const PhaseUnknowns<D>& fine, const std::array<bool, D>& halved, const LightComponents& light,
                          PhaseUnknowns<D>& coarse) {
    coarse.width = 2 * fine.width;
    for (int a = 0; a < D; ++a) coarse.boxes[a] = halved[static_cast<std::size_t>(a)] ? (fine.boxes[a] + 1) / 2 : fine.boxes[a];
    Finder found(product(coarse.boxes), light.extent.size());
    Aggregation groups;
    groups.of.assign(fine.box.size(), -1);
    for (std::size_t i = 0; i < fine.box.size(); ++i) {
        if (fine.box[i] < 0) continue;
        const Index<D> I = index_of<D>(fine.box[i], fine.boxes);
        int box = 0;
        for (int a = D - 1; a >= 0; --a) box = box * coarse.boxes[a] + (halved[static_cast<std::size_t>(a)] ? I[a] / 2 : I[a]);
        const int c = fine.component[i];
        const bool whole = c >= 0 && light.extent[static_cast<std::size_t>(c)] <= 2 * coarse.width;
        groups.of[i] = whole ? found.of_whole(box, c) : found.of_box(box, c);
    }
    groups.count = found.count();
    const std::vector<int> number = numbers_by_colour<D>(found, coarse.boxes);
    for (int& k : groups.of) k = k < 0 ? k : number[static_cast<std::size_t>(k)];
    coarse.box.assign(number.size(), 0), coarse.component.assign(number.size(), -1);
    for (int k = 0; k < groups.count; ++k) {
        const auto at = static_cast<std::size_t>(number[static_cast<std::size_t>(k)]);
        coarse.box[at] = found.box(k), coarse.component[at] = found.component(k);
    }
    return groups;
}

template PhaseUnknowns<2> unknown_cells<2>(const Natural<2>&, const LightComponents&);
template PhaseUnknowns<3> unknown_cells<3>(const Natural<3>&, const LightComponents&);
template Aggregation join_by_phase<2>(const PhaseUnknowns<2>&, const std::array<bool, 2>&, const LightComponents&, PhaseUnknowns<2>&);
template Aggregation join_by_phase<3>(const PhaseUnknowns<3>&, const std::array<bool, 3>&, const LightComponents&, PhaseUnknowns<3>&);

}  // namespace weir::poisson
