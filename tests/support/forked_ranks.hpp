// Ranks for a unit test without MPI: the test forks a process for each, which exchange through sockets between each two. Of Communicator
// they have all but the gathering of planes.
#pragma once
#include "core/parallel.hpp"
#include "parallel/communicator.hpp"
#include "support/test.hpp"

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <functional>
#include <memory>
#include <stdexcept>
#include <vector>

#include <fcntl.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

namespace weir::test {

class ForkedSlabs final : public Communicator {
public:
    /// peers: a socket to each rank.
    ForkedSlabs(int rank, std::vector<int> peers, bool poisons)
        : Communicator(rank, static_cast<int>(peers.size())), peers_(std::move(peers)), poisons_(poisons) {
        for (const int socket : peers_)
            if (socket >= 0) fcntl(socket, F_SETFL, fcntl(socket, F_GETFL) | O_NONBLOCK);
    }
    ~ForkedSlabs() override {
        for (const int socket : peers_)
            if (socket >= 0) close(socket);
    }

    void exchange(std::span<const Message> messages) override {
        std::vector<std::size_t> sent(messages.size(), 0), received(messages.size(), 0);
        for (const Message& message : messages)
            if (message.sent_bytes > 0) ++traffic_.messages, traffic_.bytes += static_cast<std::int64_t>(message.sent_bytes);
        for (;;) {
            std::vector<pollfd> open;
            for (std::size_t p = 0; p < messages.size(); ++p) {
                const auto events = static_cast<short>((sent[p] < messages[p].sent_bytes ? POLLOUT : 0) |
                                                       (received[p] < messages[p].received_bytes ? POLLIN : 0));
                open.push_back({events ? socket_of(messages[p]) : -1, events, 0});
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
    void gather_parts(void* entries, std::size_t bytes, std::span<const std::size_t> begins) override {
        auto* all = static_cast<char*>(entries);
        const auto part = [&](int r) { return bytes * begins[static_cast<std::size_t>(r)]; };
        std::vector<Message> messages;
        for (int r = 0; r < ranks(); ++r)
            if (r != rank())
                messages.push_back({r, all + part(rank()), part(rank() + 1) - part(rank()), all + part(r), part(r + 1) - part(r)});
        exchange(messages);
    }
    void stream_to_first(const void* own, std::size_t bytes, const std::function<void(const void*, std::size_t)>& sink) override {
        const std::vector<std::size_t> sizes = of_ranks(bytes);
        if (rank() == 0) sink(own, bytes);
        for (int r = 1; r < ranks(); ++r) {
            std::vector<char> room(rank() == 0 ? sizes[static_cast<std::size_t>(r)] : 0);
            const Message to_first{0, own, bytes, nullptr, 0}, from{r, nullptr, 0, room.data(), room.size()};
            if (rank() == r) exchange({&to_first, 1});
            if (rank() == 0) exchange({&from, 1}), sink(room.data(), room.size());
        }
    }
    int largest(int value) override {
        const std::vector<int> all = of_ranks(value);
        return *std::max_element(all.begin(), all.end());
    }
    bool poisons() const override { return poisons_; }

    void refresh(const Partition& cut, std::span<const Planes> arrays, int ghost_planes, bool ring) override {
        for (const Planes& planes : arrays) refresh_one(cut, planes, ghost_planes, ring);
    }
    void gather(const Partition&, const Planes&) override { throw std::logic_error("forked ranks gather no planes"); }

private:
    int socket_of(const Message& message) const { return peers_[static_cast<std::size_t>(message.peer)]; }
    static void advance(std::size_t& done, ssize_t bytes) {
        if (bytes > 0) done += static_cast<std::size_t>(bytes);
        if (bytes == 0 || (bytes < 0 && errno != EAGAIN && errno != EINTR)) throw std::runtime_error("another rank has ended");
    }
    void refresh_one(const Partition& cut, const Planes& planes, int ghost_planes, bool ring) {
        const auto count = static_cast<std::size_t>(ranks());
        std::vector<std::vector<char>> sent(count), received(count);
        std::vector<Message> messages;
        const auto each = [&](int from, int to, auto&& f) {
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
    }

    std::vector<int> peers_;
    bool poisons_;
};

/// body() as each of `count` ranks, each in a process of its own with one thread; what it expects in vain fails the test.
inline void on_ranks(int count, const std::function<void()>& body, bool poisons = false) {
    const auto n = static_cast<std::size_t>(count);
    std::vector<std::vector<int>> sockets(n, std::vector<int>(n, -1));
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = 0; j < i; ++j) {
            std::array<int, 2> pair{};
            ASSERT_EQ(socketpair(AF_UNIX, SOCK_STREAM, 0, pair.data()), 0);
            sockets[i][j] = pair[0], sockets[j][i] = pair[1];
        }
    const auto close_all_but = [&](std::size_t kept) {
        for (std::size_t i = 0; i < n; ++i)
            for (const int socket : sockets[i])
                if (i != kept && socket >= 0) close(socket);
    };
    std::fflush(nullptr);
    std::vector<pid_t> processes;
    for (std::size_t r = 0; r < n; ++r) {
        const pid_t process = fork();
        ASSERT_GE(process, 0);
        if (process > 0) {
            processes.push_back(process);
            continue;
        }
        alarm(120);  // ends a rank that waits for one that has ended
        close_all_but(r);
        set_threads(1);
        set_communicator(std::make_unique<ForkedSlabs>(static_cast<int>(r), sockets[r], poisons));
        try {
            body();
        } catch (const std::exception& failure) {
            ADD_FAILURE() << "rank " << r << ": " << failure.what();
        }
        std::fflush(nullptr);
        _exit(testing::Test::HasFailure() ? 1 : 0);
    }
    close_all_but(n);
    for (std::size_t r = 0; r < n; ++r) {
        int status = 0;
        waitpid(processes[r], &status, 0);
        EXPECT_EQ(status, 0) << "rank " << r << " of " << count;
    }
}

}  // namespace weir::test
