// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "help_pages.h"

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

std::string textsOf(const std::vector<Word>& words) {
  std::string text;
  for (const Word& word : words) text += (text.empty() ? "" : " ") + word.text;
  return text;
}

std::vector<std::string> namesOf(const Program& program) {
  std::vector<std::string> names;
  for (const Command& command : program.commands) names.push_back(command.name);
  return names;
}

/// Returns the words a command accepts as its argument, if it accepts only these.
std::vector<std::string> wordsOf(const Program& program, const std::string& command) {
  if (command == "help") return namesOf(program);
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

std::string roffOptions(const Command& command) {
  std::string text;
  for (const Option* option : command.shownOptions()) {
    text += ".TP\n\\fB" + roff(joined(option->shownNames(), ", ")) + "\\fR";
    if (!option->value.empty()) text += " \\fI" + roff(option->value) + "\\fR";
    text += "\n" + roff(option->help) + "\n";
  }
  return text;
}

std::string roffCommand(const Command& command) {
  std::string text = ".SS " + command.name + "\n" + roff(command.summary) + ".\n";
  text += roffAsTyped(command.usage) + ".PP\n" + roffLines(command.text, "") + roffOptions(command);
  return text + ".PP\nExamples:\n" + roffAsTyped(command.examples);
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

std::string manPage(const Program& program) {
  std::string text =
      ".\\\" Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0\n"
      ".\\\" Made by: gltf-mcc man\n";
  text += ".TH GLTF\\-MCC 1 \"\" \"gltf\\-mcc " MCC_VERSION "\" \"User Commands\"\n";
  text += ".SH NAME\ngltf\\-mcc \\- compress the meshes of glTF files\n.SH SYNOPSIS\n.nf\n";
  for (const Command& command : program.commands) {
    for (const std::string& line : linesOf(command.usage)) {
      text += "\\fBgltf\\-mcc\\fR " + roff(line) + "\n";
    }
  }
  text += ".fi\n.SH DESCRIPTION\n" + roff(program.root.summary) +
          "\nEvery command has \\-\\-help.\n" + roffOptions(program.root) + ".SH COMMANDS\n";
  for (const Command& command : program.commands) text += roffCommand(command);
  return text + kManEnd;
}

// --- bash --------------------------------------------------------------------

namespace {

/// "convert:-o|convert:--output".
std::string bashCase(const std::string& command, const Option& option) {
  std::string text;
  for (const std::string& name : option.shownNames()) {
    text += (text.empty() ? "" : "|") + command + ":" + name;
  }
  return text;
}

/// Lists what bash offers after the options of a command that take a value.
std::string bashValues(const Command& command, const std::string& prefix) {
  std::string text;
  for (const Option* option : command.shownOptions()) {
    if (option->value.empty()) continue;
    std::string offer;  // empty for numbers
    if (!option->words.empty()) offer = "offer '" + textsOf(option->words) + "'; ";
    if (option->takesFile()) offer = "offer_files; ";
    text += "    " + bashCase(prefix, *option) + ") " + offer + "return ;;\n";
  }
  return text;
}

std::string bashOptions(const Command& command) {
  std::string names;
  for (const Option* option : command.shownOptions()) {
    names += (names.empty() ? "" : " ") + joined(option->shownNames(), " ");
  }
  return names;
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

std::string bashCompletion(const Program& program) {
  const std::string names = joined(namesOf(program), " ");
  std::string text = kBashStart;
  text += "  for ((i = 1; i < COMP_CWORD; ++i)); do\n    case ${COMP_WORDS[i]} in\n      " +
          joined(namesOf(program), "|") +
          ") command=${COMP_WORDS[i]}; break ;;\n    esac\n  done\n";
  text += "  case $command:$previous in\n";
  for (const Command& command : program.commands) text += bashValues(command, command.name);
  text += bashValues(program.root, "");
  text += "  esac\n  if [[ $current == -* ]]; then\n    case $command in\n";
  for (const Command& command : program.commands) {
    text += "      " + command.name + ") offer '" + bashOptions(command) + "' ;;\n";
  }
  text += "      *) offer '" + bashOptions(program.root) + "' ;;\n";
  text += "    esac\n    return\n  fi\n  case $command in\n";
  text += "    '') offer '" + names + "' ;;\n";
  for (const Command& command : program.commands) {
    const std::vector<std::string> words = wordsOf(program, command.name);
    if (words.empty()) continue;
    text += "    " + command.name + ") offer '" + joined(words, " ") + "' ;;\n";
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

std::string zshOption(const Option& option) {
  std::string value;
  if (!option.value.empty()) {
    value = ":" + zshText(option.value) + ":";
    if (!option.words.empty()) value += "(" + textsOf(option.words) + ")";
    if (option.takesFile()) value += "_files";
  }
  const std::string rest = "[" + zshText(option.help) + "]" + value + "'";
  const std::vector<std::string> names = option.shownNames();
  if (names.size() == 1) return "'" + names[0] + rest;
  return "'(" + joined(names, " ") + ")'{" + joined(names, ",") + "}'" + rest;
}

std::string zshArguments(const Command& command) {
  std::string text = "      _arguments -s";
  for (const Option* option : command.shownOptions()) {
    text += " \\\n        " + zshOption(*option);
  }
  return text;
}

std::string zshArguments(const Program& program, const Command& command) {
  std::string text = zshArguments(command);
  const std::vector<std::string> words = wordsOf(program, command.name);
  text += " \\\n        ";
  if (words.empty()) return text + "'*:model:_files -g \"*.(glb|gltf)\"'";
  return text + "'1:word:(" + joined(words, " ") + ")'";
}

}  // namespace

std::string zshCompletion(const Program& program) {
  std::string text =
      "#compdef gltf-mcc\n"
      "# Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0\n"
      "# Made by: gltf-mcc completion zsh\n"
      "_gltf_mcc() {\n  local -a commands\n  commands=(\n";
  for (const Command& command : program.commands) {
    text += "    '" + command.name + ":" + zshText(command.summary) + "'\n";
  }
  text +=
      "  )\n  if ((CURRENT == 2)) && [[ $words[2] != -* ]]; then\n"
      "    _describe command commands\n    return\n  fi\n";
  text +=
      "  local command=$words[2]\n  if ((CURRENT > 2)); then\n    shift words\n"
      "    ((--CURRENT))\n  fi\n  case $command in\n";
  for (const Command& command : program.commands) {
    text += "    " + command.name + ")\n" + zshArguments(program, command) + "\n      ;;\n";
  }
  return text + "    *)\n" + zshArguments(program.root) +
         "\n      ;;\n  esac\n}\nif [[ $funcstack[1] == _gltf_mcc ]]; then\n  _gltf_mcc \"$@\"\n"
         "else\n  compdef _gltf_mcc gltf-mcc\nfi\n";
}

// --- commands ----------------------------------------------------------------

namespace {

void addHelpCommand(Program& program) {
  Command& command = program.commands.emplace_back();
  command.name = "help";
  command.summary = "Explain a command, as COMMAND --help does";
  command.usage = "help [COMMAND]";
  command.examples = "help convert";
  auto name = std::make_shared<std::string>();
  command.add("COMMAND", "", name.get(), "Which");
  command.run = [&program, name]() {
    if (name->empty()) return printOut(helpOf(program));
    for (const Command& one : program.commands) {
      if (one.name == *name) return printOut(helpOf(one));
    }
    throw UsageError("help", "there is no command " + *name + didYouMean(*name, namesOf(program)));
  };
}

void addCompletion(Program& program) {
  Command& command = program.commands.emplace_back();
  command.name = "completion";
  command.summary = "Print a completion script for a shell";
  command.usage = "completion bash|zsh";
  command.text =
      "For this session: source <(gltf-mcc completion bash), in zsh after compinit.\n"
      "To keep it, save it as gltf-mcc in ~/.local/share/bash-completion/completions, which\n"
      "you may have to create, or as _gltf-mcc in a folder of zsh's fpath.";
  command.examples = "completion bash > ~/.local/share/bash-completion/completions/gltf-mcc";
  auto shell = std::make_shared<std::string>();
  command.add("SHELL", "", shell.get(), "Which").is_required = true;
  command.run = [&program, shell]() {
    if (*shell != "bash" && *shell != "zsh") {
      throw UsageError("completion", "supports bash and zsh, not " + *shell);
    }
    return printOut(*shell == "bash" ? bashCompletion(program) : zshCompletion(program));
  };
}

void addMan(Program& program) {
  Command& command = program.commands.emplace_back();
  command.name = "man";
  command.summary = "Print the man page";
  command.usage = "man";
  command.examples = "man | man -l -";
  command.run = [&program]() { return printOut(manPage(program)); };
}

}  // namespace

void addHelpCommands(Program& program) {
  addHelpCommand(program);
  addCompletion(program);
  addMan(program);
}

}  // namespace mcc::tool
