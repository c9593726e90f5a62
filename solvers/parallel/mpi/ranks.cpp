#include "parallel/mpi/ranks.hpp"

#include "core/error.hpp"
#include "core/library.hpp"
#include "parallel/communicator.hpp"
#include "parallel/forked_ranks.hpp"
#include "parallel/mpi/mpi_entry.hpp"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <thread>

#include <fcntl.h>
#include <sched.h>
#include <unistd.h>

namespace weir::distributed {

namespace {

/// When all ranks fail at the same place, they arrive within this time.
constexpr double patience = 10;  // [s]

constexpr int most_forked_ranks = 16;  // each pair has two sockets, which one process makes

int own_stderr = -1;  // of a rank whose output is hidden

/// The first variable of these that is set: by Open MPI, by MPICH and Intel MPI, by Slurm with PMIx.
int number_of(std::initializer_list<const char*> names, int fallback) {
    for (const char* name : names)
        if (const char* text = std::getenv(name)) return std::atoi(text);
    return fallback;
}

void* mpi_function(const char* name) { return entry_of_library("libweir_mpi.so", WEIR_MPI_LIBRARY, name); }

void print_nothing() {
    own_stderr = dup(STDERR_FILENO);
    const int nowhere = open("/dev/null", O_WRONLY);
    dup2(nowhere, STDOUT_FILENO);
    dup2(nowhere, STDERR_FILENO);
    close(nowhere);
}

}  // namespace

int started_ranks() { return number_of({"OMPI_COMM_WORLD_SIZE", "PMI_SIZE"}, 1); }
int started_rank() { return number_of({"OMPI_COMM_WORLD_RANK", "PMI_RANK"}, 0); }

int threads_of_rank() {
    const int here = number_of({"OMPI_COMM_WORLD_LOCAL_SIZE", "MPI_LOCALNRANKS"}, 1);
    const auto processors = static_cast<int>(sysconf(_SC_NPROCESSORS_ONLN));
    cpu_set_t may{};
    if (here <= 1 || sched_getaffinity(0, sizeof may, &may) != 0 || CPU_COUNT(&may) < processors) return 0;
    return std::max(1, processors / here);
}

int forked_ranks() {
    const char* const text = std::getenv("WEIR_FORKED_RANKS");
    if (!text) return 1;
    int ranks = 0;
    const char* const end = text + std::strlen(text);
    const auto [rest, failed] = std::from_chars(text, end, ranks);
    if (failed != std::errc{} || rest != end || ranks < 1 || ranks > most_forked_ranks)
        throw BadInput("WEIR_FORKED_RANKS=" + std::string(text) + ": expected a number of ranks from 1 to " +
                       std::to_string(most_forked_ranks));
    return ranks;
}

int run_on_forked_ranks(int ranks, const std::function<int()>& run) {
    const auto body = [&](ForkedRanks& self) {
        if (self.rank() > 0) print_nothing();
        return std::to_string(run());
    };
    int result = exit_success;
    for (const ForkedEnd& end : fork_ranks(ranks, body, std::getenv("WEIR_HALO_POISON") != nullptr)) {
        const int code = end.status == 0 ? std::atoi(end.said.c_str()) : end.status;
        if (code != exit_success && (result == exit_success || result == exit_internal_error)) result = code;
    }
    return result;
}

void join() {
    if (started_ranks() <= 1) return;
    const auto entry = reinterpret_cast<MpiEntry>(mpi_function(mpi_entry));
    if (!entry)
        throw BadInput(
            "weir was started as " + std::to_string(started_ranks()) +
            " ranks, but this build has no MPI: install libopenmpi-dev, configure with WEIR_MPI=ON and build again, or start one process");
    set_communicator(std::unique_ptr<Communicator>(entry()));
    if (communicator().rank() > 0) print_nothing();
}

int leave(int exit_code, const std::string& complaint) {
    if (!communicator().several()) return exit_code;
    if (!communicator().all_arrive(exit_code == exit_success ? infinity : patience)) {
        std::fflush(nullptr);
        if (own_stderr >= 0) dup2(own_stderr, STDERR_FILENO);
        if (own_stderr >= 0) std::fprintf(stderr, "rank %d alone: %s\n", communicator().rank(), complaint.c_str());
        std::this_thread::sleep_for(std::chrono::milliseconds(300));  // for the launcher to read it: MPICH's drops output after an abort
        communicator().abort(exit_code);
    }
    set_communicator(nullptr);
    return exit_code;
}

}  // namespace weir::distributed
