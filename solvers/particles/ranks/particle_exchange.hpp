// Exchange of particles between ranks: some migrate, with their whole state, and some are sent as ghost particles, with the arrays that
// neighbours read. One message to each rank contains both.
#pragma once
#include "core/types.hpp"
#include "parallel/communicator.hpp"

#include <cstddef>
#include <vector>

namespace weir::particles {

class ParticleExchange {
public:
    /// Arrays of the state, the same on all ranks; particle i is entry i in each.
    using Arrays = std::vector<std::vector<real>*>;

    /// Clears the lists.
    void clear();
    void migrate(int rank, int i) { migrating_[static_cast<std::size_t>(rank)].push_back(i); }
    void copy_as_ghost(int rank, int i) { ghost_lists_[static_cast<std::size_t>(rank)].push_back(i); }
    /// Sends the particles named by migrate(), with all arrays, and those named by copy_as_ghost(), with the first `read` arrays; particles
    /// sent to this rank itself are included. Collective.
    void run(const Arrays& arrays, std::size_t read);
    /// Number of particles received; writes them to the entries from `at` on, which must exist.
    int migrated() const { return migrated_; }
    int ghosts() const { return ghosts_; }
    void unpack_migrated(const Arrays& arrays, std::size_t at) const;
    void unpack_ghosts(const Arrays& arrays, std::size_t read, std::size_t at) const;
    /// Net change of the number of particles of rank r by migration.
    int gain(int rank) const;
    std::size_t bytes() const;

private:
    struct Count {
        int migrating, ghosts;
    };
    Count& count(std::size_t from, std::size_t to) { return table_[from * migrating_.size() + to]; }
    const Count& count(std::size_t from, std::size_t to) const { return table_[from * migrating_.size() + to]; }

    std::vector<std::vector<int>> migrating_, ghost_lists_;  // to each rank
    std::vector<Count> table_;                               // from each rank to each
    std::vector<std::size_t> table_rows_;
    std::vector<std::vector<real>> sent_, received_;
    std::vector<Message> messages_;
    std::size_t arrays_ = 0;
    int migrated_ = 0, ghosts_ = 0;
};

}  // namespace weir::particles
