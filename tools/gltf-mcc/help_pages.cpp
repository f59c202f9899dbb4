// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "help_pages.h"

#include <fmt/format.h>

#include <memory>
#include <sstream>

#include "commands.h"
#include "help.h"
#include "suggest.h"

namespace mcc::tool {
namespace {

std::vector<std::string> linesOf(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

std::string joined(const std::vector<std::string>& words, const std::string& between) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : between) + word;
  return text;
}

std::vector<std::string> namesOf(const std::vector<const CLI::App*>& commands) {
  std::vector<std::string> names;
  for (const CLI::App* command : commands) names.push_back(command->get_name());
  return names;
}

/// Returns the words a command accepts as its argument, if it accepts only these.
std::vector<std::string> wordsOf(const CLI::App& app, const std::string& command) {
  if (command == "help") return namesOf(commandsOf(app));
  if (command == "completion") return {"bash", "zsh"};
  return {};
}

std::string replaced(const std::string& text, char from, const std::string& to) {
  std::string result;
  for (const char c : text) result += c == from ? to : std::string(1, c);
  return result;
}

// --- man page ----------------------------------------------------------------

/// Escapes a line of text for roff: hyphens become minus signs, and no line can be a request.
std::string roff(const std::string& text) {
  std::string line = replaced(replaced(text, '\\', "\\e"), '-', "\\-");
  for (size_t at = line.find("…"); at != std::string::npos; at = line.find("…")) {
    line.replace(at, std::string("…").size(), "...");
  }
  return line.starts_with('.') || line.starts_with('\'') ? "\\&" + line : line;
}

std::string roffLines(const std::string& text, const std::string& prefix) {
  std::string lines;
  for (const std::string& line : linesOf(text)) lines += roff(prefix + line) + "\n";
  return lines;
}

/// Keeps the line breaks of a text.
std::string roffAsTyped(const std::string& text) {
  return ".PP\n.nf\n.RS 4\n" + roffLines(text, "gltf-mcc ") + ".RE\n.fi\n";
}

std::string roffOptions(const CLI::App& command) {
  std::string text;
  for (const OptionHelp& option : optionsOf(command)) {
    text += ".TP\n\\fB" + roff(joined(option.names, ", ")) + "\\fR";
    if (!option.value.empty()) text += " \\fI" + roff(option.value) + "\\fR";
    text += "\n" + roff(option.description) + "\n";
  }
  return text;
}

std::string roffCommand(const CLI::App& command) {
  const CommandHelp& help = helpOf(command);
  std::string text = ".SS " + command.get_name() + "\n" + roff(command.get_description()) + ".\n";
  text += roffAsTyped(help.usage) + ".PP\n" + roffLines(help.text, "") + roffOptions(command);
  return text + ".PP\nExamples:\n" + roffAsTyped(help.examples);
}

constexpr char kManEnd[] =
    R"(.SH EXIT STATUS
.TP
\fB0\fR
Done.
.TP
\fB1\fR
The input is bad, or a check failed; no output was written or replaced.
With several inputs, one that fails does not stop the others.
.TP
\fB2\fR
Wrong usage.
.SH ENVIRONMENT
.TP
\fBNO_COLOR\fR
If it is set and not empty, colours are off, unless \-\-color asks for them.
.TP
\fBLC_ALL\fR, \fBLC_CTYPE\fR, \fBLANG\fR
The first of these that is set determines whether bars and symbols may use characters beyond ASCII.
.SH FILES
.TP
\fIDIR\fR/.gltf\-mcc.json
Records what convert and decode wrote with \-o \fIDIR\fR and from which files,
so that only outputs whose inputs have changed are made again.
.TP
\fIOUT\fR/.gltf\-mcc\-tiles.jsonl
Records what tiles wrote, for the same purpose, and so that it replaces no file of anybody else.
)";

}  // namespace

std::string manPage(const CLI::App& app) {
  std::string text =
      ".\\\" Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0\n"
      ".\\\" Made by: gltf-mcc man\n";
  text += fmt::format(".TH GLTF\\-MCC 1 \"\" \"gltf\\-mcc {}\" \"User Commands\"\n", MCC_VERSION);
  text += ".SH NAME\ngltf\\-mcc \\- compress the meshes of glTF files\n.SH SYNOPSIS\n.nf\n";
  for (const CLI::App* command : commandsOf(app)) {
    for (const std::string& line : linesOf(helpOf(*command).usage)) {
      text += "\\fBgltf\\-mcc\\fR " + roff(line) + "\n";
    }
  }
  text += ".fi\n.SH DESCRIPTION\n" + roff(app.get_description()) +
          "\nEvery command has \\-\\-help.\n" + roffOptions(app) + ".SH COMMANDS\n";
  for (const CLI::App* command : commandsOf(app)) text += roffCommand(*command);
  return text + kManEnd;
}

