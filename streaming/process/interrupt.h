// Interruption by SIGINT (Ctrl-C), SIGTERM and SIGHUP.
//
// The handler only sets a flag. Long work checks it at least ten times a second and unwinds with an
// exception, so that files are closed and locks released. A second signal ends the process at once.
#pragma once

namespace svdag {

// Thrown by check_interrupt(). Not an Error, because nothing failed: run_program() exits with
// 128 + signal.
struct Interrupted {
  int signal;
  bool resumable = false;                // set by a catch block that has saved work
  const char* resume_message = nullptr;  // then: how to continue; replaces ProgramMessages::stopped
};

// Installs the handlers, except for signals that are ignored. Called once, by main().
void catch_interrupts();
// Throws Interrupted if a signal has arrived. Cheap: one relaxed load.
void check_interrupt();
// For tests: as if `signal` had arrived; 0 clears it.
void pretend_interrupt(int signal);

}  // namespace svdag
