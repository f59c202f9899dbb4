// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// The only exception of the writer is that memory runs out. In builds without exceptions
// (WebAssembly) this ends the program, and the host has to notice it.
#ifndef MCC_BASE_ENC_EXCEPTIONS_H_
#define MCC_BASE_ENC_EXCEPTIONS_H_

#include <cstdlib>
#include <exception>
#include <new>

namespace mcc {

[[noreturn]] inline void throwBadAlloc() {
#if defined(__cpp_exceptions)
  throw std::bad_alloc();
#else
  std::abort();
#endif
}

/// Returns what function() returns, or what otherwise() returns when function() runs out of memory.
template <class Function, class Otherwise>
auto catchBadAlloc(const Function& function, [[maybe_unused]] const Otherwise& otherwise) {
#if defined(__cpp_exceptions)
  try {
    return function();
  } catch (const std::bad_alloc&) {
    return otherwise();
  }
#else
  return function();
#endif
}

/// Keeps what a job threw, so that it can be thrown again elsewhere.
class Thrown {
 public:
  template <class Job>
  void run(const Job& job) noexcept {
#if defined(__cpp_exceptions)
    try {
      job();
    } catch (...) {
      exception_ = std::current_exception();
    }
#else
    job();
#endif
  }
  void rethrow() const {
#if defined(__cpp_exceptions)
    if (exception_) std::rethrow_exception(exception_);
#endif
  }

 private:
#if defined(__cpp_exceptions)
  std::exception_ptr exception_;
#endif
};

}  // namespace mcc

#endif  // MCC_BASE_ENC_EXCEPTIONS_H_
