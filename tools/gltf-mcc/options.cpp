// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "options.h"

#include <algorithm>

namespace mcc::tool {

bool Option::takesFile() const {
  return value.find("FILE") != std::string::npos || value.find("DIR") != std::string::npos ||
         value.starts_with("OUT");
}

std::vector<std::string> Option::shownNames() const {
  std::vector<std::string> shown;
  for (size_t begin = 0; begin <= names.size();) {
    const size_t end = std::min(names.find(',', begin), names.size());
    if (names[begin] == '-') shown.push_back(names.substr(begin, end - begin));
    begin = end + 1;
  }
  return shown;
}

Option& Command::add(const char* names, const char* value, Target target, std::string help) {
  Option& option = options.emplace_back();
  option.names = names;
  option.value = value;
  option.target = target;
  option.help = std::move(help);
  return option;
}

Option& Command::addFlag(const char* names, bool& target, const char* help) {
  return add(names, "", &target, help);
}

Option& Command::addWords(const char* names, std::string& target,
                          std::initializer_list<const char*> words, const char* help) {
  Option& option = add(names, "", &target, help);
  for (const char* word : words) addWord(option, {word, 0});
  return option;
}

void Command::addWord(Option& option, Word word) {
  option.value += (option.value.empty() ? "" : "|") + word.text;
  option.words.push_back(std::move(word));
}

Option& Command::find(const std::string& names_of) {
  return *std::find_if(options.begin(), options.end(),
                       [&](const Option& option) { return option.names == names_of; });
}

std::vector<const Option*> Command::shownOptions() const {
  static const Option kHelp = [] {
    Option help;
    help.names = "-h,--help";
    help.help = "Print this and exit";
    return help;
  }();
  std::vector<const Option*> shown = {&kHelp};
  for (const Option& option : options) {
    if (!option.is_hidden && !option.shownNames().empty()) shown.push_back(&option);
  }
  return shown;
}

}  // namespace mcc::tool