// --- bash --------------------------------------------------------------------

namespace {

/// "convert:-o|convert:--output".
std::string bashCase(const std::string& command, const OptionHelp& option) {
  std::string text;
  for (const std::string& name : option.names) {
    text += (text.empty() ? "" : "|") + command + ":" + name;
  }
  return text;
}

/// Lists what bash offers after the options of a command that take a value.
std::string bashValues(const CLI::App& command, const std::string& prefix) {
  std::string text;
  for (const OptionHelp& option : optionsOf(command)) {
    if (option.value.empty()) continue;
    std::string offer;  // empty for numbers
    if (!option.choices.empty()) offer = "offer '" + joined(option.choices, " ") + "'; ";
    if (option.takes_file) offer = "offer_files; ";
    text += fmt::format("    {}) {}return ;;\n", bashCase(prefix, option), offer);
  }
  return text;
}

std::string bashOptions(const CLI::App& command) {
  std::vector<std::string> names;
  for (const OptionHelp& option : optionsOf(command)) {
    names.insert(names.end(), option.names.begin(), option.names.end());
  }
  return joined(names, " ");
}

constexpr char kBashStart[] = R"(# bash completion of gltf-mcc
# Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
# Made by: gltf-mcc completion bash
_gltf_mcc() {
  local current=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD - 1]} command= i
  COMPREPLY=()
  offer() { mapfile -t COMPREPLY < <(compgen -W "$1" -- "$current"); }
  offer_files() {
    compopt -o filenames 2> /dev/null
    mapfile -t COMPREPLY < <(compgen -f -- "$current")
  }
  offer_models() {
    compopt -o filenames 2> /dev/null
    mapfile -t COMPREPLY < <(compgen -d -- "$current"; compgen -f -X '!*.gl[bt]*' -- "$current")
  }
  # bash takes --option=value for three words.
  if [[ $current == = ]]; then
    current=
  elif [[ $previous == = ]]; then
    previous=${COMP_WORDS[COMP_CWORD - 2]}
  fi
)";

}  // namespace

std::string bashCompletion(const CLI::App& app) {
  const std::vector<const CLI::App*> commands = commandsOf(app);
  std::string text = kBashStart;
  text += "  for ((i = 1; i < COMP_CWORD; ++i)); do\n    case ${COMP_WORDS[i]} in\n      " +
          joined(namesOf(commands), "|") +
          ") command=${COMP_WORDS[i]}; break ;;\n    esac\n  done\n";
  text += "  case $command:$previous in\n";
  for (const CLI::App* command : commands) text += bashValues(*command, command->get_name());
  text += bashValues(app, "");
  text += "  esac\n  if [[ $current == -* ]]; then\n    case $command in\n";
  for (const CLI::App* command : commands) {
    text += fmt::format("      {}) offer '{}' ;;\n", command->get_name(), bashOptions(*command));
  }
  text += fmt::format("      *) offer '{}' ;;\n", bashOptions(app));
  text += "    esac\n    return\n  fi\n  case $command in\n";
  text += fmt::format("    '') offer '{}' ;;\n", joined(namesOf(commands), " "));
  for (const CLI::App* command : commands) {
    const std::vector<std::string> words = wordsOf(app, command->get_name());
    if (words.empty()) continue;
    text += fmt::format("    {}) offer '{}' ;;\n", command->get_name(), joined(words, " "));
  }
  return text + "    *) offer_models ;;\n  esac\n}\ncomplete -F _gltf_mcc gltf-mcc\n";
}

// --- zsh ---------------------------------------------------------------------

namespace {

/// Escapes text for use inside '…[…]' of _arguments.
std::string zshText(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    if (c == '\'') {
      escaped += "'\\''";
    } else {
      if (c == '[' || c == ']' || c == ':') escaped += '\\';
      escaped += c;
    }
  }
  return escaped;
}

std::string zshOption(const OptionHelp& option) {
  std::string value;
  if (!option.value.empty()) {
    value = ":" + zshText(option.value) + ":";
    if (!option.choices.empty()) value += "(" + joined(option.choices, " ") + ")";
    if (option.takes_file) value += "_files";
  }
  const std::string rest = "[" + zshText(option.description) + "]" + value + "'";
  if (option.names.size() == 1) return "'" + option.names[0] + rest;
  return "'(" + joined(option.names, " ") + ")'{" + joined(option.names, ",") + "}'" + rest;
}

