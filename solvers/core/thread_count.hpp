// A bound on the number of threads, for the loops of one thread.
#pragma once

namespace weir {

/// More than any machine has; libgomp keeps them on its stack, and of a hundred thousand the stack overflows.
inline constexpr int most_threads = 1024;

/// True after set_threads(count > 0): that number is used as it is.
bool thread_count_is_set();

/// While it lives, loops of the calling thread use at most `most` threads. Without effect where thread_count_is_set().
class ThreadCountScope {
public:
    explicit ThreadCountScope(int most);
    ~ThreadCountScope();
    ThreadCountScope(const ThreadCountScope&) = delete;
    ThreadCountScope& operator=(const ThreadCountScope&) = delete;

private:
    int before_;
};

}  // namespace weir
