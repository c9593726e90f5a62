// Ctrl-C and SIGTERM are counted, not handled at once: the run ends where nothing is lost.
#pragma once

namespace weir::app {

/// 128 + the first signal, as shells expect: 130 after Ctrl-C, 143 after SIGTERM.
int exit_interrupted();

/// From here on SIGINT and SIGTERM are counted; a file that grows past a limit is an error of its write, not a signal. In parallel they
/// count twice, since mpirun gives its processes little time after it was interrupted itself; SIGUSR1 counts once.
void catch_interrupts(bool in_parallel = false);
int interruptions();
/// What was to be written is written: from here on they end the program.
void release_interrupts();

}  // namespace weir::app
