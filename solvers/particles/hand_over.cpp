#include "particles/hand_over.hpp"

#include <algorithm>
#include <numeric>

namespace weir::particles {

void HandOver::clear() {
    const auto ranks = static_cast<std::size_t>(slabs().ranks());
    moving_.resize(ranks), shown_.resize(ranks), sent_.resize(ranks), received_.resize(ranks);
    for (auto& list : moving_) list.clear();
    for (auto& list : shown_) list.clear();
}

void HandOver::trade(const Arrays& arrays, std::size_t read) {
    const std::size_t ranks = moving_.size(), self = static_cast<std::size_t>(slabs().rank());
    table_.resize(ranks * ranks), table_rows_.resize(ranks + 1);
    for (std::size_t r = 0; r < ranks; ++r) count(self, r) = {static_cast<int>(moving_[r].size()), static_cast<int>(shown_[r].size())};
    std::iota(table_rows_.begin(), table_rows_.end(), std::size_t{0});
    slabs().gather_parts(table_.data(), sizeof(Count) * ranks, table_rows_);
    parcels_.clear();
    arrays_ = arrays.size(), movers_ = guests_ = 0;
    for (std::size_t r = 0; r < ranks; ++r) {
        const Count& coming = count(r, self);
        movers_ += coming.moving, guests_ += coming.shown;
        sent_[r].resize(arrays.size() * moving_[r].size() + read * shown_[r].size());
        received_[r].resize(arrays.size() * static_cast<std::size_t>(coming.moving) + read * static_cast<std::size_t>(coming.shown));
        real* to = sent_[r].data();
        for (std::size_t a = 0; a < arrays.size(); ++a) {
            const real* from = arrays[a]->data();
            for (const int i : moving_[r]) *to++ = from[i];
        }
        for (std::size_t a = 0; a < read; ++a) {
            const real* from = arrays[a]->data();
            for (const int i : shown_[r]) *to++ = from[i];
        }
        if (r != self)
            parcels_.push_back({static_cast<int>(r), sent_[r].data(), sent_[r].size() * sizeof(real), received_[r].data(),
                                received_[r].size() * sizeof(real)});
    }
    std::swap(sent_[self], received_[self]);
    slabs().trade(parcels_);
}

void HandOver::take_movers(const Arrays& arrays, std::size_t at) const {
    const auto self = static_cast<std::size_t>(slabs().rank());
    for (std::size_t r = 0; r < received_.size(); ++r) {
        const auto moving = static_cast<std::size_t>(count(r, self).moving);
        for (std::size_t a = 0; a < arrays.size(); ++a) std::copy_n(received_[r].data() + a * moving, moving, arrays[a]->data() + at);
        at += moving;
    }
}

void HandOver::take_guests(const Arrays& arrays, std::size_t read, std::size_t at) const {
    const auto self = static_cast<std::size_t>(slabs().rank());
    for (std::size_t r = 0; r < received_.size(); ++r) {
        const auto moving = static_cast<std::size_t>(count(r, self).moving), shown = static_cast<std::size_t>(count(r, self).shown);
        const real* from = received_[r].data() + arrays_ * moving;
        for (std::size_t a = 0; a < read; ++a) std::copy_n(from + a * shown, shown, arrays[a]->data() + at);
        at += shown;
    }
}

int HandOver::gain(int rank) const {
    int sum = 0;
    const auto r = static_cast<std::size_t>(rank);
    for (std::size_t other = 0; other < moving_.size(); ++other) sum += count(other, r).moving - count(r, other).moving;
    return sum;
}

std::size_t HandOver::bytes() const {
    std::size_t sum = table_.capacity() * sizeof(Count);
    for (const auto* lists : {&moving_, &shown_})
        for (const auto& list : *lists) sum += list.capacity() * sizeof(int);
    for (const auto* buffers : {&sent_, &received_})
        for (const auto& buffer : *buffers) sum += buffer.capacity() * sizeof(real);
    return sum;
}

}  // namespace weir::particles
