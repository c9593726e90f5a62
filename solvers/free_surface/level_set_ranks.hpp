// Data that several ranks share of a level set: global positions of each rank's cells in the band, and the skin of solids.
#pragma once
#include "core/parallel.hpp"
#include "free_surface/frame.hpp"
#include "parallel/grid.hpp"

#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace weir::free_surface {

/// Every cell of the band was found from a cell of the previous layer, and so from one cell beside the surface: its root. In each layer the
/// cells with roots in one rank's planes are contiguous, in rank order. So a cell's position in the band of one process is known without
/// that band.
class BandOfRanks {
public:
    /// The cells of a layer with roots in this rank's own planes: [begin, end) of its cells of the layer.
    struct Rooted {
        std::size_t begin = 0, end = 0;
    };
    std::vector<Rooted> rooted;  // per layer
    /// Blockwise sums over the band of one process up to a layer, in its order: add(sum, index) adds the term of a cell of this rank's
    /// band. Blocks wholly of one rank's cells are added there; for the others the terms of all cells are gathered.
    template <class F>
    real sum_of_blocks(int layers, const std::vector<std::size_t>& layer_start, F&& add) const;
    static constexpr std::size_t block = 256;

private:
    /// f(first, count) for the indices [first, last): whole blocks, and single entries of shared blocks.
    template <class F>
    static void for_each_piece(std::size_t first, std::size_t last, F&& f) {
        for (std::size_t at = first, count = 0; at < last; at += count) {
            count = at % block == 0 && at + block <= last ? block : 1;
            f(at, count);
        }
    }
};

template <class F>
real BandOfRanks::sum_of_blocks(int layers, const std::vector<std::size_t>& layer_start, F&& add) const {
    const auto depth = static_cast<std::size_t>(layers), ranks = static_cast<std::size_t>(communicator().ranks());
    const auto self = static_cast<std::size_t>(communicator().rank());
    std::vector<std::size_t> counts(ranks * depth), rows(ranks + 1);
    for (std::size_t r = 0; r <= ranks; ++r) rows[r] = r * depth;
    for (std::size_t l = 0; l < depth; ++l) counts[self * depth + l] = rooted[l].end - rooted[l].begin;
    communicator().gather_parts(counts.data(), sizeof(std::size_t), rows);
    // terms of each rank, layer by layer
    std::vector<std::size_t> begins(ranks + 1, 0);
    std::vector<std::array<std::size_t, 2>> own;  // index here, number of cells
    std::size_t first = 0;
    for (std::size_t l = 0; l < depth; ++l)
        for (std::size_t r = 0; r < ranks; ++r) {
            const std::size_t last = first + counts[r * depth + l];
            for_each_piece(first, last, [&](std::size_t at, std::size_t count) {
                ++begins[r + 1];
                if (r == self) own.push_back({layer_start[l] + rooted[l].begin + (at - first), count});
            });
            first = last;
        }
    for (std::size_t r = 0; r < ranks; ++r) begins[r + 1] += begins[r];
    std::vector<real> pieces(begins.back());
    parallel_for(0, static_cast<int>(own.size()), [&](int i) {
        const auto [place, count] = own[static_cast<std::size_t>(i)];
        real& sum = pieces[begins[self] + static_cast<std::size_t>(i)];
        for (std::size_t k = 0; k < count; ++k) add(sum, place + k);
    });
    communicator().gather_parts(pieces.data(), sizeof(real), begins);
    // every rank adds all terms
    real sum = 0, part = 0;
    first = 0;
    for (std::size_t l = 0; l < depth; ++l)
        for (std::size_t r = 0; r < ranks; ++r) {
            const std::size_t last = first + counts[r * depth + l];
            for_each_piece(first, last, [&](std::size_t at, std::size_t count) {
                part += pieces[begins[r]++];
                if ((at + count) % block == 0) sum += part, part = 0;
            });
            first = last;
        }
    return first % block == 0 ? sum : sum + part;
}

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
