// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#if defined(_WIN32)
#if !defined(NOMINMAX)
#define NOMINMAX
#endif
#include <fcntl.h>
#include <io.h>
#include <process.h>
#include <windows.h>

#include <shellapi.h>

#include <atomic>
#include <cstdlib>

#include "console.h"

namespace mcc::tool {
namespace {

// What restoreConsole() puts back; it may run on the thread that handles Ctrl-C.
constexpr DWORD kUnchanged = ~DWORD{0};
std::atomic<UINT> code_page_before = 0;                                    ///< 0: unchanged
std::atomic<DWORD> modes_before[] = {kUnchanged, kUnchanged, kUnchanged};  ///< by stream

std::string inUtf8(const wchar_t* text) {
  const int byte_count =
      ::WideCharToMultiByte(CP_UTF8, 0, text, -1, nullptr, 0, nullptr, nullptr);  // with the zero
  if (byte_count <= 0) return {};
  std::string bytes(static_cast<size_t>(byte_count), '\0');
  ::WideCharToMultiByte(CP_UTF8, 0, text, -1, bytes.data(), byte_count, nullptr, nullptr);
  bytes.pop_back();
  return bytes;
}

/// Puts a word in quotes, as CommandLineToArgvW() and the C library take it for one word.
std::wstring quoted(const std::wstring& word) {
  std::wstring text = L"\"";
  size_t backslash_count = 0;
  for (const wchar_t c : word) {
    if (c == L'"') text.append(backslash_count + 1, L'\\');
    backslash_count = c == L'\\' ? backslash_count + 1 : 0;
    text += c;
  }
  return text.append(backslash_count, L'\\') + L'"';
}

std::wstring inWide(const std::string& text) {
  const int length = ::MultiByteToWideChar(CP_UTF8, 0, text.c_str(), -1, nullptr, 0);
  if (length <= 0) return {};
  std::wstring wide(static_cast<size_t>(length), L'\0');
  ::MultiByteToWideChar(CP_UTF8, 0, text.c_str(), -1, wide.data(), length);
  wide.pop_back();
  return wide;
}

HANDLE consoleOf(int stream) { return reinterpret_cast<HANDLE>(::_get_osfhandle(stream)); }

}  // namespace

void prepareConsole() {
  for (const int stream : {kStandardInput, kStandardOutput, kStandardErrors})
    ::_setmode(stream, _O_BINARY);
  std::atexit(restoreConsole);
  const UINT code_page = ::GetConsoleOutputCP();
  if (code_page == 0 || code_page == CP_UTF8) return;
  code_page_before = code_page;
  ::SetConsoleOutputCP(CP_UTF8);
}

void restoreConsole() {
  if (code_page_before != 0) ::SetConsoleOutputCP(code_page_before);
  for (const int stream : {kStandardInput, kStandardOutput, kStandardErrors}) {
    const DWORD mode = modes_before[stream];
    if (mode != kUnchanged) ::SetConsoleMode(consoleOf(stream), mode);
  }
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

std::optional<int> startProgram(const std::string& name, const std::vector<std::string>& words) {
  std::vector<std::wstring> line = {quoted(inWide(name))};
  for (const std::string& word : words) line.push_back(quoted(inWide(word)));
  std::vector<const wchar_t*> pointers;
  for (const std::wstring& word : line) pointers.push_back(word.c_str());
  pointers.push_back(nullptr);
  std::wstring self(32768, L'\0');  // the longest path there is
  self.resize(::GetModuleFileNameW(nullptr, self.data(), static_cast<DWORD>(self.size())));
  const std::wstring file = inWide(name) + L".exe";
  const std::wstring beside = self.substr(0, self.find_last_of(L'\\') + 1) + file;
  intptr_t status = ::_wspawnv(_P_WAIT, beside.c_str(), pointers.data());
  if (status == -1) status = ::_wspawnvp(_P_WAIT, file.c_str(), pointers.data());
  return status == -1 ? std::nullopt : std::optional<int>(static_cast<int>(status));
}

bool isTerminal(int stream) {
  DWORD mode = 0;
  return ::GetConsoleMode(consoleOf(stream), &mode) != 0;
}

bool isColorTerminal(int stream) {
  constexpr DWORD kEscapes = 0x0004;  // ENABLE_VIRTUAL_TERMINAL_PROCESSING, of Windows 10
  DWORD mode = 0;
  if (::GetConsoleMode(consoleOf(stream), &mode) == 0) return false;
  if ((mode & kEscapes) != 0) return true;  // perhaps by the other stream, which then restores it
  modes_before[stream] = mode;
  return ::SetConsoleMode(consoleOf(stream), mode | kEscapes) != 0;
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
