#include "parallel/forked_ranks.hpp"

#include "core/parallel.hpp"
#include "parallel/stale_ghosts.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <stdexcept>

#include <fcntl.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

namespace weir {

namespace {

constexpr int peer_ended = 2;  // exit status

Traffic operator-(const Traffic& a, const Traffic& b) { return {a.messages - b.messages, a.bytes - b.bytes}; }

/// Thrown by a rank that waits for one that has ended: a consequence, not the cause.
struct PeerEnded : std::runtime_error {
    using std::runtime_error::runtime_error;
};

void advance(std::size_t& done, ssize_t bytes) {
    if (bytes > 0) done += static_cast<std::size_t>(bytes);
    if (bytes == 0 || (bytes < 0 && errno != EAGAIN && errno != EINTR)) throw PeerEnded("another rank has ended");
}

void write_all(int file, const std::string& bytes) {
    for (std::size_t at = 0; at < bytes.size();)
        if (const ssize_t written = write(file, bytes.data() + at, bytes.size() - at); written > 0)
            at += static_cast<std::size_t>(written);
        else if (errno != EINTR)
            return;
}

std::string read_all(int file) {
    std::string bytes;
    std::array<char, 4096> piece;
    for (ssize_t count = 0; (count = read(file, piece.data(), piece.size())) != 0;)
        if (count > 0)
            bytes.append(piece.data(), static_cast<std::size_t>(count));
        else if (errno != EINTR)
            break;
    return bytes;
}

/// A socket between each two of the ranks, and a pipe from each to the parent.
struct Wires {
    std::vector<std::vector<int>> sockets;
    std::vector<std::array<int, 2>> pipes;

