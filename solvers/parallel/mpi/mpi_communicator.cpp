// Communicator over MPI. Both sides know the size of each message beforehand (parallel/partition.hpp): there is one message per pair of
// ranks, and none for sizes. Only the thread that joined may call.
#include "parallel/communicator.hpp"
#include "parallel/mpi/mpi_entry.hpp"
#include "parallel/mpi/polling_wait.hpp"
#include "parallel/stale_ghosts.hpp"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <exception>
#include <numeric>
#include <thread>
#include <vector>

#include <mpi.h>
#include <sys/prctl.h>

namespace weir::distributed {

namespace {

/// The exchange of one kind of array in a refresh.
struct Plan {
    Partition cut;
    int count, ghost_planes;
    bool ring;
    struct PlaneMessage {
        int peer;
        PlaneRange planes;
        bool sends;
    };
    std::vector<PlaneMessage> messages;
};

class MpiCommunicator final : public Communicator {
public:
    MpiCommunicator(int rank, int ranks) : Communicator(rank, ranks), poisons_(std::getenv("WEIR_HALO_POISON") != nullptr) {
        MPI_Comm_dup(MPI_COMM_WORLD, &farewell_);
        MPI_Comm here;
        MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &here);
        int ranks_here = 1;
        MPI_Comm_size(here, &ranks_here);
        MPI_Comm_free(&here);
        if (ranks_here > static_cast<int>(std::thread::hardware_concurrency())) wait_ = PollingWait(std::chrono::microseconds(100));
        prctl(PR_SET_TIMERSLACK, 1000UL);  // [ns] by default a sleep of 20 us would take 70 us
    }
    ~MpiCommunicator() override { MPI_Finalize(); }

    void refresh(const Partition& cut, std::span<const Planes> arrays, int ghost_planes, bool ring) override {
        requests_.clear();
        for (int peer = 0; peer < ranks(); ++peer)
            for (const bool sends : {false, true}) {
                const std::size_t bytes = collect(cut, arrays, ghost_planes, ring, peer, sends);
                if (bytes == 0) continue;
                const Scattered all(lengths_, places_);
                requests_.emplace_back();
                if (sends)
                    MPI_Isend(MPI_BOTTOM, 1, all.type, peer, 0, MPI_COMM_WORLD, &requests_.back());
                else
                    MPI_Irecv(MPI_BOTTOM, 1, all.type, peer, 0, MPI_COMM_WORLD, &requests_.back());
                if (sends) count_message(bytes);
            }
        wait_for_requests();
        if (!poisons_) return;
        for (const Planes& planes : arrays) poison_stale_ghosts(cut, *this, planes, ghost_planes, ring);
    }

    void gather(const Partition& cut, const Planes& planes) override {
        const PlaneType plane(planes.bytes);
        counts_.clear(), begins_.clear();
        for (int r = 0; r < ranks(); ++r) {
            begins_.push_back(cut.begin(r));
            counts_.push_back(cut.end(r, planes.count) - cut.begin(r));
        }
        gather_counted(planes.first, plane);
        count_message(planes.bytes * static_cast<std::size_t>(counts_[static_cast<std::size_t>(rank())]));
    }

