#include "particles/shares.hpp"

#include <algorithm>

namespace weir::particles {

void Shares::cut(const CellSort& cells, int slice) {
    const int ranks = slabs().ranks(), count = cells.count(), slices = (count + slice - 1) / slice;
    rank_ = static_cast<std::size_t>(slabs().rank());
    owns_.resize(static_cast<std::size_t>(ranks));
    reads_.resize(owns_.size());
    begins_.resize(owns_.size() + 1);
    for (int r = 0; r < ranks; ++r) {
        const auto at = static_cast<std::size_t>(r);
        owns_[at] = {std::min(count, slice * chunk_begin(slices, r, ranks)), std::min(count, slice * chunk_begin(slices, r + 1, ranks))};
        reads_[at] = ranks == 1 ? owns_[at] : reach(cells, owns_[at]);
        begins_[at] = static_cast<std::size_t>(owns_[at].begin);
    }
    begins_.back() = static_cast<std::size_t>(count);
}

/// The entries of the cells from a plane, a row and a cell before those of `own` to as many behind them.
Entries Shares::reach(const CellSort& cells, const Entries& own) const {
    if (own.count() == 0) return own;
    const auto& n = cells.cells();
    const int far = 1 + (n[1] > 1 ? n[0] : 0) + (n[2] > 1 ? n[0] * n[1] : 0);
    const auto cell = [&](int k) { return cells.cell_of()[static_cast<std::size_t>(k)]; };
    const int first = std::max(0, cell(own.begin) - far), last = std::min(n[0] * n[1] * n[2] - 1, cell(own.end - 1) + far);
    return {cells.start()[static_cast<std::size_t>(first)], cells.start()[static_cast<std::size_t>(last) + 1]};
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

std::size_t Shares::bytes() const {
    return (sends_.capacity() + gets_.capacity()) * sizeof(int) + sent_.capacity() + got_.capacity() + all_.capacity() * sizeof(real);
}

}  // namespace weir::particles
