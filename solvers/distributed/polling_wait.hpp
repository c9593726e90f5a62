// How a rank waits for others. A rank that polls on a processor of its own sees a message at once. Where other processes are busy too, a
// rank that polls uses up its share of the processor, and then does not run when the message arrives: it must sleep instead.
#pragma once
#include <chrono>
#include <ctime>
#include <thread>

namespace weir::distributed {

class PollingWait {
public:
    /// longest: how long a wait polls before it sleeps, on a processor of its own.
    explicit PollingWait(std::chrono::microseconds longest) : longest_(longest) {}

    /// Returns when done() is true: polls, then sleeps between polls. After a wait in which other processes had the processor, waits sleep
    /// at once, for a second.
    template <class Done>
    void until(Done&& done) {
        if (done()) return;
        const auto start = clock::now();
        if (start >= busy_until_ && poll(start, done)) return;
        while (!done()) std::this_thread::sleep_for(nap);
    }
    /// The time so far in which waits slept at once, because other processes were busy [s].
    double busy_seconds() const {
        const auto now = clock::now();
        const auto to_come = busy_until_ > now ? busy_until_ - now : clock::duration::zero();
        return std::chrono::duration<double>(busy_ - to_come).count();
    }

    static constexpr std::chrono::microseconds nap{20};
    /// A poll lost the processor to another process where so much of its time was not its own: processes take turns of some milliseconds;
    /// interrupts take some ten microseconds. Waits that poll for less than that waste little, and go on as they are.
    static constexpr std::chrono::microseconds lost{500};
    static constexpr std::chrono::seconds busy{1};

private:
    using clock = std::chrono::steady_clock;
    static double processor_seconds() {
        timespec t{};
        clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
        return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
    }
    /// Whether it was done before the polls were over.
    template <class Done>
    bool poll(clock::time_point start, Done& done) {
        const double before = processor_seconds();
        bool is_done = false;
        auto now = start;
        for (; !is_done && now - start < longest_; now = clock::now())
            if (!(is_done = done())) std::this_thread::yield();  // to the rank that is waited for, where there are more than processors
        const std::chrono::duration<double> own(processor_seconds() - before);
        if (longest_ > lost && now - start - own > lost) busy_until_ = now + busy, busy_ += busy;
        return is_done;
    }

    std::chrono::microseconds longest_;
    clock::time_point busy_until_{};
    clock::duration busy_{};
};

}  // namespace weir::distributed
