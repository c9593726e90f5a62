#include "particles/ranks/shares.hpp"

#include <algorithm>

namespace weir::particles {

void Shares::set(const CellCut& cut, const CellSort& cells) {
    const int self = communicator().rank();
    const auto& start = cells.start();
    const auto before = [&](int cell) { return start[static_cast<std::size_t>(cell - cells.first_cell())]; };
    rank_ = static_cast<std::size_t>(self);
    cut_ = cut, count_ = cells.count();
    own_ = {before(cut.begin(self)), before(cut.end(self))};
    read_ = {before(cut.read(self)[0]), before(cut.read(self)[1])};
}

/// Appends the particles that `to` receives from `from`, one of which is this rank, in the order of cells and of the sort of `from`.
void Shares::list_halo(const CellSort& cells, int particles, std::span<const Link> links, int from, int to, std::vector<int>& list) const {
    const auto cell = [&](int k) { return cells.cell_of()[static_cast<std::size_t>(k)]; };
    const auto before = static_cast<std::ptrdiff_t>(list.size());
    const auto read = cut_.read(to);
    const int first = std::max(read[0], cut_.begin(from)), last = std::min(read[1], cut_.end(from));
    const auto entry = [&](int c) { return cells.start()[static_cast<std::size_t>(c - cells.first_cell())]; };
    for (int k = first < last ? entry(first) : 0; first < last && k < entry(last); ++k)
        if (cells.order()[static_cast<std::size_t>(k)] < particles) list.push_back(k);
    for (const Link& link : links)
        if (cut_.reads(to, cell(link.image)) && cut_.owner(cell(link.particle)) == from && !cut_.reads(to, cell(link.particle)))
            list.push_back(link.particle);
    std::sort(list.begin() + before, list.end(), [&](int k, int l) { return cell(k) != cell(l) ? cell(k) < cell(l) : k < l; });
    list.erase(std::unique(list.begin() + before, list.end()), list.end());
}

void Shares::find_halos(const CellSort& cells, int particles, std::span<const Link> links) {
    if (!several()) return;
    const int self = static_cast<int>(rank_);
    sends_.clear(), gets_.clear();
    send_begins_.assign(1, 0), get_begins_.assign(1, 0);
    for (int peer = 0; peer < cut_.ranks(); ++peer) {
        if (peer != self) list_halo(cells, particles, links, self, peer, sends_);
        if (peer != self) list_halo(cells, particles, links, peer, self, gets_);
        send_begins_.push_back(sends_.size());
        get_begins_.push_back(gets_.size());
    }
}

std::size_t Shares::bytes() const { return (sends_.capacity() + gets_.capacity()) * sizeof(int) + sent_.capacity() + got_.capacity(); }

}  // namespace weir::particles
