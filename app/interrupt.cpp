#include "app/interrupt.hpp"

#include <csignal>

#include <unistd.h>

namespace weir::app {

namespace {
volatile std::sig_atomic_t count = 0, first = SIGINT, hurries = 0;

extern "C" void count_signal(int signal) {
    static constexpr char once[] = "\ninterrupted: finishing this frame; a second interrupt stops after this step, a third at once\n";
    count = count + 1;
    if (count == 1) first = signal == SIGTERM ? SIGTERM : SIGINT;
    if (count == 1 && hurries && signal != SIGUSR1) count = 2;
    if (count == 1) [[maybe_unused]]
        const auto ignored = write(STDERR_FILENO, once, sizeof once - 1);
    if (count == 3) _exit(128 + first);
}

}  // namespace

void catch_interrupts(bool in_parallel) {
    hurries = in_parallel;
    struct sigaction action {};
    action.sa_handler = count_signal;
    sigaction(SIGINT, &action, nullptr);
    sigaction(SIGTERM, &action, nullptr);
    if (in_parallel) sigaction(SIGUSR1, &action, nullptr);
    std::signal(SIGXFSZ, SIG_IGN);
}

void release_interrupts() {
    if (hurries) return;  // in parallel (MPI) the ranks still leave together
    std::signal(SIGINT, SIG_DFL);
    std::signal(SIGTERM, SIG_DFL);
}

int interruptions() { return count; }

int exit_interrupted() { return 128 + first; }

}  // namespace weir::app
