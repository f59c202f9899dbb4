// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "interrupt.h"

#include <pthread.h>
#include <signal.h>
#include <unistd.h>

#include <system_error>
#include <thread>

namespace mcc::tool {
namespace {

void endBy(int signal_number) {
  ::signal(signal_number, SIG_DFL);
  sigset_t set;
  sigemptyset(&set);
  sigaddset(&set, signal_number);
  ::kill(::getpid(), signal_number);
  pthread_sigmask(SIG_UNBLOCK, &set, nullptr);  // taken here: every other thread blocks it
  ::_exit(128 + signal_number);
}

}  // namespace

gltf::TemporaryFiles& temporaryFiles() {
  // Never destroyed: the thread below may still wait when main() has returned.
  static auto* const files = new gltf::TemporaryFiles();
  return *files;
}

void removeTemporariesOnSignals() {
  sigset_t set;
  sigemptyset(&set);
  for (const int number : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction before = {};
    const bool is_ignored =
        sigaction(number, nullptr, &before) == 0 && before.sa_handler == SIG_IGN;
    if (!is_ignored) sigaddset(&set, number);
  }
  gltf::TemporaryFiles& files = temporaryFiles();
  // Blocked here and in all threads to come, but for the one that waits for them: what it does there would not be
  // allowed in a handler.
  pthread_sigmask(SIG_BLOCK, &set, nullptr);
  try {
    std::thread([set, &files]() {
      int number = 0;
      if (sigwait(&set, &number) != 0) return;
      const gltf::TemporaryFiles::Lock held = files.removeAll();
      endBy(number);
    }).detach();
  } catch (const std::system_error&) {  // without the thread they end the process as ever
    pthread_sigmask(SIG_UNBLOCK, &set, nullptr);
  }
}

}  // namespace mcc::tool
