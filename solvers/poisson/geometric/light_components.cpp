#include "poisson/geometric/light_components.hpp"

#include <algorithm>
#include <limits>

namespace weir::poisson {

namespace {

/// Light cells that follow each other in a row.
template <int D>
struct Run {
    Index<D> first;
    std::size_t begin;  // the first cell
    int count;
    std::size_t end() const { return begin + static_cast<std::size_t>(count); }
    Index<D> last() const {
        Index<D> I = first;
        I[0] += count - 1;
        return I;
    }
};

/// The runs in order, each with its parent in union-find: a root is the first run of its component.
template <int D>
class Runs {
public:
    /// `of`: −1 everywhere; gets the number of each light cell's run.
    Runs(const Grid<std::uint8_t, D>& light, const std::array<bool, D>& periodic, std::vector<int>& of)
        : light_(light), periodic_(periodic), of_(of) {
        Index<D> row{};
        const auto n = static_cast<std::size_t>(light.extent()[0]);
        for (std::size_t begin = 0; begin < light.size(); begin += n) {
            find_in_row(row, begin);
            for (int a = 1; a < D && ++row[a] == light.extent()[a]; ++a)
                if (a + 1 < D) row[a] = 0;
        }
    }
    int root(int i) {
        while (parent(i) != i) i = parent(i) = parent(parent(i));
        return i;
    }
    const std::vector<Run<D>>& list() const { return list_; }

private:
    void find_in_row(Index<D> row, std::size_t begin) {
        const int n = light_.extent()[0];
        const std::uint8_t* values = light_.data() + begin;
        for (int from = 0, to = 0; from < n; from = to + 1) {
            from = static_cast<int>(std::find(values + from, values + n, 1) - values);
            to = static_cast<int>(std::find(values + from, values + n, 0) - values);
            row[0] = from;
            if (from < to) add({row, begin + static_cast<std::size_t>(from), to - from});
        }
    }
    void add(const Run<D>& run) {
        const int number = static_cast<int>(list_.size());
        list_.push_back(run);
        parent_.push_back(number);
        std::fill_n(of_.begin() + static_cast<std::ptrdiff_t>(run.begin), run.count, number);
        const int n = light_.extent()[0];
        if (periodic_[0] && run.last()[0] == n - 1) join(number, of_[run.begin - static_cast<std::size_t>(run.first[0])]);
        for (int a = 1; a < D; ++a) {
            const auto stride = static_cast<std::size_t>(light_.stride(a));
            const int last = light_.extent()[a] - 1;
            if (run.first[a] > 0) join_row(number, run.begin - stride);
            if (periodic_[static_cast<std::size_t>(a)] && run.first[a] == last)
                join_row(number, run.begin - static_cast<std::size_t>(last) * stride);
        }
    }
    /// With the light ones of the cells from `at` on, beside the run.
    void join_row(int run, std::size_t at) {
        const std::size_t end = at + static_cast<std::size_t>(list_[static_cast<std::size_t>(run)].count);
        while (at < end) {
            const int other = of_[at];
            join(run, other);
            at = other < 0 ? at + 1 : list_[static_cast<std::size_t>(other)].end();
        }
    }
    void join(int run, int other) {
        if (other < 0) return;
        const int a = root(run), b = root(other);
        parent(std::max(a, b)) = std::min(a, b);
    }
    int& parent(int i) { return parent_[static_cast<std::size_t>(i)]; }

    const Grid<std::uint8_t, D>& light_;
    const std::array<bool, D>& periodic_;
    std::vector<int>& of_;
    std::vector<Run<D>> list_;
    std::vector<int> parent_;
};

template <int D>
struct Box {
    Index<D> low = Index<D>::constant(std::numeric_limits<int>::max()), high = Index<D>::constant(-1);
    void add(const Index<D>& I) {
        for (int a = 0; a < D; ++a) low[a] = std::min(low[a], I[a]), high[a] = std::max(high[a], I[a]);
    }
    int largest_side() const {
        int side = 0;
        for (int a = 0; a < D; ++a) side = std::max(side, high[a] - low[a] + 1);
        return side;
    }
};

}  // namespace

template <int D>
void find_light_components(const Grid<std::uint8_t, D>& light, const std::array<bool, D>& periodic, LightComponents& found) {
    found.of.assign(light.size(), -1);
    Runs<D> runs(light, periodic, found.of);
    std::vector<Box<D>> boxes;
    std::vector<int> component;
    for (const Run<D>& run : runs.list()) {
        const int number = static_cast<int>(component.size()), root = runs.root(number);
        if (root == number) boxes.emplace_back();
        component.push_back(root == number ? static_cast<int>(boxes.size()) - 1 : component[static_cast<std::size_t>(root)]);
        std::fill_n(found.of.begin() + static_cast<std::ptrdiff_t>(run.begin), run.count, component.back());
        Box<D>& box = boxes[static_cast<std::size_t>(component.back())];
        box.add(run.first), box.add(run.last());
    }
    found.extent.clear();
    for (const Box<D>& box : boxes) found.extent.push_back(box.largest_side());
}

template void find_light_components<2>(const Grid<std::uint8_t, 2>&, const std::array<bool, 2>&, LightComponents&);
template void find_light_components<3>(const Grid<std::uint8_t, 3>&, const std::array<bool, 3>&, LightComponents&);

}  // namespace weir::poisson
