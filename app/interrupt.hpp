// Ctrl-C and SIGTERM are counted, not obeyed at once: the run ends where nothing is lost.
#pragma once

namespace weir::app {

/// 128 + the first signal, as shells expect: 130 after Ctrl-C, 143 after SIGTERM.
int exit_interrupted();

/// From here on SIGINT and SIGTERM are counted; a file that grows past a limit is an error of its write, not a signal.
void catch_interrupts();
int interruptions();

}  // namespace weir::app
