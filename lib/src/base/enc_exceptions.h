// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Exceptions of the writer, of which there is one: no memory. Where there are none (WebAssembly), it ends the program, and
// whoever runs that has to notice.
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

/// What function() returns or, without the memory that takes, what otherwise() does.
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

/// What a job threw, to be thrown again elsewhere.
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
