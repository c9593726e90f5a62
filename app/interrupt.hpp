// Ctrl-C and SIGTERM are counted, not obeyed at once: the run ends where nothing is lost.
#pragma once

namespace weir::app {

inline constexpr int exit_interrupted = 130;  // 128 + SIGINT, as shells expect

/// From here on SIGINT and SIGTERM are counted; a file that grows past a limit is an error of its write, not a signal.
void catch_interrupts();
int interruptions();

}  // namespace weir::app
