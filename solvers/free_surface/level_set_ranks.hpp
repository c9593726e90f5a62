// Data that several ranks share of a level set: the skin of solids.
#pragma once
#include "core/parallel.hpp"
#include "free_surface/frame.hpp"
#include "parallel/grid.hpp"

#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace weir::free_surface {

/// f(J) for the neighbours of I, across periodic boundaries.
template <int D, class F>
void for_each_beside(const Frame<D>& frame, const Index<D>& I, F&& f) {
    for (int d = 0; d < D; ++d)
        for (const int by : {-1, 1})
            if (Index<D> J = I; frame.step(J, d, by)) f(J);
}

/// Extrapolation of φ into solids from the open cells beside them, layer by layer: each rank computes all of it, from the gathered values
/// of those cells.
template <int D>
class SkinOfRanks {
public:
    /// Finds the skin, `layers` deep, in the order of one process, and the end of each layer. `rim`: the open cells beside closed ones;
    /// `closed`: at least the closed cells within that depth. Both contain those of all ranks, in the order of the grid.
    void find(const Frame<D>& frame, std::vector<std::size_t> rim, const std::vector<std::size_t>& closed, int layers,
              std::vector<Index<D>>& skin, std::vector<std::size_t>& ends);
    void continue_into(Grid<real, D>& phi, const std::vector<Index<D>>& skin);
    std::size_t bytes() const {
        return beside_.capacity() * sizeof(int) + rim_.capacity() * sizeof(std::size_t) +
               (rim_value_.capacity() + value_.capacity()) * sizeof(real);
    }

private:
    void find_beside(const Frame<D>& frame, const std::vector<Index<D>>& skin, const std::vector<std::size_t>& ends,
                     const std::unordered_map<std::size_t, int>& place);
    std::vector<std::size_t> rim_;  // open cells beside the skin, in the order of the grid
    std::vector<int> beside_;       // neighbours of each skin cell: index in rim_, ~index in the skin for a previous layer, or none
    std::vector<real> rim_value_, value_;
};

}  // namespace weir::free_surface
