/* Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
 *
 * A library for LD_PRELOAD that lets one call of the system fail, as a disk that is full or broken
 * does. MCC_FAULT=KIND:NUMBER:ERROR: call NUMBER of a kind, counted from 1, fails with the number
 * ERROR. Kinds are open (of new files), write, fsync, close, rename and link; `short` stands for
 * writes that take one byte, and with `stop` a link is made, and the process stops itself
 * before it goes on. Standard streams count only for `write`. When the fault happens, the
 * file that MCC_FAULT_HIT names is created. */
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/types.h>
#include <unistd.h>

/* The function of the C library behind one of ours. Its type is made by memcpy(), because C has no
 * conversion from data to functions. */
#define REAL(result, name, ...)                 \
  static result (*real)(__VA_ARGS__);           \
  if (real == NULL) {                           \
    void* const found = dlsym(RTLD_NEXT, name); \
    memcpy(&real, &found, sizeof real);         \
  }

static int open_new(const char* path) {
  REAL(int, "open", const char*, int, ...)
  return real(path, O_WRONLY | O_CREAT, 0600);
}

/* Counts a call; whether it is the one to fail, with errno set. */
static int fails(const char* kind) {
  static int number_of_call = 0;
  static int is_reported = 0;
  const char* const fault = getenv("MCC_FAULT");
  const char* const hit = getenv("MCC_FAULT_HIT");
  char wanted[16];
  int number = 0;
  int failure = 0;
  if (fault == NULL || sscanf(fault, "%15[a-z]:%d:%d", wanted, &number, &failure) != 3) return 0;
  if (strcmp(wanted, kind) != 0 || __sync_add_and_fetch(&number_of_call, 1) != number) return 0;
  if (hit != NULL && !is_reported) {
    is_reported = 1;
    close(open_new(hit));
  }
  errno = failure;
  return 1;
}

int open(const char* path, int flags, ...) {
  mode_t mode = 0;
  va_list list;
  REAL(int, "open", const char*, int, ...)
  va_start(list, flags);
  if ((flags & O_CREAT) != 0) mode = va_arg(list, mode_t);
  va_end(list);
  if ((flags & O_CREAT) != 0 && fails("open")) return -1;
  return real(path, flags, mode);
}

ssize_t write(int file, const void* from, size_t byte_count) {
  REAL(ssize_t, "write", int, const void*, size_t)
  if (fails("write")) return -1;
  if (byte_count > 1 && file > STDERR_FILENO && fails("short")) byte_count = 1;
  return real(file, from, byte_count);
}

int fsync(int file) {
  REAL(int, "fsync", int)
  return fails("fsync") ? -1 : real(file);
}

/* Closes in any case, as the system does. */
int close(int file) {
  REAL(int, "close", int)
  const int is_closed = real(file);
  return file > STDERR_FILENO && fails("close") ? -1 : is_closed;
}

int rename(const char* from, const char* to) {
  REAL(int, "rename", const char*, const char*)
  return fails("rename") ? -1 : real(from, to);
}

int link(const char* from, const char* to) {
  REAL(int, "link", const char*, const char*)
  if (fails("link")) return -1;
  const int failure = real(from, to);
  if (failure == 0 && fails("stop")) kill(getpid(), SIGSTOP);
  return failure;
}
