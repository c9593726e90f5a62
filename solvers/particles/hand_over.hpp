// Particles that go from rank to rank: some change hands, with all that the state knows of them, and some are shown, with what is read of a
// neighbour. Both go in one message to each rank.
#pragma once
#include "core/slabs.hpp"
#include "core/types.hpp"

#include <cstddef>
#include <vector>

namespace weir::particles {

class HandOver {
public:
    /// Arrays of the state, the same on all ranks; particle i has entry i in each.
    using Arrays = std::vector<std::vector<real>*>;

    /// Nothing goes.
    void clear();
    void move(int rank, int i) { moving_[static_cast<std::size_t>(rank)].push_back(i); }
    void show(int rank, int i) { shown_[static_cast<std::size_t>(rank)].push_back(i); }
    /// Sends what move() and show() named, the former with all arrays and the latter with the first `read`; who is sent to oneself comes
    /// too. All ranks call it.
    void trade(const Arrays& arrays, std::size_t read);
    /// How many have come, and them into entries from `at` on, for which there is room.
    int movers() const { return movers_; }
    int guests() const { return guests_; }
    void take_movers(const Arrays& arrays, std::size_t at) const;
    void take_guests(const Arrays& arrays, std::size_t read, std::size_t at) const;
    /// How many more particles rank r has for what moved.
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
