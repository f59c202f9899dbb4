// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Tables that line up, and the same as Markdown, CSV or JSON.
#ifndef MCC_TOOL_TABLE_H_
#define MCC_TOOL_TABLE_H_

#include <cstdint>
#include <string>
#include <vector>

namespace mcc::tool {

enum class Format { kPretty, kMarkdown, kCsv, kJson };

/// Rows of text under a header. Numbers are aligned right; the first column and those of
/// `text_columns` left. A row of one empty cell is a rule in kPretty and left out elsewhere.
class Table {
 public:
  explicit Table(std::vector<std::string> header, std::vector<size_t> text_columns = {})
      : header_(std::move(header)), text_columns_(std::move(text_columns)) {}

  /// Cells are made printable: names in them come from files. `bar`, which may be coloured, is a last cell as it is.
  void addRow(std::vector<std::string> cells, const std::string& bar = "");
  void addRule() { rows_.push_back({""}); }
  bool empty() const { return rows_.empty(); }

  /// kJson is printed by the commands themselves; here it is the same as kCsv.
  std::string print(Format format) const;

 private:
  std::string printAligned(bool is_markdown) const;
  std::string printCsv() const;
  bool isText(size_t column) const;

  std::vector<std::string> header_;
  std::vector<size_t> text_columns_;
  std::vector<std::vector<std::string>> rows_;
};

/// 1234567 -> "1,234,567".
std::string grouped(uint64_t number);

/// The same without separators where a program reads it.
std::string count(uint64_t number, Format format);

/// "1 mesh", "1,234 meshes".
std::string counted(uint64_t number, const char* one, const char* many);

}  // namespace mcc::tool

#endif  // MCC_TOOL_TABLE_H_
