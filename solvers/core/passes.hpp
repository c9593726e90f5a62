// Cost of the passes of a step, by name: calls, milliseconds, and a lower bound of the bytes moved. A pass times itself, so step functions
// stay free of clocks. Recording allocates only when a name appears for the first time.
#pragma once
#include <chrono>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace weir {

/// Accumulated cost of one named pass.
struct Pass {
    std::string name;
    std::int64_t calls = 0;
    double seconds = 0;
};

/// Called when each pass begins and ends: for tools that count per pass what a clock cannot. Not set in an ordinary run.
using PassWatch = void (*)(const Pass& pass, bool begins);
inline PassWatch pass_watch = nullptr;

class Passes {
public:
    /// Measures from its construction to its destruction.
    class Timer {
    public:
        explicit Timer(Passes& owner, std::size_t pass) : owner_(owner), pass_(pass), start_(clock::now()) {
            if (pass_watch) pass_watch(owner_.list_[pass_], true);
        }
        Timer(const Timer&) = delete;
        Timer& operator=(const Timer&) = delete;
        ~Timer() {
            Pass& p = owner_.list_[pass_];
            ++p.calls;
            p.seconds += std::chrono::duration<double>(clock::now() - start_).count();
            if (pass_watch) pass_watch(p, false);
        }

    private:
        using clock = std::chrono::steady_clock;
        Passes& owner_;
        std::size_t pass_;
        clock::time_point start_;
    };

    /// `const auto timed = passes.time("project");` as the first line of a pass.
    [[nodiscard]] Timer time(std::string_view name) { return Timer(*this, find(name)); }
    /// Adds calls that were timed elsewhere: by a device's own clock.
    void add(std::string_view name, double seconds, std::int64_t calls) {
        Pass& p = list_[find(name)];
        p.calls += calls;
        p.seconds += seconds;
    }
    const std::vector<Pass>& list() const { return list_; }
    void reset() {
        for (Pass& p : list_) p.calls = 0, p.seconds = 0;
    }

private:
    std::size_t find(std::string_view name) {
        for (std::size_t i = 0; i < list_.size(); ++i)
            if (list_[i].name == name) return i;
        list_.push_back({std::string(name), 0, 0});
        return list_.size() - 1;
    }
    std::vector<Pass> list_;
};

}  // namespace weir
