// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Commands and their options, as data. parse.cpp, which alone knows CLI11, reads command lines by
// it; help, the man page, completions and messages are made from it.
#ifndef MCC_TOOL_OPTIONS_H_
#define MCC_TOOL_OPTIONS_H_

#include <cstdint>
#include <deque>
#include <functional>
#include <initializer_list>
#include <stdexcept>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace mcc::tool {

/// Wrong usage that shows only when the options are looked at together; thrown by Option::then and
/// Command::run.
class UsageError : public std::runtime_error {
 public:
  UsageError(const std::string& where, const std::string& what)
      : std::runtime_error(where + ": " + what) {}
};

/// Where the value of an option goes. bool is that of a flag; all others take a value.
using Target = std::variant<bool*, std::string*, uint8_t*, uint32_t*, uint64_t*, double*,
                            std::vector<std::string>*, std::vector<uint32_t>*, std::vector<float>*,
                            std::vector<double>*>;

/// Which numbers an option accepts.
struct Limits {
  enum Kind : uint8_t { kNone, kIntegers, kZeroOrIntegers, kReals, kAboveZero };
  Kind kind = kNone;
  uint64_t low = 0;  ///< of integers
  uint64_t high = 0;
  double real_low = 0;  ///< of reals
  double real_high = 0;
};
inline Limits between(uint64_t low, uint64_t high) { return {Limits::kIntegers, low, high, 0, 0}; }

/// A word that an option accepts, and what it stands for.
struct Word {
  std::string text;
  int number = 0;
};

struct Option {
  /// "-o,--output", short names first. A name without hyphens is that of an argument, which the
  /// usage line shows and the list of options does not.
  std::string names;
  std::string value;  ///< "FILE|DIR"
  std::string help;
  Target target;
  Limits limits;
  std::vector<Word> words;            ///< if it accepts only these
  std::function<void(int)> pick;      ///< gets the number of the word, in place of `target`
  std::function<void()> then;         ///< called when `target` is set
  std::vector<std::string> excludes;  ///< names of options of the same command
  std::string needs;                  ///< the name of an option without which this one has no sense
  int count = 0;                      ///< numbers in one value; 0: as many as there are
  /// What the value is when the name comes alone. The next word is the value if it is a number, a
  /// fraction or a number of pixels, or if it can be neither an option nor the name of a file.
  std::string when_alone;
  bool is_list = false;  ///< numbers are separated by commas
  bool is_required = false;
  bool is_hidden = false;  ///< help does not list it

  bool isFlag() const { return !pick && std::holds_alternative<bool*>(target); }
  bool takesFile() const;
  /// Names with hyphens; none for an argument.
  std::vector<std::string> shownNames() const;
};

struct Command {
  std::string name;
  std::string summary;
  std::string usage;     ///< what follows "gltf-mcc", one line for each way to call the command
  std::string text;      ///< between the options and the examples; may be empty
  std::string examples;  ///< what follows "gltf-mcc", one line each
  std::deque<Option> options;  ///< a deque, because references to options stay valid
  /// Returns the exit status. Empty: the command is a program of its own, gltf-mcc-NAME.
  std::function<int()> run;

  Option& add(const char* names, const char* value, Target target, std::string help);
  Option& addFlag(const char* names, bool& target, const char* help);
  /// An option that accepts these words, as they are written here or, when `target` is an enum, in
  /// any case.
  Option& addWords(const char* names, std::string& target, std::initializer_list<const char*> words,
                   const char* help);
  template <class Enum>
  Option& addWords(const char* names, Enum& target,
                   std::initializer_list<std::pair<const char*, Enum>> words, const char* help) {
    Option& option = add(names, "", {}, help);
    for (const auto& [word, number] : words) addWord(option, {word, static_cast<int>(number)});
    option.pick = [&target](int number) { target = static_cast<Enum>(number); };
    return option;
  }
  Option& find(const std::string& names_of);
  /// Options that help lists, in its order, with --help.
  std::vector<const Option*> shownOptions() const;

 private:
  static void addWord(Option& option, Word word);
};

/// gltf-mcc, or one of the programs beside it.
struct Program {
  Command root;  ///< what gltf-mcc itself says and takes, before a command
  std::deque<Command> commands;
};

}  // namespace mcc::tool

#endif  // MCC_TOOL_OPTIONS_H_