    void stream_to_first(const void* own, std::size_t bytes, const std::function<void(const void*, std::size_t)>& sink) override {
        std::vector<std::size_t> sizes(static_cast<std::size_t>(ranks()), bytes), begins(sizes.size() + 1);
        std::iota(begins.begin(), begins.end(), std::size_t{0});
        gather_parts(sizes.data(), sizeof(std::size_t), begins);
        constexpr std::size_t piece = std::size_t{1} << 22;
        std::exception_ptr failure;
        const auto take = [&](const void* data, std::size_t count) {
            if (!failure) try {
                    sink(data, count);
                } catch (...) {  // the other ranks wait until all data has been sent
                    failure = std::current_exception();
                }
        };
        if (rank() == 0) take(own, bytes);
        std::vector<unsigned char> room(rank() == 0 ? piece : 0);
        for (int r = 1; r < ranks(); ++r) {
            if (rank() != 0 && rank() != r) continue;
            for (std::size_t at = 0; at < sizes[static_cast<std::size_t>(r)]; at += piece) {
                const std::size_t count = std::min(piece, sizes[static_cast<std::size_t>(r)] - at);
                requests_.assign(1, MPI_REQUEST_NULL);
                if (rank() == 0)
                    MPI_Irecv(room.data(), static_cast<int>(count), MPI_BYTE, r, 0, MPI_COMM_WORLD, requests_.data());
                else
                    MPI_Isend(static_cast<const unsigned char*>(own) + at, static_cast<int>(count), MPI_BYTE, 0, 0, MPI_COMM_WORLD,
                              requests_.data());
                wait_for_requests();
                if (rank() == 0)
                    take(room.data(), count);
                else
                    count_message(count);
            }
        }
        if (failure) std::rethrow_exception(failure);
    }

    void gather_parts(void* entries, std::size_t bytes, std::span<const std::size_t> begins) override {
        const PlaneType entry(bytes);
        counts_.clear(), begins_.clear();
        for (std::size_t r = 0; r + 1 < begins.size(); ++r) {
            begins_.push_back(static_cast<int>(begins[r]));
            counts_.push_back(static_cast<int>(begins[r + 1] - begins[r]));
        }
        gather_counted(entries, entry);
        count_message(bytes * static_cast<std::size_t>(counts_[static_cast<std::size_t>(rank())]));
    }

    void exchange(std::span<const Message> messages) override {
        requests_.clear();
        for (const Message& message : messages) {
            if (message.received_bytes > 0) {
                const PlaneType all(message.received_bytes);
                requests_.emplace_back();
                MPI_Irecv(message.received, 1, all.type, message.peer, 0, MPI_COMM_WORLD, &requests_.back());
            }
            if (message.sent_bytes > 0) {
                const PlaneType all(message.sent_bytes);
                requests_.emplace_back();
                MPI_Isend(message.sent, 1, all.type, message.peer, 0, MPI_COMM_WORLD, &requests_.back());
                count_message(message.sent_bytes);
            }
        }
        wait_for_requests();
    }

    bool poisons() const override { return poisons_; }
    double busy_seconds() const override { return wait_.busy_seconds(); }

    int largest(int value) override {
        requests_.assign(1, MPI_REQUEST_NULL);
        MPI_Iallreduce(MPI_IN_PLACE, &value, 1, MPI_INT, MPI_MAX, MPI_COMM_WORLD, requests_.data());
        wait_for_requests();
        count_message(sizeof value);
        return value;
    }

