// Neighbour search by three interchangeable methods, in double precision: brute force with cached lists; a uniform grid with a list per
// cell; a sort-based grid (Green 2010). All give the same lists and differ only in time (benchmarks/particles). The solvers' fast path is
// the third one with lists for SIMD lanes (pairs.hpp).
#pragma once
#include "particles/threads/cell_sort.hpp"

#include <memory>
#include <string>
#include <vector>

namespace weir::particles {

/// neighbours of i: index[start[i]] .. index[start[i + 1] - 1], ascending, without i itself.
struct NeighbourLists {
    std::vector<std::size_t> start;
    std::vector<int> index;
};

class NeighbourSearch {
public:
    virtual ~NeighbourSearch() = default;
    /// Finds every pair closer than the radius.
    virtual const NeighbourLists& find(const Coordinates& x, int count, real radius) = 0;
};

/// brute_force, grid, sorted_grid.
const std::vector<std::string>& neighbour_methods();
std::unique_ptr<NeighbourSearch> make_neighbour_search(const std::string& method);

}  // namespace weir::particles
