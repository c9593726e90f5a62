#include "poisson/geometric/light_components.hpp"

#include <algorithm>
#include <limits>

namespace weir::poisson {

namespace {

/// Union-find; a root is the smallest index of its component.
class Roots {
public:
    explicit Roots(std::vector<int>& parent) : parent_(parent) {}
    int root(int i) {
        while (at(i) != i) i = at(i) = at(at(i));
        return i;
    }
    void join(int i, int j) {
        const int a = root(i), b = root(j);
        at(std::max(a, b)) = std::min(a, b);
    }

private:
    int& at(int i) { return parent_[static_cast<std::size_t>(i)]; }
    std::vector<int>& parent_;
};

/// f(cell, I) for all light cells in order.
template <int D, class F>
void for_each_light(const Grid<std::uint8_t, D>& light, F&& f) {
    Index<D> I{};
    for (std::size_t cell = 0; cell < light.size(); ++cell) {
        if (light[cell] != 0) f(static_cast<int>(cell), I);
        for (int a = 0; a < D && ++I[a] == light.extent()[a]; ++a)
            if (a + 1 < D) I[a] = 0;
    }
}

/// The parent of each light cell, a smaller or equal index; not set elsewhere.
template <int D>
void join_neighbours(const Grid<std::uint8_t, D>& light, const std::array<bool, D>& periodic, std::vector<int>& parent) {
    Roots roots(parent);
    for_each_light<D>(light, [&](int cell, const Index<D>& I) {
        parent[static_cast<std::size_t>(cell)] = cell;
        for (int a = 0; a < D; ++a) {
            const int stride = static_cast<int>(light.stride(a)), last = light.extent()[a] - 1;
            if (I[a] > 0 && light[static_cast<std::size_t>(cell - stride)] != 0) roots.join(cell, cell - stride);
            const int around = cell - last * stride;
            if (periodic[static_cast<std::size_t>(a)] && last > 0 && I[a] == last && light[static_cast<std::size_t>(around)] != 0)
                roots.join(cell, around);
        }
    });
}

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
    std::vector<int>& parent = found.of;
    join_neighbours<D>(light, periodic, parent);
    std::vector<Box<D>> boxes;
    Roots roots(parent);
    std::vector<int> number(light.size());  // of roots; a root comes before the other cells of its component
    for_each_light<D>(light, [&](int cell, const Index<D>& I) {
        const int root = roots.root(cell);
        int& own = number[static_cast<std::size_t>(root)];
        if (root == cell) own = static_cast<int>(boxes.size()), boxes.emplace_back();
        boxes[static_cast<std::size_t>(own)].add(I);
    });
    for_each_light<D>(light, [&](int cell, const Index<D>&) {  // after the last use of the parents: a root is found within one step
        number[static_cast<std::size_t>(cell)] = number[static_cast<std::size_t>(roots.root(cell))];
    });
    for (std::size_t cell = 0; cell < light.size(); ++cell)
        if (light[cell] != 0) found.of[cell] = number[cell];
    found.extent.clear();
    for (const Box<D>& box : boxes) found.extent.push_back(box.largest_side());
}

template void find_light_components<2>(const Grid<std::uint8_t, 2>&, const std::array<bool, 2>&, LightComponents&);
template void find_light_components<3>(const Grid<std::uint8_t, 3>&, const std::array<bool, 3>&, LightComponents&);

}  // namespace weir::poisson
