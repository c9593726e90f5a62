#include "particles/reference/neighbours.hpp"

#include <algorithm>
#include <stdexcept>

namespace weir::particles {

namespace {

real square_distance(const Coordinates& x, int i, int j) {
    real sum = 0;
    for (const real* axis : x)
        if (axis) sum += (axis[i] - axis[j]) * (axis[i] - axis[j]);
    return sum;
}

/// Collects lists chunk by chunk: candidates(i, visit) calls visit(j) for every particle that may be near i.
class Collector {
public:
    template <class Candidates>
    const NeighbourLists& collect(const Coordinates& x, int count, real radius, Candidates&& candidates) {
        parts_.resize(static_cast<std::size_t>(threads()));
        lists_.start.assign(static_cast<std::size_t>(count) + 1, 0);
        for_chunks(count, [&](int t, int begin, int end) {
            auto& part = parts_[static_cast<std::size_t>(t)];
            part.clear();
            for (int i = begin; i < end; ++i) {
                const auto first = static_cast<std::ptrdiff_t>(part.size());
                candidates(i, [&](int j) {
                    if (j != i && square_distance(x, i, j) < radius * radius) part.push_back(j);
                });
                std::sort(part.begin() + first, part.end());
                lists_.start[static_cast<std::size_t>(i) + 1] = part.size() - static_cast<std::size_t>(first);
            }
        });
        for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) lists_.start[i + 1] += lists_.start[i];
        lists_.index.clear();
        for (const auto& part : parts_) lists_.index.insert(lists_.index.end(), part.begin(), part.end());
        return lists_;
    }

private:
    NeighbourLists lists_;
    std::vector<std::vector<int>> parts_;
};

class BruteForce final : public NeighbourSearch {
public:
    const NeighbourLists& find(const Coordinates& x, int count, real radius) override {
        return collector_.collect(x, count, radius, [&](int, auto&& visit) {
            for (int j = 0; j < count; ++j) visit(j);
        });
    }

private:
    Collector collector_;
};

/// The cells around the one at `cell`, clipped: f(c) for each.
template <class F>
void around(const std::array<int, 3>& n, int cell, F&& f) {
    const int cx = cell % n[0], cy = cell / n[0] % n[1], cz = cell / (n[0] * n[1]);
    for (int z = std::max(cz - 1, 0); z <= std::min(cz + 1, n[2] - 1); ++z)
        for (int y = std::max(cy - 1, 0); y <= std::min(cy + 1, n[1] - 1); ++y)
            for (int c = std::max(cx - 1, 0); c <= std::min(cx + 1, n[0] - 1); ++c) f((z * n[1] + y) * n[0] + c);
}

/// One growing list per cell, filled in the order of the particles; the cells are those of the sorted grid.
class UniformGrid final : public NeighbourSearch {
public:
    const NeighbourLists& find(const Coordinates& x, int count, real radius) override {
        cover_.cover(cover_box(cover_.box(x, count), count, radius * (1 + 1e-12)));
        const auto& n = cover_.cells();
        for (auto& list : members_) list.clear();
        members_.resize(static_cast<std::size_t>(n[0]) * static_cast<std::size_t>(n[1]) * static_cast<std::size_t>(n[2]));
        for (int i = 0; i < count; ++i) members_[static_cast<std::size_t>(cover_.cell(x, i))].push_back(i);
        return collector_.collect(x, count, radius, [&](int i, auto&& visit) {
            around(n, cover_.cell(x, i), [&](int c) {
                for (const int j : members_[static_cast<std::size_t>(c)]) visit(j);
            });
        });
    }

private:
    CellSort cover_;
    std::vector<std::vector<int>> members_;
    Collector collector_;
};

class SortedGrid final : public NeighbourSearch {
public:
    const NeighbourLists& find(const Coordinates& x, int count, real radius) override {
        sort_.sort(x, count, radius * (1 + 1e-12));
        return collector_.collect(x, count, radius, [&](int i, auto&& visit) {
            around(sort_.cells(), sort_.cell(x, i), [&](int c) {
                const auto at = static_cast<std::size_t>(c);
                for (int k = sort_.start()[at]; k < sort_.start()[at + 1]; ++k) visit(sort_.order()[static_cast<std::size_t>(k)]);
            });
        });
    }

private:
    CellSort sort_;
    Collector collector_;
};

}  // namespace

const std::vector<std::string>& neighbour_methods() {
    static const std::vector<std::string> names{"brute_force", "grid", "sorted_grid"};
    return names;
}

std::unique_ptr<NeighbourSearch> make_neighbour_search(const std::string& method) {
    if (method == "brute_force") return std::make_unique<BruteForce>();
    if (method == "grid") return std::make_unique<UniformGrid>();
    if (method == "sorted_grid") return std::make_unique<SortedGrid>();
    throw std::logic_error("no neighbour search \"" + method + "\"");
}

}  // namespace weir::particles
