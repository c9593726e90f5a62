// How a rank waits for other ranks. A rank that polls on a processor of its own sees a message at once. Where other processes are busy too,
// a polling rank uses up its time slice and is not running when the message arrives: it must sleep instead.
#pragma once
#include <algorithm>
#include <chrono>
#include <ctime>
#include <thread>

namespace weir::distributed {

/// The clocks and pauses of a thread.
struct ThreadTimes {
    using duration = std::chrono::steady_clock::duration;
    static duration now() { return std::chrono::steady_clock::now().time_since_epoch(); }
    /// Processor time of this thread.
    static duration own() {
        timespec t{};
        clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
        return std::chrono::seconds(t.tv_sec) + std::chrono::nanoseconds(t.tv_nsec);
    }
    static void nap(std::chrono::microseconds time) { std::this_thread::sleep_for(time); }
    static void yield() { std::this_thread::yield(); }
};

/// Times: an interface like ThreadTimes.
template <class Times>
class PollingWaitBy {
public:
    /// longest: how long a wait polls before it sleeps, on a processor of its own.
    explicit PollingWaitBy(std::chrono::microseconds longest) : longest_(longest) {}

    /// Returns when done() is true: polls, then sleeps between polls. After a wait in which other processes used the processor, waits sleep
    /// at once for a while. A single loss costs little: the while is short, and doubles where polls lose the processor again soon after it.
    template <class Done>
    void until(Done&& done) {
        if (done()) return;
        const auto start = Times::now();
        if (start >= busy_until_ && poll(start, done)) return;
        while (!done()) Times::nap(nap);
    }
    /// Total time in which waits slept at once, because other processes were busy [s].
    double busy_seconds() const {
        const auto now = Times::now();
        const auto to_come = busy_until_ > now ? busy_until_ - now : duration::zero();
        return std::chrono::duration<double>(busy_ - to_come).count();
    }

    static constexpr std::chrono::microseconds nap{20};
    /// A poll that lost this much of its time lost the processor to another process: time slices are some milliseconds, interrupts some ten
    /// microseconds. Shorter polling waits waste little and stay unchanged.
    static constexpr std::chrono::microseconds lost{500};
    static constexpr std::chrono::milliseconds shortest_sleep{10}, longest_sleep{1000};

private:
    using duration = typename Times::duration;
    /// Returns whether done() became true while polling.
    template <class Done>
    bool poll(duration start, Done& done) {
        const duration before = Times::own();
        bool is_done = false;
        auto now = start;
        for (; !is_done && now - start < longest_; now = Times::now())
            if (!(is_done = done())) Times::yield();  // to the rank that is waited for, where there are more ranks than processors
        const duration own = Times::own() - before;
        if (longest_ > lost && now - start - own > lost) sleep_from(now);
        return is_done;
    }
    void sleep_from(duration now) {
        const bool again = sleep_ > duration::zero() && now < busy_until_ + sleep_;
        sleep_ = again ? std::min<duration>(2 * sleep_, longest_sleep) : duration(shortest_sleep);
        busy_until_ = now + sleep_, busy_ += sleep_;
    }

    std::chrono::microseconds longest_;
    duration busy_until_{}, sleep_{};  // waits sleep at once until then; for how long
    duration busy_{};
};

using PollingWait = PollingWaitBy<ThreadTimes>;

}  // namespace weir::distributed