std::string zshArguments(const CLI::App& app, const CLI::App& command) {
  std::string text = "      _arguments -s";
  for (const OptionHelp& option : optionsOf(command)) {
    text += " \\\n        " + zshOption(option);
  }
  const std::vector<std::string> words = wordsOf(app, command.get_name());
  text += " \\\n        ";
  if (words.empty()) return text + "'*:model:_files -g \"*.(glb|gltf)\"'";
  return text + "'1:word:(" + joined(words, " ") + ")'";
}

}  // namespace

std::string zshCompletion(const CLI::App& app) {
  std::string text =
      "#compdef gltf-mcc\n"
      "# Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0\n"
      "# Made by: gltf-mcc completion zsh\n"
      "_gltf_mcc() {\n  local -a commands\n  commands=(\n";
  for (const CLI::App* command : commandsOf(app)) {
    text += fmt::format("    '{}:{}'\n", command->get_name(), zshText(command->get_description()));
  }
  text +=
      "  )\n  if ((CURRENT == 2)) && [[ $words[2] != -* ]]; then\n"
      "    _describe command commands\n    return\n  fi\n";
  text +=
      "  local command=$words[2]\n  if ((CURRENT > 2)); then\n    shift words\n"
      "    ((--CURRENT))\n  fi\n  case $command in\n";
  for (const CLI::App* command : commandsOf(app)) {
    text +=
        fmt::format("    {})\n{}\n      ;;\n", command->get_name(), zshArguments(app, *command));
  }
  text += "    *)\n      _arguments -s";
  for (const OptionHelp& option : optionsOf(app)) text += " \\\n        " + zshOption(option);
  return text +
         "\n      ;;\n  esac\n}\nif [[ $funcstack[1] == _gltf_mcc ]]; then\n  _gltf_mcc \"$@\"\n"
         "else\n  compdef _gltf_mcc gltf-mcc\nfi\n";
}

// --- commands ----------------------------------------------------------------

namespace {

void addHelpCommand(CLI::App& app, int& status) {
  CLI::App* command = app.add_subcommand("help", "Explain a command, as COMMAND --help does");
  auto name = std::make_shared<std::string>();
  command->add_option("COMMAND", *name, "Which")->type_name("");
  setHelp(*command, "help [COMMAND]", "", "help convert");
  command->callback([&app, &status, name]() {
    const CLI::App* wanted = name->empty() ? &app : nullptr;
    for (const CLI::App* one : commandsOf(app)) {
      if (one->get_name() == *name) wanted = one;
    }
    if (wanted == nullptr) {
      throw CLI::ValidationError(
          "help", "there is no command " + *name + didYouMean(*name, namesOf(commandsOf(app))));
    }
    // CLI11's help() of the app would print the help of the command that runs, `help` itself.
    status = printOut(wanted->get_formatter()->make_help(wanted, "", CLI::AppFormatMode::Normal));
  });
}

void addCompletion(CLI::App& app, int& status) {
  CLI::App* command = app.add_subcommand("completion", "Print a completion script for a shell");
  auto shell = std::make_shared<std::string>();
  command->add_option("SHELL", *shell, "Which")->type_name("")->required();
  setHelp(*command, "completion bash|zsh",
          "For this session: source <(gltf-mcc completion bash), in zsh after compinit.\n"
          "To keep it, save it as gltf-mcc in ~/.local/share/bash-completion/completions, which\n"
          "you may have to create, or as _gltf-mcc in a folder of zsh's fpath.",
          "completion bash > ~/.local/share/bash-completion/completions/gltf-mcc");
  command->callback([&app, &status, shell]() {
    if (*shell != "bash" && *shell != "zsh") {
      throw CLI::ValidationError("completion", "supports bash and zsh, not " + *shell);
    }
    status = printOut(*shell == "bash" ? bashCompletion(app) : zshCompletion(app));
  });
}

void addMan(CLI::App& app, int& status) {
  CLI::App* command = app.add_subcommand("man", "Print the man page");
  setHelp(*command, "man", "", "man | man -l -");
  command->callback([&app, &status]() { status = printOut(manPage(app)); });
}

}  // namespace

void addHelpCommands(CLI::App& app, int& status) {
  addHelpCommand(app, status);
  addCompletion(app, status);
  addMan(app, status);
}

}  // namespace mcc::tool
