#include "app/progress.hpp"

#include <algorithm>
#include <cstdio>

#include <unistd.h>

namespace weir::app {

namespace {

std::string clock_text(double seconds) {
    const auto s = static_cast<long long>(seconds + 0.5);
    char text[48];
    if (s >= 3600)
        std::snprintf(text, sizeof text, "%lld:%02lld:%02lld", s / 3600, s / 60 % 60, s % 60);
    else
        std::snprintf(text, sizeof text, "%lld:%02lld", s / 60, s % 60);
    return text;
}

}  // namespace

std::string progress_line(real start, real t, real end, std::int64_t steps, double seconds) {
    constexpr int width = 24;
    const real done = std::clamp((t - start) / std::max(end - start, std::numeric_limits<real>::min()), 0.0, 1.0);
    const int full = static_cast<int>(done * width);
    char text[200];
    std::snprintf(text, sizeof text, "[%s%s] %3.0f%%  t %.4g / %.4g s  %.1f steps/s  %s left  %.3gx real time",
                  std::string(full, '#').c_str(), std::string(width - full, '.').c_str(), 100 * done, t, end,
                  static_cast<double>(steps) / std::max(seconds, 1e-9), done > 0 ? clock_text(seconds * (1 - done) / done).c_str() : "?",
                  (t - start) / std::max(seconds, 1e-9));
    return text;
}

Progress::Progress(real start, real end, bool quiet) : start_(start), end_(end), visible_(!quiet && isatty(STDERR_FILENO)) {}

void Progress::show(real t, std::int64_t) {
    ++steps_;
    if (!visible_) return;
    const auto now = clock::now();
    if (now - shown_ < std::chrono::milliseconds(100) && t < end_) return;
    shown_ = now;
    std::fprintf(stderr, "\r%s\x1b[K", progress_line(start_, t, end_, steps_, std::chrono::duration<double>(now - begun_).count()).c_str());
    std::fflush(stderr);
}

void Progress::end() {
    if (visible_ && steps_ > 0) std::fputc('\n', stderr);
    visible_ = false;
}

}  // namespace weir::app
