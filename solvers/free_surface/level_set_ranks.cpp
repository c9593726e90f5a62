#include "free_surface/level_set_ranks.hpp"

#include "core/parallel.hpp"

#include <algorithm>
#include <climits>

namespace weir::free_surface {

namespace {
constexpr int unplaced = INT_MIN;
}

template <int D>
void SkinOfRanks<D>::find(const Frame<D>& frame, std::vector<std::size_t> rim, const std::vector<std::size_t>& closed, int layers,
                          std::vector<Index<D>>& skin, std::vector<std::size_t>& ends) {
    rim_ = std::move(rim);
    std::unordered_map<std::size_t, int> place;  // index in the skin, of closed cells that may belong to it
    place.reserve(closed.size());
    for (const std::size_t at : closed) place.emplace(at, unplaced);
    skin.clear();
    const auto add_neighbours = [&](const Index<D>& I) {
        for_each_beside(frame, I, [&](const Index<D>& J) {
            const auto at = place.find(frame.linear(J));
            if (at == place.end() || at->second != unplaced) return;
            at->second = static_cast<int>(skin.size());
            skin.push_back(J);
        });
    };
    for (const std::size_t at : rim_) add_neighbours(frame.index_of(at));
    ends.assign(1, skin.size());
    std::size_t first = 0;
    for (int layer = 1; layer < layers; ++layer) {
        for (const std::size_t last = skin.size(); first < last; ++first) add_neighbours(Index<D>(skin[first]));
        ends.push_back(skin.size());
    }
    find_beside(frame, skin, ends, place);
    rim_value_.resize(rim_.size()), value_.resize(skin.size());
}

/// A neighbour's index in the rim, or in the skin where it belongs to a previous layer.
template <int D>
void SkinOfRanks<D>::find_beside(const Frame<D>& frame, const std::vector<Index<D>>& skin, const std::vector<std::size_t>& ends,
                                 const std::unordered_map<std::size_t, int>& place) {
    std::unordered_map<std::size_t, int> in_rim;
    in_rim.reserve(rim_.size());
    for (std::size_t i = 0; i < rim_.size(); ++i) in_rim.emplace(rim_[i], static_cast<int>(i));
    const auto to = [&](const Index<D>& J, int first) {  // of the cell's own layer
        const std::size_t at = frame.linear(J);
        if (const auto open = in_rim.find(at); open != in_rim.end()) return open->second;
        const auto other = place.find(at);
        return other != place.end() && other->second != unplaced && other->second < first ? ~other->second : unplaced;
    };
    beside_.assign(2 * D * skin.size(), unplaced);
    std::size_t i = 0, first = 0;
    for (const std::size_t last : ends) {
        for (; i < last; ++i)
            for (int d = 0; d < D; ++d)
                for (const int upper : {0, 1})
                    if (Index<D> J = skin[i]; frame.step(J, d, 2 * upper - 1))
                        beside_[2 * D * i + static_cast<std::size_t>(2 * d + upper)] = to(J, static_cast<int>(first));
        first = last;
    }
}

/// Mean of the neighbours further out, in the order of the skin.
template <int D>
void SkinOfRanks<D>::continue_into(Grid<real, D>& phi, const std::vector<Index<D>>& skin) {
    const Partition& cut = phi.own().partition();
    const auto plane = static_cast<std::size_t>(phi.stride(D - 1));
    std::vector<std::size_t> begins;
    for (int r = 0; r <= cut.ranks(); ++r) {
        const auto at = static_cast<std::size_t>(r == cut.ranks() ? cut.planes() : cut.begin(r)) * plane;
        begins.push_back(static_cast<std::size_t>(std::lower_bound(rim_.begin(), rim_.end(), at) - rim_.begin()));
    }
    const auto self = static_cast<std::size_t>(communicator().rank());
    for (std::size_t i = begins[self]; i < begins[self + 1]; ++i) rim_value_[i] = phi[rim_[i]];
    communicator().gather_parts(rim_value_.data(), sizeof(real), begins);
    for (std::size_t i = 0; i < skin.size(); ++i) {
        real sum = 0;
        int count = 0;
        for (std::size_t k = 2 * D * i; k < 2 * D * (i + 1);) {
            real pair = 0;  // the two sides are added first, as in one process
            for (const std::size_t end = k + 2; k < end; ++k) {
                if (beside_[k] == unplaced) continue;
                pair += beside_[k] >= 0 ? rim_value_[static_cast<std::size_t>(beside_[k])] : value_[static_cast<std::size_t>(~beside_[k])];
                ++count;
            }
            sum += pair;
        }
        value_[i] = sum / count;  // at least the one from which it was found
        if (phi.store().holds(skin[i][D - 1])) phi(skin[i]) = value_[i];
    }
}

template class SkinOfRanks<2>;
template class SkinOfRanks<3>;

}  // namespace weir::free_surface
