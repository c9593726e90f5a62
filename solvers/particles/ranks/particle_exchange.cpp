#include "particles/ranks/particle_exchange.hpp"

#include <algorithm>
#include <numeric>

namespace weir::particles {

void ParticleExchange::clear() {
    const auto ranks = static_cast<std::size_t>(communicator().ranks());
    migrating_.resize(ranks), ghost_lists_.resize(ranks), sent_.resize(ranks), received_.resize(ranks);
    for (auto& list : migrating_) list.clear();
    for (auto& list : ghost_lists_) list.clear();
}

void ParticleExchange::run(const Arrays& arrays, std::size_t read) {
    const std::size_t ranks = migrating_.size(), self = static_cast<std::size_t>(communicator().rank());
    table_.resize(ranks * ranks), table_rows_.resize(ranks + 1);
    for (std::size_t r = 0; r < ranks; ++r)
        count(self, r) = {static_cast<int>(migrating_[r].size()), static_cast<int>(ghost_lists_[r].size())};
    std::iota(table_rows_.begin(), table_rows_.end(), std::size_t{0});
    communicator().gather_parts(table_.data(), sizeof(Count) * ranks, table_rows_);
    messages_.clear();
    arrays_ = arrays.size(), migrated_ = ghosts_ = 0;
    for (std::size_t r = 0; r < ranks; ++r) {
        const Count& coming = count(r, self);
        migrated_ += coming.migrating, ghosts_ += coming.ghosts;
        sent_[r].resize(arrays.size() * migrating_[r].size() + read * ghost_lists_[r].size());
        received_[r].resize(arrays.size() * static_cast<std::size_t>(coming.migrating) + read * static_cast<std::size_t>(coming.ghosts));
        real* to = sent_[r].data();
        for (std::size_t a = 0; a < arrays.size(); ++a) {
            const real* from = arrays[a]->data();
            for (const int i : migrating_[r]) *to++ = from[i];
        }
        for (std::size_t a = 0; a < read; ++a) {
            const real* from = arrays[a]->data();
            for (const int i : ghost_lists_[r]) *to++ = from[i];
        }
        if (r != self)
            messages_.push_back({static_cast<int>(r), sent_[r].data(), sent_[r].size() * sizeof(real), received_[r].data(),
                                 received_[r].size() * sizeof(real)});
    }
    std::swap(sent_[self], received_[self]);
    communicator().exchange(messages_);
}

void ParticleExchange::unpack_migrated(const Arrays& arrays, std::size_t at) const {
    const auto self = static_cast<std::size_t>(communicator().rank());
    for (std::size_t r = 0; r < received_.size(); ++r) {
        const auto migrating = static_cast<std::size_t>(count(r, self).migrating);
        for (std::size_t a = 0; a < arrays.size(); ++a) std::copy_n(received_[r].data() + a * migrating, migrating, arrays[a]->data() + at);
        at += migrating;
    }
}

void ParticleExchange::unpack_ghosts(const Arrays& arrays, std::size_t read, std::size_t at) const {
    const auto self = static_cast<std::size_t>(communicator().rank());
    for (std::size_t r = 0; r < received_.size(); ++r) {
        const auto migrating = static_cast<std::size_t>(count(r, self).migrating), ghosts = static_cast<std::size_t>(count(r, self).ghosts);
        const real* from = received_[r].data() + arrays_ * migrating;
        for (std::size_t a = 0; a < read; ++a) std::copy_n(from + a * ghosts, ghosts, arrays[a]->data() + at);
        at += ghosts;
    }
}

int ParticleExchange::gain(int rank) const {
    int sum = 0;
    const auto r = static_cast<std::size_t>(rank);
    for (std::size_t other = 0; other < migrating_.size(); ++other) sum += count(other, r).migrating - count(r, other).migrating;
    return sum;
}

std::size_t ParticleExchange::bytes() const {
    std::size_t sum = table_.capacity() * sizeof(Count);
    for (const auto* lists : {&migrating_, &ghost_lists_})
        for (const auto& list : *lists) sum += list.capacity() * sizeof(int);
    for (const auto* buffers : {&sent_, &received_})
        for (const auto& buffer : *buffers) sum += buffer.capacity() * sizeof(real);
    return sum;
}

}  // namespace weir::particles
