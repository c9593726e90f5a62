// A bound on the number of threads for the loops of one thread.
#pragma once

namespace weir {

/// More than any machine has. libgomp keeps an array per thread on its stack; a hundred thousand threads overflow it.
inline constexpr int most_threads = 1024;

/// True after set_threads(count > 0): that number is used as it is.
bool thread_count_is_set();

/// Scope in which loops of the calling thread use at most `most` threads. No effect where thread_count_is_set().
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
