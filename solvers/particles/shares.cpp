#include "particles/shares.hpp"

#include <algorithm>

namespace weir::particles {

void Shares::set(const CellCut& cut, const CellSort& cells) {
    const auto& start = cells.start();
    const int all = static_cast<int>(start.size()) - 1;
    const auto before = [&](int cell) { return start[static_cast<std::size_t>(std::clamp(cell, 0, all))]; };
    rank_ = static_cast<std::size_t>(slabs().rank());
    count_ = cells.count();
    owns_.resize(static_cast<std::size_t>(cut.ranks()));
    reads_.resize(owns_.size());
    for (int r = 0; r < cut.ranks(); ++r) {
        const int begin = cut.begin(r), end = cut.end(r), far = begin < end ? cut.far : 0;
        owns_[static_cast<std::size_t>(r)] = {before(begin), before(end)};
        reads_[static_cast<std::size_t>(r)] = {before(begin - far), before(end + far)};
    }
}

/// Appends what `to` gets from `from`, in the order of the sort.
void Shares::list_halo(const CellSort& cells, int particles, std::span<const Link> links, int from, int to, std::vector<int>& list) const {
    const Entries &giver = own(from), &wanted = read(to);
    const auto before = static_cast<std::ptrdiff_t>(list.size());
    for (int k = std::max(giver.begin, wanted.begin); k < std::min(giver.end, wanted.end); ++k)
        if (cells.order()[static_cast<std::size_t>(k)] < particles) list.push_back(k);
    for (const Link& link : links)
        if (wanted.has(link.image) && giver.has(link.particle) && !wanted.has(link.particle)) list.push_back(link.particle);
    std::sort(list.begin() + before, list.end());
    list.erase(std::unique(list.begin() + before, list.end()), list.end());
}

void Shares::find_halos(const CellSort& cells, int particles, std::span<const Link> links) {
    if (!several()) return;
    const int self = static_cast<int>(rank_);
    sends_.clear(), gets_.clear();
    send_begins_.assign(1, 0), get_begins_.assign(1, 0);
    for (int peer = 0; peer < static_cast<int>(owns_.size()); ++peer) {
        if (peer != self) list_halo(cells, particles, links, self, peer, sends_);
        if (peer != self) list_halo(cells, particles, links, peer, self, gets_);
        send_begins_.push_back(sends_.size());
        get_begins_.push_back(gets_.size());
    }
}

std::size_t Shares::bytes() const { return (sends_.capacity() + gets_.capacity()) * sizeof(int) + sent_.capacity() + got_.capacity(); }

}  // namespace weir::particles