    explicit Wires(std::size_t n) : sockets(n, std::vector<int>(n, -1)), pipes(n, {-1, -1}) {
        for (std::size_t i = 0; i < n; ++i) {
            if (pipe(pipes[i].data()) != 0) throw std::runtime_error("no pipe to a forked rank");
            for (std::size_t j = 0; j < i; ++j) {
                std::array<int, 2> pair{};
                if (socketpair(AF_UNIX, SOCK_STREAM, 0, pair.data()) != 0) throw std::runtime_error("no socket between forked ranks");
                sockets[i][j] = pair[0], sockets[j][i] = pair[1];
            }
        }
    }
    /// Closes all but what rank `kept` uses.
    void leave_to(std::size_t kept) {
        for (std::size_t i = 0; i < sockets.size(); ++i) {
            for (const int socket : sockets[i])
                if (i != kept && socket >= 0) close(socket);
            close(pipes[i][0]);
            if (i != kept) close(pipes[i][1]);
        }
    }
    /// Closes what the parent does not use.
    void leave_to_parent() {
        for (std::size_t i = 0; i < sockets.size(); ++i) {
            for (const int socket : sockets[i])
                if (socket >= 0) close(socket);
            close(pipes[i][1]);
        }
    }
};

[[noreturn]] void be_rank(std::size_t rank, Wires& wires, const std::function<std::string(ForkedRanks&)>& body, bool poisons, int seconds) {
    if (seconds > 0) alarm(static_cast<unsigned>(seconds));
    wires.leave_to(rank);
    set_threads(1);
    auto several = std::make_unique<ForkedRanks>(static_cast<int>(rank), wires.sockets[rank], poisons);
    ForkedRanks& self = *several;
    set_communicator(std::move(several));
    int status = 0;
    try {
        write_all(wires.pipes[rank][1], body(self));
    } catch (const PeerEnded& failure) {
        write_all(wires.pipes[rank][1], failure.what());
        status = peer_ended;
    } catch (const std::exception& failure) {
        write_all(wires.pipes[rank][1], failure.what());
        status = 1;
    }
    std::fflush(nullptr);
    _exit(status);
}

}  // namespace

RankTraffic RankTraffic::since(const RankTraffic& before) const {
    return {beside - before.beside, everywhere - before.everywhere, rounds - before.rounds, received - before.received};
}

ForkedRanks::ForkedRanks(int rank, std::vector<int> sockets, bool poisons)
    : Communicator(rank, static_cast<int>(sockets.size())), sockets_(std::move(sockets)), poisons_(poisons) {
    for (const int socket : sockets_)
        if (socket >= 0) fcntl(socket, F_SETFL, fcntl(socket, F_GETFL) | O_NONBLOCK);
}

ForkedRanks::~ForkedRanks() {
    for (const int socket : sockets_)
        if (socket >= 0) close(socket);
}

/// Sends and receives as the sockets allow, until all is done.
void ForkedRanks::transfer(std::span<const Message> messages) {
    std::vector<std::size_t> sent(messages.size(), 0), received(messages.size(), 0);
    for (;;) {
        std::vector<pollfd> open;
        for (std::size_t p = 0; p < messages.size(); ++p) {
            const auto events = static_cast<short>((sent[p] < messages[p].sent_bytes ? POLLOUT : 0) |
                                                   (received[p] < messages[p].received_bytes ? POLLIN : 0));
            open.push_back({events ? sockets_[static_cast<std::size_t>(messages[p].peer)] : -1, events, 0});
        }
        if (std::all_of(open.begin(), open.end(), [](const pollfd& one) { return one.fd < 0; })) return;
        poll(open.data(), open.size(), -1);
        for (std::size_t p = 0; p < messages.size(); ++p) {
            const Message& message = messages[p];
            if (open[p].revents & POLLOUT)
                advance(sent[p],
                        send(open[p].fd, static_cast<const char*>(message.sent) + sent[p], message.sent_bytes - sent[p], MSG_NOSIGNAL));
            if (open[p].revents & (POLLIN | POLLHUP | POLLERR) && received[p] < message.received_bytes)
                advance(received[p],
                        recv(open[p].fd, static_cast<char*>(message.received) + received[p], message.received_bytes - received[p], 0));
        }
    }
}

void ForkedRanks::count_beside(std::span<const Message> messages) {
    ++counts_.rounds;
    for (const Message& message : messages) {
        if (message.sent_bytes == 0) continue;
        const auto bytes = static_cast<std::int64_t>(message.sent_bytes);
        ++counts_.beside.messages, counts_.beside.bytes += bytes;
        ++traffic_.messages, traffic_.bytes += bytes;
    }
}

void ForkedRanks::count_everywhere(std::size_t own, std::size_t all) {
    ++counts_.rounds;
    ++counts_.everywhere.messages, counts_.everywhere.bytes += static_cast<std::int64_t>(own);
    ++traffic_.messages, traffic_.bytes += static_cast<std::int64_t>(own);
    counts_.received += static_cast<double>(all);
}

void ForkedRanks::exchange(std::span<const Message> messages) {
    count_beside(messages);
    transfer(messages);
}

void ForkedRanks::refresh(const Partition& cut, std::span<const Planes> arrays, int ghost_planes, bool ring) {
    const auto count = static_cast<std::size_t>(ranks());
    std::vector<std::vector<char>> sent(count), received(count);
    std::vector<Message> messages;
    const auto each = [&](int from, int to, auto&& f) {
        for (const Planes& planes : arrays)
            for (const PlaneRange& range : halo_from(cut, from, to, planes.count, ghost_planes, ring))
                f(static_cast<char*>(planes.first) + static_cast<std::ptrdiff_t>(planes.bytes) * range.begin,
                  planes.bytes * static_cast<std::size_t>(range.end - range.begin));
    };
    for (int peer = 0; peer < ranks(); ++peer) {
        if (peer == rank()) continue;
        auto &out = sent[static_cast<std::size_t>(peer)], &in = received[static_cast<std::size_t>(peer)];
        each(rank(), peer, [&](char* at, std::size_t bytes) { out.insert(out.end(), at, at + bytes); });
        each(peer, rank(), [&](char*, std::size_t bytes) { in.resize(in.size() + bytes); });
        messages.push_back({peer, out.data(), out.size(), in.data(), in.size()});
    }
    exchange(messages);
    for (int peer = 0; peer < ranks(); ++peer) {
        const char* next = received[static_cast<std::size_t>(peer)].data();
        if (peer != rank()) each(peer, rank(), [&](char* at, std::size_t bytes) { std::memcpy(at, next, bytes), next += bytes; });
    }
    if (!poisons_) return;
    for (const Planes& planes : arrays) poison_stale_ghosts(cut, *this, planes, ghost_planes, ring);
}

/// Every rank gets the entries [begins[r], begins[r + 1]) of each rank r.
void ForkedRanks::all_to_all(void* entries, std::size_t bytes, std::span<const std::size_t> begins) {
    auto* all = static_cast<char*>(entries);
    const auto part = [&](int r) { return bytes * begins[static_cast<std::size_t>(r)]; };
    std::vector<Message> messages;
    for (int r = 0; r < ranks(); ++r)
        if (r != rank()) messages.push_back({r, all + part(rank()), part(rank() + 1) - part(rank()), all + part(r), part(r + 1) - part(r)});
    count_everywhere(part(rank() + 1) - part(rank()), part(ranks()));
    transfer(messages);
}

void ForkedRanks::gather(const Partition& cut, const Planes& planes) {
    std::vector<std::size_t> begins;
    for (int r = 0; r < ranks(); ++r) begins.push_back(static_cast<std::size_t>(std::min(cut.begin(r), planes.count)));
    begins.push_back(static_cast<std::size_t>(planes.count));
    all_to_all(planes.first, planes.bytes, begins);
}

void ForkedRanks::gather_parts(void* entries, std::size_t bytes, std::span<const std::size_t> begins) {
    all_to_all(entries, bytes, begins);
}

void ForkedRanks::stream_to_first(const void* own, std::size_t bytes, const std::function<void(const void*, std::size_t)>& sink) {
    const std::vector<std::size_t> sizes = of_ranks(bytes);
    if (rank() == 0) sink(own, bytes);
    for (int r = 1; r < ranks(); ++r) {
        std::vector<char> room(rank() == 0 ? sizes[static_cast<std::size_t>(r)] : 0);
        const Message to_first{0, own, bytes, nullptr, 0}, from{r, nullptr, 0, room.data(), room.size()};
        if (rank() == r) exchange({&to_first, 1});
        if (rank() == 0) transfer({&from, 1}), sink(room.data(), room.size());
    }
}

int ForkedRanks::largest(int value) {
    const std::vector<int> all = of_ranks(value);
    return *std::max_element(all.begin(), all.end());
}

std::vector<ForkedEnd> fork_ranks(int count, const std::function<std::string(ForkedRanks&)>& body, bool poisons, int seconds) {
    const auto n = static_cast<std::size_t>(count);
    Wires wires(n);
    std::fflush(nullptr);
    std::vector<pid_t> processes;
    for (std::size_t r = 0; r < n; ++r) {
        const pid_t process = fork();
        if (process == 0) be_rank(r, wires, body, poisons, seconds);
        if (process < 0) throw std::runtime_error("no process for a forked rank");
        processes.push_back(process);
    }
    wires.leave_to_parent();
    std::vector<ForkedEnd> ends(n);
    for (std::size_t r = 0; r < n; ++r) {
        ends[r].said = read_all(wires.pipes[r][0]);
        close(wires.pipes[r][0]);
    }
    for (std::size_t r = 0; r < n; ++r) {
        int status = 0;
        waitpid(processes[r], &status, 0);
        ends[r].status = WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
        if (WIFSIGNALED(status)) ends[r].said = "rank " + std::to_string(r) + " was ended by signal " + std::to_string(WTERMSIG(status));
    }
    return ends;
}

const ForkedEnd* cause_of_failure(const std::vector<ForkedEnd>& ends) {
    const ForkedEnd* cause = nullptr;
    for (const ForkedEnd& end : ends)
        if (end.status != 0 && (!cause || cause->status == peer_ended)) cause = &end;
    return cause;
}

}  // namespace weir
