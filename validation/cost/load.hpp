// How busy others keep the machine while we measure: a time taken beside them is not the method's price.
#pragma once
#include <optional>

namespace weir::validation {

/// Core-seconds that the whole machine and this process have worked so far; zero where /proc/stat cannot be read.
struct Work {
    double machine = 0;
    double ours = 0;
    double wall = 0;
};
Work work_so_far();

/// Cores that others used between two readings, on average; never negative.
double others_between(const Work& from, const Work& to);

/// Seconds of computing, from some start: of this thread where it is the only one, which others do not lengthen; else by the clock on the
/// wall.
double computing_seconds();

/// Scope in which parallel loops take this number of threads; 0: as many as there are cores; no value: as before.
class ThreadsScope {
public:
    explicit ThreadsScope(std::optional<int> count);
    ~ThreadsScope();
    ThreadsScope(const ThreadsScope&) = delete;
    ThreadsScope& operator=(const ThreadsScope&) = delete;

private:
    bool set_;
    int before_ = 0;
};

}  // namespace weir::validation
