// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#if !defined(_WIN32)
#include <pthread.h>
#include <signal.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <system_error>
#include <thread>

#include "interrupt.h"

namespace mcc::tool {
namespace {

/// The thread that waits for signals.
pthread_t waiting_thread;

/// Whether a thread has stopped for ever, because it caused a signal.
std::atomic<bool> has_stopped_thread{false};
static_assert(std::atomic<bool>::is_always_lock_free);  // a signal handler sets it

/// Signals that end a program from outside. SIGKILL and SIGSTOP cannot be caught.
constexpr int kEndings[] = {
    SIGHUP,    SIGINT, SIGQUIT, SIGTERM, SIGALRM, SIGUSR1, SIGUSR2, SIGVTALRM, SIGPROF, SIGXCPU,
#ifdef SIGPOLL
    SIGPOLL,
#endif
#ifdef SIGPWR
    SIGPWR,
#endif
#ifdef SIGSTKFLT
    SIGSTKFLT,
#endif
};

/// Signals that a thread causes by its own action, after which it cannot continue.
constexpr int kFaults[] = {SIGPIPE, SIGXFSZ, SIGSEGV, SIGBUS, SIGFPE,
                           SIGILL,  SIGABRT, SIGSYS,  SIGTRAP};

/// Also false when a sanitizer or profiler handles the signal, or when the program was started with
/// the signal ignored.
bool hasDefaultAction(int number) {
  struct sigaction now = {};
  return sigaction(number, nullptr, &now) == 0 && (now.sa_flags & SA_SIGINFO) == 0 &&
         now.sa_handler == SIG_DFL;
}

void endBy(int signal_number) {
  ::signal(signal_number, SIG_DFL);
  sigset_t set;
  sigemptyset(&set);
  sigaddset(&set, signal_number);
  ::raise(signal_number);  // to this thread, since another may take it too late
  pthread_sigmask(SIG_UNBLOCK, &set, nullptr);
  ::_exit(128 + signal_number);
}

/// Runs on the thread that caused the signal, or on any if another process sent it. It passes the
/// signal on to the waiting thread, because a signal handler may do no more. A thread that caused
/// it stops here; any other continues, because it may hold the lock that the waiting thread needs.
extern "C" void passOn(int number, siginfo_t* info, void* /*context*/) {
  const bool is_sent = info->si_code == SI_USER && info->si_pid != ::getpid();
  if (!is_sent) has_stopped_thread = true;
  pthread_kill(waiting_thread, number);
  while (!is_sent) ::pause();
}

/// Waits for one of the signals, removes the temporary files, and ends the process by that signal.
void waitAndEnd(const sigset_t& set, gltf::TemporaryFiles& files) {
  constexpr std::chrono::seconds kPatience(1);
  int number = 0;
  while (sigwait(&set, &number) != 0) {
  }
  // A thread that has stopped may hold the lock for ever; all others release it soon.
  const gltf::TemporaryFiles::Lock held =
      has_stopped_thread ? files.removeAllWithin(kPatience) : files.removeAll();
  endBy(number);
}

}  // namespace

void removeTemporariesOnSignals() {
  sigset_t endings;  // signals that are blocked in all threads
  sigset_t all;      // `endings` and the faults, which the waiting thread receives
  sigemptyset(&endings);
  for (const int number : kEndings) {
    if (hasDefaultAction(number)) sigaddset(&endings, number);
  }
#ifdef SIGRTMIN
  for (int number = SIGRTMIN; number <= SIGRTMAX; ++number) {
    if (hasDefaultAction(number)) sigaddset(&endings, number);
  }
#endif
  all = endings;
  for (const int number : kFaults) {
    if (hasDefaultAction(number)) sigaddset(&all, number);
  }
  gltf::TemporaryFiles& files = temporaryFiles();
  // The waiting thread starts with all these signals blocked; this thread and all later ones block
  // only the endings. A thread waits because a signal handler would not be allowed to remove files.
  pthread_sigmask(SIG_BLOCK, &all, nullptr);
  try {
    std::thread waiting([all, &files]() { waitAndEnd(all, files); });
    waiting_thread = waiting.native_handle();
    waiting.detach();
  } catch (const std::system_error&) {  // without the thread, signals end the process as usual
    pthread_sigmask(SIG_UNBLOCK, &all, nullptr);
    return;
  }
  struct sigaction action = {};
  action.sa_sigaction = passOn;
  action.sa_flags = SA_SIGINFO | SA_RESTART;
  sigfillset(&action.sa_mask);
  for (const int number : kFaults) {
    if (sigismember(&all, number) == 1) sigaction(number, &action, nullptr);
  }
  sigset_t faults = all;
  for (const int number : kEndings) sigdelset(&faults, number);
#ifdef SIGRTMIN
  for (int number = SIGRTMIN; number <= SIGRTMAX; ++number) sigdelset(&faults, number);
#endif
  pthread_sigmask(SIG_UNBLOCK, &faults, nullptr);
}

}  // namespace mcc::tool
#endif
