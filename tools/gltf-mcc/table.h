// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Tables with aligned columns, and the same tables as Markdown or CSV.
#ifndef MCC_TOOL_TABLE_H_
#define MCC_TOOL_TABLE_H_

#include <cstdint>
#include <string>
#include <vector>

namespace mcc::tool {

enum class Format { kPretty, kMarkdown, kCsv, kJson };

/// Rows of text under a header. Numbers are aligned right; the first column and those in
/// `text_columns` are aligned left. A row of one empty cell is a rule in kPretty and left out
/// elsewhere.
class Table {
 public:
  explicit Table(std::vector<std::string> header, std::vector<size_t> text_columns = {})
      : header_(std::move(header)), text_columns_(std::move(text_columns)) {}

  /// Adds a row. Cells are made printable, since names in them come from files. `bar`, which may be
  /// coloured, is added as the last cell unchanged.
  void addRow(std::vector<std::string> cells, const std::string& bar = "");
  void addRule() { rows_.push_back({""}); }
  bool empty() const { return rows_.empty(); }

  /// Commands print kJson themselves; here it is the same as kCsv.
  std::string print(Format format) const;

 private:
  std::string printAligned(bool is_markdown) const;
  std::string printCsv() const;
  bool isText(size_t column) const;

  std::vector<std::string> header_;
  std::vector<size_t> text_columns_;
  std::vector<std::vector<std::string>> rows_;
};

/// Formats a number with separators: 1234567 -> "1,234,567".
std::string grouped(uint64_t number);

/// Formats a number with separators, or without them in formats that programs read.
std::string count(uint64_t number, Format format);

/// Formats a count with its noun: "1 mesh", "1,234 meshes".
std::string counted(uint64_t number, const char* one, const char* many);

}  // namespace mcc::tool

#endif  // MCC_TOOL_TABLE_H_
