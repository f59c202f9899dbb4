// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "help.h"

#include <memory>

namespace mcc::tool {
namespace {

/// Every line of a text behind a prefix; the first line behind `first`.
std::string indented(const std::string& text, const std::string& first, const std::string& prefix) {
  std::string result = first;
  for (const char c : text) {
    result += c;
    if (c == '\n') result += prefix;
  }
  return result + "\n";
}

}  // namespace

HelpFormatter::HelpFormatter(std::string lines) : usage_(std::move(lines)) { column_width(32); }

std::string HelpFormatter::make_usage(const CLI::App*, std::string) const {
  return indented(usage_, "Usage: gltf-mcc ", "       gltf-mcc ");
}

/// They are in the usage, and explained by the description.
std::string HelpFormatter::make_positionals(const CLI::App*) const { return ""; }

std::string HelpFormatter::make_option_opts(const CLI::Option* option) const {
  const bool takes_value = option->get_type_size() != 0 && !option->get_type_name().empty();
  return takes_value ? " " + option->get_type_name() : "";
}

void setHelp(CLI::App& command, const std::string& usage, const std::string& text,
             const std::string& examples) {
  command.formatter(std::make_shared<HelpFormatter>(usage));
  command.footer((text.empty() ? "" : text + "\n\n") + "Examples:\n" +
                 indented(examples, "  gltf-mcc ", "  gltf-mcc "));
}

}  // namespace mcc::tool
