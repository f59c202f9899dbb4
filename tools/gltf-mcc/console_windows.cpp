// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#if defined(_WIN32)
#if !defined(NOMINMAX)
#define NOMINMAX
#endif
#include <fcntl.h>
#include <io.h>
#include <windows.h>

#include <shellapi.h>

#include <cstdlib>

#include "console.h"

namespace mcc::tool {
namespace {

UINT code_page_before = 0;

std::string inUtf8(const wchar_t* text) {
  const int byte_count =
      ::WideCharToMultiByte(CP_UTF8, 0, text, -1, nullptr, 0, nullptr, nullptr);  // with the zero
  if (byte_count <= 0) return {};
  std::string bytes(static_cast<size_t>(byte_count), '\0');
  ::WideCharToMultiByte(CP_UTF8, 0, text, -1, bytes.data(), byte_count, nullptr, nullptr);
  bytes.pop_back();
  return bytes;
}

HANDLE consoleOf(int stream) { return reinterpret_cast<HANDLE>(::_get_osfhandle(stream)); }

}  // namespace

void prepareConsole() {
  for (const int stream : {kStandardInput, kStandardOutput, kStandardErrors})
    ::_setmode(stream, _O_BINARY);
  code_page_before = ::GetConsoleOutputCP();
  if (code_page_before == 0 || code_page_before == CP_UTF8) return;
  ::SetConsoleOutputCP(CP_UTF8);
  std::atexit([]() { ::SetConsoleOutputCP(code_page_before); });  // the console outlives us
}

/// The words that the C library passes to main() are in a code page that may lack their characters.
std::vector<std::string> commandLine(int argc, const char* const* argv) {
  int count = 0;
  wchar_t** words = ::CommandLineToArgvW(::GetCommandLineW(), &count);
  if (words == nullptr) return {argv, argv + argc};
  std::vector<std::string> line;
  for (int i = 0; i < count; ++i) line.push_back(inUtf8(words[i]));
  ::LocalFree(words);
  return line;
}

bool isTerminal(int stream) {
  DWORD mode = 0;
  return ::GetConsoleMode(consoleOf(stream), &mode) != 0;
}

bool isColorTerminal(int stream) {
  constexpr DWORD kEscapes = 0x0004;  // ENABLE_VIRTUAL_TERMINAL_PROCESSING, of Windows 10
  DWORD mode = 0;
  return ::GetConsoleMode(consoleOf(stream), &mode) != 0 &&
         ::SetConsoleMode(consoleOf(stream), mode | kEscapes) != 0;
}

size_t consoleColumns() {
  CONSOLE_SCREEN_BUFFER_INFO info = {};
  const bool is_known = ::GetConsoleScreenBufferInfo(consoleOf(kStandardErrors), &info) != 0;
  const int columns = is_known ? info.srWindow.Right - info.srWindow.Left + 1 : 0;
  return columns > 0 ? static_cast<size_t>(columns) : 0;
}

bool hasUtf8() { return true; }  // see prepareConsole()

}  // namespace mcc::tool
#endif
