#include "validation/cost/load.hpp"

#include "core/parallel.hpp"

#include <algorithm>
#include <chrono>
#include <fstream>
#include <string>

#include <sys/resource.h>
#include <time.h>
#include <unistd.h>

namespace weir::validation {

Work work_so_far() {
    Work w;
    std::ifstream stat("/proc/stat");
    std::string cpu;
    double user = 0, nice = 0, system = 0;  // in ticks of the clock
    if (stat >> cpu >> user >> nice >> system) w.machine = (user + nice + system) / static_cast<double>(sysconf(_SC_CLK_TCK));
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    const auto seconds = [](const timeval& t) { return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec); };
    w.ours = seconds(usage.ru_utime) + seconds(usage.ru_stime);
    w.wall = std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
    return w;
}

double computing_seconds() {
    timespec now{};
    clock_gettime(threads() == 1 ? CLOCK_THREAD_CPUTIME_ID : CLOCK_MONOTONIC, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

ThreadsScope::ThreadsScope(std::optional<int> count) : set_(count.has_value()) {
    if (count) before_ = set_threads(*count > 0 ? *count : omp_get_num_procs());
}

ThreadsScope::~ThreadsScope() {
    if (set_) set_threads(before_);
}

double others_between(const Work& from, const Work& to) {
    const double wall = to.wall - from.wall;
    return wall > 0 ? std::max(0.0, (to.machine - from.machine) - (to.ours - from.ours)) / wall : 0;
}

}  // namespace weir::validation
