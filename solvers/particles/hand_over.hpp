// Exchange of particles between ranks: some migrate, with their whole state, and some are sent as ghost particles, with the arrays that
// neighbours read. One message to each rank contains both.
#pragma once
#include "core/slabs.hpp"
#include "core/types.hpp"

#include <cstddef>
#include <vector>

namespace weir::particles {

class HandOver {
public:
    /// Arrays of the state, the same on all ranks; particle i is entry i in each.
    using Arrays = std::vector<std::vector<real>*>;

    /// Clears the lists.
    void clear();
    void move(int rank, int i) { moving_[static_cast<std::size_t>(rank)].push_back(i); }
    void show(int rank, int i) { shown_[static_cast<std::size_t>(rank)].push_back(i); }
    /// Sends the particles named by move(), with all arrays, and those named by show(), with the first `read` arrays; particles sent to
    /// this rank itself are included. Collective.
    void trade(const Arrays& arrays, std::size_t read);
    /// Number of particles received; writes them to the entries from `at` on, which must exist.
    int movers() const { return movers_; }
    int guests() const { return guests_; }
    void take_movers(const Arrays& arrays, std::size_t at) const;
    void take_guests(const Arrays& arrays, std::size_t read, std::size_t at) const;
    /// Net change of the number of particles of rank r by migration.
    int gain(int rank) const;
    std::size_t bytes() const;

private:
    struct Count {
        int moving, shown;
    };
    Count& count(std::size_t from, std::size_t to) { return table_[from * moving_.size() + to]; }
    const Count& count(std::size_t from, std::size_t to) const { return table_[from * moving_.size() + to]; }

    std::vector<std::vector<int>> moving_, shown_;  // to each rank
    std::vector<Count> table_;                      // from each rank to each
    std::vector<std::size_t> table_rows_;
    std::vector<std::vector<real>> sent_, received_;
    std::vector<Parcel> parcels_;
    std::size_t arrays_ = 0;
    int movers_ = 0, guests_ = 0;
};

}  // namespace weir::particles
