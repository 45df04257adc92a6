// Interruption by SIGINT (Ctrl-C), SIGTERM and SIGHUP.
//
// The handler only sets a flag; long work checks it at least every tenth of a second and unwinds
// with an exception, so that files are closed and locks released. A second signal ends the process
// at once.
#pragma once

namespace svdag {

// Thrown by check_interrupt(); not an Error, for nothing went wrong. main() exits with 128 + n.
struct Interrupted {
  int signal;
  bool resumable = false;     // set by who catches it and has saved work
  const char* how = nullptr;  // to resume, where the program's own words for it do not hold
};

// Installs the handlers. Once, from main().
void catch_interrupts();
// Throws Interrupted if a signal has arrived. Cheap: one relaxed load.
void check_interrupt();
// For tests: pretends that `signal` arrived (0: none).
void pretend_interrupt(int signal);

}  // namespace svdag
