// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#if !defined(_WIN32)
#include <sys/ioctl.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <string_view>

#include "console.h"

namespace mcc::tool {
namespace {

std::string_view environment(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? "" : value;
}

}  // namespace

void prepareConsole() {}

void restoreConsole() {}

std::vector<std::string> commandLine(int argc, const char* const* argv) {
  return {argv, argv + argc};
}

std::optional<int> startProgram(const std::string& name, const std::vector<std::string>& words) {
  std::vector<std::string> line = {name};
  line.insert(line.end(), words.begin(), words.end());
  std::vector<char*> pointers;
  for (std::string& word : line) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  std::error_code code;
  const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", code);
  if (!code) ::execv((self.parent_path() / name).c_str(), pointers.data());
  ::execvp(name.c_str(), pointers.data());
  return std::nullopt;
}

bool isTerminal(int stream) { return ::isatty(stream) == 1; }

bool isColorTerminal(int stream) {
  const std::string_view terminal = environment("TERM");
  return !terminal.empty() && terminal != "dumb" && isTerminal(stream);
}

size_t consoleColumns() {
  winsize size = {};
  return ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 ? size.ws_col : 0;
}

bool hasUtf8() {
  for (const char* name : {"LC_ALL", "LC_CTYPE", "LANG"}) {  // the first that is set applies
    std::string value(environment(name));
    if (value.empty()) continue;
    for (char& c : value) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    return value.find("utf-8") != std::string::npos || value.find("utf8") != std::string::npos;
  }
  return false;
}

}  // namespace mcc::tool
#endif