    bool all_arrive(double seconds) override {
        using clock = std::chrono::steady_clock;
        MPI_Request request;
        MPI_Ibarrier(farewell_, &request);
        const auto start = clock::now();
        for (int done = 0;;) {
            MPI_Test(&request, &done, MPI_STATUS_IGNORE);
            if (done) return true;
            if (std::chrono::duration<double>(clock::now() - start).count() > seconds) return false;
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
    }

    void abort(int exit_code) override { MPI_Abort(MPI_COMM_WORLD, exit_code); }

private:
    /// A plane may have any size, and a message may exceed 2 GB: counts are in planes.
    struct PlaneType {
        MPI_Datatype type{};
        explicit PlaneType(std::size_t bytes) {
            MPI_Type_contiguous(static_cast<int>(bytes), MPI_BYTE, &type);
            MPI_Type_commit(&type);
        }
        ~PlaneType() { MPI_Type_free(&type); }
        PlaneType(const PlaneType&) = delete;
        PlaneType& operator=(const PlaneType&) = delete;
    };

    /// Non-contiguous memory as one message.
    struct Scattered {
        MPI_Datatype type{};
        Scattered(const std::vector<int>& lengths, const std::vector<MPI_Aint>& places) {
            MPI_Type_create_hindexed(static_cast<int>(lengths.size()), lengths.data(), places.data(), MPI_BYTE, &type);
            MPI_Type_commit(&type);
        }
        ~Scattered() { MPI_Type_free(&type); }
        Scattered(const Scattered&) = delete;
        Scattered& operator=(const Scattered&) = delete;
    };

    /// Appends the planes of all arrays that are sent to, or received from, a rank to lengths_ and places_; returns their bytes.
    std::size_t collect(const Partition& cut, std::span<const Planes> arrays, int ghost_planes, bool ring, int peer, bool sends) {
        lengths_.clear(), places_.clear();
        std::size_t bytes = 0;
        for (const Planes& planes : arrays)
            for (const auto& message : plan_of(cut, planes.count, ghost_planes, ring).messages) {
                if (message.peer != peer || message.sends != sends) continue;
                for (int plane = message.planes.begin; plane < message.planes.end; ++plane) {  // a single plane is smaller than 2 GB
                    lengths_.push_back(static_cast<int>(planes.bytes));
                    places_.emplace_back();
                    MPI_Get_address(plane_at(planes, plane), &places_.back());
                    bytes += planes.bytes;
                }
            }
        return bytes;
    }

    void gather_counted(void* entries, const PlaneType& entry) {
        requests_.assign(1, MPI_REQUEST_NULL);
        MPI_Iallgatherv(MPI_IN_PLACE, 0, entry.type, entries, counts_.data(), begins_.data(), entry.type, MPI_COMM_WORLD, requests_.data());
        wait_for_requests();
    }

    /// MPI's own waits never sleep: on a shared machine the rank that is waited for would then not be scheduled.
    void wait_for_requests() {
        wait_.until([&] {
            int done = 0;
            MPI_Testall(static_cast<int>(requests_.size()), requests_.data(), &done, MPI_STATUSES_IGNORE);
            return done != 0;
        });
    }

    static unsigned char* plane_at(const Planes& planes, int plane) {
        return static_cast<unsigned char*>(planes.first) + static_cast<std::ptrdiff_t>(planes.bytes) * plane;
    }

    void count_message(std::size_t bytes) {
        ++traffic_.messages;
        traffic_.bytes += static_cast<std::int64_t>(bytes);
    }

    const Plan& plan_of(const Partition& cut, int count, int ghost_planes, bool ring) {
        for (const Plan& plan : plans_)
            if (plan.count == count && plan.ghost_planes == ghost_planes && plan.ring == ring && plan.cut == cut) return plan;
        Plan plan{cut, count, ghost_planes, ring, {}};
        for (int peer = 0; peer < ranks(); ++peer) {
            if (peer == rank()) continue;
            for (const PlaneRange& range : halo_from(cut, peer, rank(), count, ghost_planes, ring))
                plan.messages.push_back({peer, range, false});
            for (const PlaneRange& range : halo_from(cut, rank(), peer, count, ghost_planes, ring))
                plan.messages.push_back({peer, range, true});
        }
        plans_.push_back(std::move(plan));
        return plans_.back();
    }

    bool poisons_;
    /// Longer than a message takes, and than ranks differ in a pass when each has a processor of its own.
    PollingWait wait_{std::chrono::microseconds(2000)};
    MPI_Comm farewell_{};
    std::vector<Plan> plans_;
    std::vector<MPI_Request> requests_;
    std::vector<int> counts_, begins_, lengths_;
    std::vector<MPI_Aint> places_;
};

}  // namespace

}  // namespace weir::distributed

extern "C" weir::Communicator* weir_mpi_communicator() {
    int given = 0, rank = 0, ranks = 1;
    MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &given);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    MPI_Comm_size(MPI_COMM_WORLD, &ranks);
    return new weir::distributed::MpiCommunicator(rank, ranks);
}
