// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "table.h"

#include <algorithm>

#include "host/text.h"
#include "terminal.h"

namespace mcc::tool {
namespace {

std::string padded(const std::string& text, size_t width, bool is_left) {
  const std::string space(width - std::min(width, widthOf(text)), ' ');
  return is_left ? text + space : space + text;
}

bool isRule(const std::vector<std::string>& row) { return row.size() == 1 && row[0].empty(); }

std::string csvCell(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

/// Escapes '|', which would end the cell.
std::string markdownCell(const std::string& text) {
  std::string escaped;
  for (const char c : text) escaped += c == '|' ? std::string("\\|") : std::string(1, c);
  return escaped;
}

void trimRight(std::string& text) { text.erase(text.find_last_not_of(' ') + 1); }

}  // namespace

bool Table::isText(size_t column) const {
  return column == 0 ||
         std::find(text_columns_.begin(), text_columns_.end(), column) != text_columns_.end();
}

void Table::addRow(std::vector<std::string> cells, const std::string& bar) {
  for (std::string& cell : cells) cell = gltf::printable(cell);
  if (!bar.empty()) cells.push_back(bar);
  rows_.push_back(std::move(cells));
}

std::string Table::printAligned(bool is_markdown) const {
  const auto cellOf = [&](const std::vector<std::string>& row, size_t c) {
    if (c >= row.size()) return std::string();
    return is_markdown ? markdownCell(row[c]) : row[c];
  };
  std::vector<size_t> widths(header_.size(), 0);
  const auto measure = [&](const std::vector<std::string>& row) {
    for (size_t c = 0; c < std::min(row.size(), widths.size()); ++c) {
      widths[c] = std::max(widths[c], widthOf(cellOf(row, c)));
    }
  };
  measure(header_);
  for (const auto& row : rows_) measure(row);

  std::string out;
  const auto addLine = [&](const std::vector<std::string>& row) {
    std::string line = is_markdown ? "|" : "";
    for (size_t c = 0; c < widths.size(); ++c) {
      const std::string cell = padded(cellOf(row, c), widths[c], isText(c));
      line += is_markdown ? " " + cell + " |" : (c == 0 ? "" : "  ") + cell;
    }
    trimRight(line);
    out += line + "\n";
  };
  const auto addRuleLine = [&]() {
    std::string line = is_markdown ? "|" : "";
    for (size_t c = 0; c < widths.size(); ++c) {
      const std::string dashes(widths[c], '-');
      line +=
          is_markdown ? " " + dashes + (isText(c) ? " |" : ":|") : (c == 0 ? "" : "  ") + dashes;
    }
    out += line + "\n";
  };
  addLine(header_);
  if (!is_markdown) out = styleOfOutput().bold(out.substr(0, out.size() - 1)) + "\n";
  addRuleLine();
  for (const auto& row : rows_) {
    if (!isRule(row)) {
      addLine(row);
    } else if (!is_markdown) {
      addRuleLine();
    }
  }
  return out;
}

std::string Table::printCsv() const {
  std::string out;
  const auto addLine = [&](const std::vector<std::string>& row) {
    for (size_t c = 0; c < header_.size(); ++c) {
      out += (c == 0 ? "" : ",") + csvCell(c < row.size() ? row[c] : "");
    }
    out += "\n";
  };
  addLine(header_);
  for (const auto& row : rows_) {
    if (!isRule(row)) addLine(row);
  }
  return out;
}

std::string Table::print(Format format) const {
  switch (format) {
    case Format::kPretty: return printAligned(false);
    case Format::kMarkdown: return printAligned(true);
    case Format::kCsv:
    case Format::kJson: break;
  }
  return printCsv();
}

std::string grouped(uint64_t number) {
  std::string digits = std::to_string(number);
  for (size_t i = digits.size(); i > 3; i -= 3) digits.insert(i - 3, ",");
  return digits;
}

std::string counted(uint64_t number, const char* one, const char* many) {
  return grouped(number) + " " + (number == 1 ? one : many);
}

std::string count(uint64_t number, Format format) {
  const bool is_for_people = format == Format::kPretty || format == Format::kMarkdown;
  return is_for_people ? grouped(number) : std::to_string(number);
}

}  // namespace mcc::tool
