// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "parse.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <variant>

#include "host/text.h"

namespace mcc::tool {
namespace {

// CLI11's own validators and typed options would take longer to compile than the rest of the
// program.

/// Returns what is wrong with a whole number, or an empty string.
std::string wrongInteger(const Limits& limits, const std::string& text) {
  uint64_t number = 0;
  const bool is_number = CLI::detail::lexical_cast(text, number);
  const bool is_inside = is_number && number >= limits.low && number <= limits.high;
  const std::string range = std::to_string(limits.low) + " to " + std::to_string(limits.high);
  if (limits.kind == Limits::kIntegers) {
    return is_inside ? "" : "Value " + text + " not in range " + range;
  }
  return is_inside || (is_number && number == 0) ? "" : text + " is not 0 or " + range;
}

/// The same for any number.
std::string wrongReal(const Limits& limits, const std::string& text) {
  double number = 0;
  const bool is_number = CLI::detail::lexical_cast(text, number);
  if (limits.kind == Limits::kAboveZero) {
    return is_number && number > 0 ? "" : text + " is not greater than 0";
  }
  if (is_number && number >= limits.real_low && number <= limits.real_high) return "";
  return "Value " + text + " not in range " + std::to_string(limits.real_low) + " to " +
         std::to_string(limits.real_high);
}

std::string wrongNumber(const Limits& limits, const std::string& text) {
  const bool is_integer =
      limits.kind == Limits::kIntegers || limits.kind == Limits::kZeroOrIntegers;
  return is_integer ? wrongInteger(limits, text) : wrongReal(limits, text);
}

/// Puts the number of a word, in upper or lower case, in its place. Numbers are accepted, too.
bool replaceByNumber(const std::vector<Word>& words, std::string& text) {
  for (const Word& word : words) {
    if (CLI::detail::to_lower(word.text) != CLI::detail::to_lower(text)) continue;
    text = std::to_string(word.number);
    return true;
  }
  return std::any_of(words.begin(), words.end(),
                     [&](const Word& word) { return std::to_string(word.number) == text; });
}

/// Returns an error if the words of the option do not include this one; usageErrorText() has a
/// better text.
std::string acceptWord(const Option& option, std::string& text) {
  const auto is_it = [&](const Word& word) { return word.text == text; };
  const bool is_known = option.pick ? replaceByNumber(option.words, text)
                                    : std::any_of(option.words.begin(), option.words.end(), is_it);
  return is_known ? "" : text + " is unknown";
}

template <class Value>
bool readAll(const CLI::results_t& texts, Value& value) {
  return CLI::detail::lexical_assign<Value, Value>(texts[0], value);
}

bool readAll(const CLI::results_t& texts, uint8_t& value) {  // CLI11 would read a character
  int number = 0;
  if (!readAll(texts, number)) return false;
  value = static_cast<uint8_t>(number);
  return true;
}

template <class Value>
bool readAll(const CLI::results_t& texts, std::vector<Value>& values) {
  values.clear();
  for (const std::string& text : texts) {
    if (!readAll({text}, values.emplace_back())) return false;
  }
  return true;
}

/// Splits a list at its commas. A list is one word, so that names of files may follow it.
CLI::results_t listOf(const Option& option, const std::string& text) {
  CLI::results_t items = CLI::detail::split(text, ',');
  if (option.count == 0 || items.size() == static_cast<size_t>(option.count)) return items;
  throw UsageError(option.shownNames().back(), "takes " + std::to_string(option.count) +
                                                   " numbers with commas between them, " +
                                                   option.value + ", not " + text);
}

/// Returns whether the texts are what the option takes, and stores their value if they are.
bool store(const Option& option, const CLI::results_t& given) {
  const CLI::results_t texts = option.is_list ? listOf(option, given[0]) : given;
  if (option.pick) {
    int number = 0;
    if (!readAll(texts, number)) return false;
    option.pick(number);
    return true;
  }
  const bool is_read =
      std::visit([&](auto* target) { return readAll(texts, *target); }, option.target);
  if (is_read && option.then) option.then();
  return is_read;
}

bool takesMany(const Option& option) {
  return std::visit(
      [](auto* target) {
        return requires { target->emplace_back(); };
      },
      option.target);
}

CLI::Option* addTo(CLI::App& app, const Option& option) {
  if (option.isFlag())
    return app.add_flag(option.names, *std::get<bool*>(option.target), option.help);
  CLI::Option* added = app.add_option(
      option.names, [&option](const CLI::results_t& texts) { return store(option, texts); });
  if (takesMany(option) && !option.is_list) added->expected(CLI::detail::expected_max_vector_size);
  if (option.limits.kind != Limits::kNone) {
    added->check([&option](const std::string& text) { return wrongNumber(option.limits, text); });
  }
  if (!option.words.empty()) {
    added->transform(
        CLI::Validator([&option](std::string& text) { return acceptWord(option, text); }, ""));
  }
  return added;
}

void addOptions(CLI::App& app, const Command& command) {
  for (const Option& option : command.options) {
    if (option.names == "--version") {
      app.set_version_flag(option.names, "");
      continue;
    }
    CLI::Option* added = addTo(app, option);
    if (!option.isFlag()) added->type_name(option.value);
    if (option.is_required) added->required();
  }
  for (const Option& option : command.options) {
    for (const std::string& other : option.excludes) {
      app.get_option(option.names)->excludes(app.get_option(other));
    }
    if (!option.needs.empty()) app.get_option(option.names)->needs(app.get_option(option.needs));
  }
}

/// Finds the option that does not accept its word, if that is the failure. CLI11's own message
/// also lists the numbers of the words.
void findWrongWord(const CLI::App& app, Parsed& parsed) {
  for (const Option* option : parsed.command->shownOptions()) {
    const std::string name = option->shownNames().back();
    if (option->words.empty() || !parsed.message.starts_with(name + ": ")) continue;
    const CLI::Option* given = app.get_option_no_throw(name);
    if (given == nullptr || given->results().empty()) return;
    parsed.option = option;
    parsed.word = given->results().back();
    return;
  }
}

/// Returns "convert: IN is missing" or "--thread-count: N is missing" in place of CLI11's texts
/// about what a command or an option needs; empty if the failure is another one.
std::string missingText(const CLI::App& app, const Command& command,
                        const CLI::ParseError& failure) {
  const bool is_argument = dynamic_cast<const CLI::RequiredError*>(&failure) != nullptr;
  const bool is_value = dynamic_cast<const CLI::ArgumentMismatch*>(&failure) != nullptr;
  for (const Option& option : command.options) {
    const std::string name = option.names.substr(option.names.rfind(',') + 1);
    const CLI::Option* given = app.get_option_no_throw(name);
    if (given == nullptr) continue;
    const bool has_none = given->count() == 0;
    if (is_argument && option.is_required && has_none) {
      return command.name + ": " + name + " is missing";
    }
    const std::string what = failure.what();
    const bool is_of_it = what.starts_with(name + ": ") && what.ends_with(" missing");
    if (is_value && is_of_it) return name + ": " + option.value + " is missing";
  }
  return "";
}

const Command* chosenOf(const CLI::App& app, const Program& program) {
  const std::vector<CLI::App*> chosen = app.get_subcommands();
  if (chosen.empty()) return nullptr;
  for (const Command& command : program.commands) {
    if (command.name == chosen[0]->get_name()) return &command;
  }
  return nullptr;
}

}  // namespace

namespace {

/// Whether a word is the name of an option that may come alone, which has to get `value` then.
bool mayComeAlone(const Program& program, const std::string& word, std::string& value) {
  for (const Command& command : program.commands) {
    for (const Option& option : command.options) {
      if (option.when_alone.empty() || option.shownNames().back() != word) continue;
      value = option.when_alone;
      return true;
    }
  }
  return false;
}

/// Whether the word after an option that may come alone is its value, even a wrong one: a number, a
/// fraction, a number of pixels, or what can be neither an option nor the name of a file.
bool isValue(const std::string& word) {
  const size_t sign = word.starts_with('-') ? 1 : 0;
  std::string_view number = std::string_view(word).substr(sign);
  if (number.ends_with("px")) number.remove_suffix(2);
  if (!number.empty() && number.find_first_not_of("0123456789/.") == std::string_view::npos)
    return true;
  if (sign != 0 || word.find_first_of("./\\") != std::string::npos) return false;
  std::error_code ignored;
  return !word.empty() && !std::filesystem::exists(gltf::pathOf(word), ignored);
}

/// Gives options that come alone their values. CLI11 would take the next word, a file, for one.
std::vector<std::string> withValues(const Program& program, const std::vector<std::string>& words) {
  std::vector<std::string> all;
  bool are_names = false;  // after "--"
  for (size_t i = 0; i < words.size(); ++i) {
    all.push_back(words[i]);
    are_names |= words[i] == "--";
    std::string value;
    if (are_names || !mayComeAlone(program, words[i], value)) continue;
    const bool has_value = i + 1 != words.size() && isValue(words[i + 1]);
    all.back() += "=" + (has_value ? words[++i] : value);
  }
  return all;
}

}  // namespace

Parsed parse(const Program& program, const std::vector<std::string>& words) {
  CLI::App app;
  app.allow_windows_style_options(false);  // "/models/a.glb" is a file there, too
  addOptions(app, program.root);
  app.require_subcommand(1);
  for (const Command& command : program.commands) {
    addOptions(*app.add_subcommand(command.name), command);
  }
  Parsed parsed;
  try {
    const std::vector<std::string> all = withValues(program, words);
    app.parse(std::vector<std::string>(all.rbegin(), all.rend()));  // CLI11 takes the last first
    parsed.command = chosenOf(app, program);
    return parsed;
  } catch (const CLI::CallForHelp&) {
    parsed.kind = Parsed::kHelp;
  } catch (const CLI::CallForVersion&) {
    parsed.kind = Parsed::kVersion;
  } catch (const CLI::ParseError& failure) {
    parsed.kind = Parsed::kWrong;
    parsed.message = failure.what();
    parsed.command = chosenOf(app, program);
    if (dynamic_cast<const CLI::ExtrasError*>(&failure) != nullptr) {
      parsed.left_over = app.remaining(true);
    }
    if (parsed.command != nullptr) {
      const CLI::App& chosen = *app.get_subcommand(parsed.command->name);
      const bool is_of_value = dynamic_cast<const CLI::ValidationError*>(&failure) != nullptr;
      if (is_of_value) findWrongWord(chosen, parsed);
      const std::string missing = missingText(chosen, *parsed.command, failure);
      if (!missing.empty()) parsed.message = missing;
    }
  } catch (const UsageError& failure) {
    parsed.kind = Parsed::kWrong;
    parsed.message = failure.what();
  }
  parsed.command = chosenOf(app, program);
  return parsed;
}

}  // namespace mcc::tool
