#include "surface/level_set_ranks.hpp"

#include "core/parallel.hpp"

#include <algorithm>
#include <climits>
#include <map>

namespace weir::surface {

namespace {
constexpr int nobody = INT_MIN;
}

template <int D>
void SkinOfRanks<D>::find(const Frame<D>& frame, const Grid<std::uint8_t, D>& closed, const std::vector<Index<D>>& skin) {
    std::map<std::size_t, int> place;
    for (std::size_t i = 0; i < skin.size(); ++i) place[closed.linear(skin[i])] = static_cast<int>(i);
    const auto for_each_beside = [&](auto&& f) {
        for (const Index<D>& I : skin)
            for (int d = 0; d < D; ++d)
                for (const int by : {-1, 1}) {
                    Index<D> J = I;
                    const bool inside = frame.step(J, d, by);
                    f(inside, closed.linear(J));
                }
    };
    rim_.clear(), beside_.clear();
    for_each_beside([&](bool inside, std::size_t at) {
        if (inside && !closed[at]) rim_.push_back(at);
    });
    std::sort(rim_.begin(), rim_.end());
    rim_.erase(std::unique(rim_.begin(), rim_.end()), rim_.end());
    for_each_beside([&](bool inside, std::size_t at) {
        const auto self = static_cast<int>(beside_.size() / (2 * D));
        int to = nobody;
        if (inside && !closed[at])
            to = static_cast<int>(std::lower_bound(rim_.begin(), rim_.end(), at) - rim_.begin());
        else if (const auto other = place.find(at); inside && other != place.end() && other->second < self)
            to = ~other->second;
        beside_.push_back(to);
    });
    rim_value_.resize(rim_.size()), value_.resize(skin.size());
}

/// Mean of the neighbours that lie further out, in the order of the skin.
template <int D>
void SkinOfRanks<D>::continue_into(Grid<real, D>& phi, const std::vector<Index<D>>& skin) {
    const Cut& cut = *detail::own_share.cut;
    const auto plane = static_cast<std::size_t>(phi.stride(D - 1));
    std::vector<std::size_t> begins;
    for (int r = 0; r <= cut.ranks(); ++r) {
        const auto at = static_cast<std::size_t>(r == cut.ranks() ? cut.planes() : cut.begin(r)) * plane;
        begins.push_back(static_cast<std::size_t>(std::lower_bound(rim_.begin(), rim_.end(), at) - rim_.begin()));
    }
    const auto self = static_cast<std::size_t>(slabs().rank());
    for (std::size_t i = begins[self]; i < begins[self + 1]; ++i) rim_value_[i] = phi[rim_[i]];
    slabs().gather_parts(rim_value_.data(), sizeof(real), begins);
    for (std::size_t i = 0; i < skin.size(); ++i) {
        real sum = 0;
        int count = 0;
        for (std::size_t k = 2 * D * i; k < 2 * D * (i + 1); ++k) {
            if (beside_[k] == nobody) continue;
            sum += beside_[k] >= 0 ? rim_value_[static_cast<std::size_t>(beside_[k])] : value_[static_cast<std::size_t>(~beside_[k])];
            ++count;
        }
        value_[i] = sum / count;  // at least the one that it was found from
        if (phi.store().holds(skin[i][D - 1])) phi(skin[i]) = value_[i];
    }
}

template class SkinOfRanks<2>;
template class SkinOfRanks<3>;

}  // namespace weir::surface
