// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "batch.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <mutex>
#include <numeric>
#include <system_error>

#include "batch_record.h"
#include "convert_report.h"
#include "file_roles.h"
#include "gltf/base/parallel.h"
#include "gltf/base/path_text.h"
#include "gltf/base/printable.h"
#include "gltf/document/package.h"
#include "gltf/files/file_io.h"
#include "gltf/files/system.h"
#include "json/json.h"
#include "notes.h"
#include "progress_line.h"

namespace mcc::tool {
namespace {

namespace fs = std::filesystem;
using gltf::Json;

enum class Outcome : uint8_t { kDone, kCopied, kUpToDate, kFailed };
constexpr size_t kOutcomeCount = 4;
constexpr size_t kShownNotes = 3;  ///< of a file, without -v

struct BatchFile {
  std::string input;
  std::string name;  ///< name of the output in the folder
  uint64_t size = 0;
  Outcome outcome = Outcome::kFailed;
  gltf::Result failure;
  uint64_t input_bytes = 0;
  uint64_t output_bytes = 0;
  std::vector<std::string> notes;
  Json report;  ///< only when --report was given
};

class Batch {
 public:
  explicit Batch(const BatchOptions& options) : options_(options), line_(options.common.is_quiet) {}

  int run();

 private:
  gltf::Result listFiles();
  gltf::Result checkRoles() const;
  gltf::Result makeFolder() const;
  void makeAll();
  void makeOne(BatchFile& file);
  void finishOne(const BatchFile& file, const BatchResult& made);
  std::vector<fs::path> outputsOf(const BatchFile& file, const BatchResult& made) const;
  std::string nameOf(Outcome outcome) const;
  void keepRecord(bool is_last);
  void showProgress() const;
  void printNote(const std::string& text) const;
  std::string lineOf(const BatchFile& file) const;
  std::string summaryText() const;
  std::string fileTable() const;
  Json reportOf() const;
  int printResults() const;
  fs::path outputOf(const BatchFile& file) const {
    return options_.folder / gltf::pathOf(file.name);
  }
  /// Only the pretty format has a line per file; the other formats print one table at the end.
  bool printsLines() const {
    return !options_.common.is_quiet && options_.common.format == Format::kPretty;
  }

  const BatchOptions& options_;
  std::vector<BatchFile> files_;
  std::unique_ptr<BatchRecord> record_;
  std::chrono::steady_clock::time_point recorded_;
  ProgressLine line_;
  std::mutex mutex_;  ///< guards record_, done_, line_ and standard output
  size_t done_ = 0;
  bool has_output_failed_ = false;
};

/// Returns the names of all files an output consists of.
std::vector<std::string> namesOf(const std::string& name, bool with_fallback) {
  std::vector<std::string> names = {name};
  gltf::Container container;
  if (!gltf::containerOf(name, container).ok()) return names;
  if (container.is_gltf) names.push_back(container.buffer_name);
  if (with_fallback) names.push_back(container.fallback_name);
  return names;
}

gltf::Result Batch::listFiles() {
  std::map<std::string, std::string> taken;  // key of the name -> input
  const std::string record_key = gltf::system::nameKey(BatchRecord::pathIn({}));
  for (const std::string& input : options_.inputs) {
    BatchFile file;
    file.input = input;
    file.name = gltf::textOf(gltf::pathOf(input).filename());
    if (file.name.empty()) return {input, "is a folder; name the files in it"};
    std::error_code code;
    file.size = fs::file_size(gltf::pathOf(input), code);
    if (code) file.size = 0;  // opening the file will report the error
    if (gltf::system::nameKey(gltf::pathOf(file.name)) == record_key) {
      return {input, "its output would be the record of the folder; rename it"};
    }
    if (gltf::isSameFile(gltf::pathOf(input), outputOf(file))) {
      return {input, "would be replaced by its output; choose another folder with -o"};
    }
    for (const std::string& name : namesOf(file.name, options_.with_fallback)) {
      const auto [found, is_new] =
          taken.try_emplace(gltf::system::nameKey(gltf::pathOf(name)), input);
      if (is_new) continue;
      return {input,
              fmt::format("writes \"{}\", as \"{}\" does; name different folders for "
                          "them or rename one",
                          gltf::textOf(options_.folder / gltf::pathOf(name)), found->second)};
    }
    files_.push_back(std::move(file));
  }
  return checkRoles();
}

/// Checks that no output replaces an input or another output, even through links with other names.
gltf::Result Batch::checkRoles() const {
  FileRoles roles;
  for (const BatchFile& file : files_) {
    const fs::path input = gltf::pathOf(file.input);
    roles.read(input, "an input");
    const bool has_files = input.extension() == ".gltf";
    if (has_files && !options_.report.empty()) roles.readBeside(input, options_.folder);
  }
  gltf::Result apart =
      roles.write(BatchRecord::pathIn(options_.folder), "the record of the folder");
  for (size_t i = 0; i < files_.size() && apart.ok(); ++i) {
    apart = roles.write(outputOf(files_[i]), "the output of " + files_[i].input);
    roles.replaceBeside(outputOf(files_[i]), options_.with_fallback);
  }
  if (apart.ok() && !options_.report.empty())
    apart = roles.write(gltf::pathOf(options_.report), "--report");
  return apart;
}

std::string Batch::nameOf(Outcome outcome) const {
  switch (outcome) {
    case Outcome::kDone: return options_.done_name;
    case Outcome::kCopied: return "copied";
    case Outcome::kUpToDate: return "up to date";
    case Outcome::kFailed: break;
  }
  return "failed";
}

gltf::Result Batch::makeFolder() const {
  std::error_code code;
  if (fs::is_directory(options_.folder, code)) return {};
  const std::string name = gltf::textOf(options_.folder);
  if (fs::exists(options_.folder, code)) {
    return {name, "is a file; several inputs need a folder"};
  }
  fs::create_directory(options_.folder, code);
  if (!code) return {};
  return {name, "the folder cannot be created: " + code.message()};
}

void Batch::printNote(const std::string& text) const {
  if (!options_.common.is_quiet) fmt::print(stderr, "gltf-mcc: note: {}\n", gltf::printable(text));
}

void Batch::showProgress() const {
  constexpr size_t kBarWidth = 24;
  const size_t filled = files_.empty() ? kBarWidth : kBarWidth * done_ / files_.size();
  line_.show(fmt::format("[{}{}] {} of {} files", std::string(filled, '#'),
                         std::string(kBarWidth - filled, '-'), done_, files_.size()));
}

std::string Batch::lineOf(const BatchFile& file) const {
  const std::string start =
      fmt::format("[{}/{}] {}: ", done_, files_.size(), gltf::printable(file.input));
  switch (file.outcome) {
    case Outcome::kDone: return start + sizeChange(file.input_bytes, file.output_bytes) + "\n";
    case Outcome::kCopied: return start + "copied, " + options_.copied_why + "\n";
    case Outcome::kUpToDate: return start + "up to date\n";
    case Outcome::kFailed: break;
  }
  return start + "failed\n";
}

void Batch::keepRecord(bool is_last) {
  constexpr std::chrono::seconds kInterval(2);
  const auto now = std::chrono::steady_clock::now();
  if (!is_last && now - recorded_ < kInterval) return;
  recorded_ = now;
  const gltf::Result written = record_->write();
  if (is_last && !written.ok()) {
    printNote(written.message() + "; the next run will make everything again");
  }
}

/// Returns all files of an output: those that are always made or may be, and copies of the others.
std::vector<fs::path> Batch::outputsOf(const BatchFile& file, const BatchResult& made) const {
  std::vector<fs::path> paths;
  for (const std::string& name : namesOf(file.name, options_.with_fallback)) {
    paths.push_back(options_.folder / gltf::pathOf(name));
  }
  const fs::path source_folder = gltf::folderOf(gltf::pathOf(file.input));
  for (const fs::path& path : made.files.other_input) {
    paths.push_back(options_.folder / path.lexically_relative(source_folder));
  }
  return paths;
}

void Batch::finishOne(const BatchFile& file, const BatchResult& made) {
  const std::lock_guard lock(mutex_);
  ++done_;
  if (file.outcome == Outcome::kFailed) record_->remove(file.name);
  if (file.outcome == Outcome::kDone || file.outcome == Outcome::kCopied) {
    record_->add(file.name, made, outputsOf(file, made));
    keepRecord(false);
  }
  line_.clear();
  if (printsLines()) {
    const size_t most = options_.common.is_verbose ? kAllNotes : kShownNotes;
    const std::string notes = notesText(file.notes, most, "  ");
    has_output_failed_ |= printOut(lineOf(file) + notes) != kDone;
  }
  showProgress();
}

void Batch::makeOne(BatchFile& file) {
  BatchResult made;
  {
    const std::lock_guard lock(mutex_);
    if (!options_.is_forced && record_->isUpToDate(file.name, gltf::pathOf(file.input))) {
      file.outcome = Outcome::kUpToDate;
      std::tie(file.input_bytes, file.output_bytes) = record_->sizesOf(file.name);
    }
  }
  if (file.outcome != Outcome::kUpToDate) {
    const auto count = static_cast<uint32_t>(files_.size());
    const uint32_t thread_count = std::max(1u, options_.job_count / std::max(1u, count));
    file.failure = options_.make(file.input, outputOf(file), thread_count, made);
    if (file.failure.ok()) {
      file.outcome = made.copied ? Outcome::kCopied : Outcome::kDone;
      file.input_bytes = made.input_bytes;
      file.output_bytes = made.output_bytes;
      file.notes = made.notes;
      file.report = std::move(made.details);
    }
  }
  finishOne(file, made);
}

/// Starts with the largest files, because they take longest. The first N files at a time are then
/// also the most memory that is ever needed.
void Batch::makeAll() {
  std::vector<size_t> order(files_.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](size_t a, size_t b) { return files_[a].size > files_[b].size; });
  showProgress();
  const gltf::Result all =
      gltf::runParallel(order.size(), options_.job_count, [&](size_t i) -> gltf::Result {
        BatchFile& file = files_[order[i]];
        const gltf::Result done = gltf::guarded([&]() -> gltf::Result {
          makeOne(file);
          return {};
        });
        if (!done.ok()) file.failure = {file.input, done.what};
        return {};  // a file that fails does not stop the others
      });
  for (BatchFile& file : files_) {
    const bool is_unsaid = file.outcome == Outcome::kFailed && file.failure.ok();
    if (is_unsaid) file.failure = {file.input, all.ok() ? "was left out" : all.what};
  }
  line_.clear();
}

std::vector<std::string> printableOf(const std::vector<std::string>& notes) {
  std::vector<std::string> printable;
  for (const std::string& note : notes) printable.push_back(gltf::printable(note));
  return printable;
}

std::string ratioOf(uint64_t input_bytes, uint64_t output_bytes) {
  if (output_bytes == 0) return "";
  return fmt::format("{:.2f}",
                     static_cast<double>(input_bytes) / static_cast<double>(output_bytes));
}

std::string Batch::summaryText() const {
  struct Sum {
    size_t files = 0;
    uint64_t input_bytes = 0;
    uint64_t output_bytes = 0;
  };
  Sum sums[kOutcomeCount];
  Sum all;
  for (const BatchFile& file : files_) {
    for (Sum* sum : {&sums[static_cast<size_t>(file.outcome)], &all}) {
      ++sum->files;
      sum->input_bytes += file.input_bytes;
      sum->output_bytes += file.output_bytes;
    }
  }
  Table table({"", "files", "bytes in", "bytes out", "ratio"});
  const auto addRow = [&](const std::string& name, const Sum& sum) {
    const bool has_bytes = sum.output_bytes != 0;
    table.addRow({name, grouped(sum.files), has_bytes ? grouped(sum.input_bytes) : "",
                  has_bytes ? grouped(sum.output_bytes) : "",
                  ratioOf(sum.input_bytes, sum.output_bytes)});
  };
  for (size_t i = 0; i < std::size(sums); ++i) {
    if (sums[i].files != 0) addRow(nameOf(static_cast<Outcome>(i)), sums[i]);
  }
  table.addRule();
  addRow("all", all);
  const auto noted = std::count_if(files_.begin(), files_.end(),
                                   [](const BatchFile& file) { return !file.notes.empty(); });
  const std::string about =
      noted == 0 ? ""
                 : fmt::format("{} notes; see above\n",
                               counted(static_cast<uint64_t>(noted), "file has", "files have"));
  return "\n" + table.print(Format::kPretty) + about;
}

/// One row per file, in the order of the command line.
std::string Batch::fileTable() const {
  Table table({"file", "outcome", "bytes in", "bytes out", "ratio"}, {1});
  const Format format = options_.common.format;
  for (const BatchFile& file : files_) {
    const bool is_done = file.outcome != Outcome::kFailed;
    table.addRow({file.input, nameOf(file.outcome), is_done ? count(file.input_bytes, format) : "",
                  is_done ? count(file.output_bytes, format) : "",
                  ratioOf(file.input_bytes, file.output_bytes)});
  }
  return table.print(format);
}

Json Batch::reportOf() const {
  Json list = Json::array();
  for (const BatchFile& file : files_) {
    Json entry = {{"input", file.input},
                  {"output", gltf::textOf(outputOf(file))},
                  {"outcome", nameOf(file.outcome)}};
    if (file.outcome == Outcome::kFailed) {
      entry["message"] = gltf::printable(file.failure.message());
    } else {
      entry["input_bytes"] = file.input_bytes;
      entry["output_bytes"] = file.output_bytes;
    }
    if (!file.notes.empty()) entry["notes"] = printableOf(file.notes);
    if (!file.report.is_null()) entry[options_.details_name] = file.report;
    list.push_back(std::move(entry));
  }
  return {{"tool", std::string("gltf-mcc ") + MCC_VERSION},
          {"options", options_.settings},
          {"files", std::move(list)}};
}

int Batch::printResults() const {
  int status = has_output_failed_ ? kFailed : kDone;
  if (!options_.report.empty()) {
    const gltf::Result written = writeReport(options_.report, printReport(reportOf()));
    if (!written.ok()) status = reportFailure(written);
  }
  if (!options_.common.is_quiet) {
    const Format format = options_.common.format;
    const std::string text = format == Format::kPretty ? summaryText()
                             : format == Format::kJson ? printReport(reportOf())
                                                       : fileTable();
    if (printOut(text) != kDone) status = kFailed;
  }
  for (const BatchFile& file : files_) {
    if (file.outcome == Outcome::kFailed) status = reportFailure(file.failure, file.input, "");
  }
  return status;
}

int Batch::run() {
  gltf::Result ready = listFiles();
  if (!ready.ok()) {
    reportFailure(ready);
    return kUsage;
  }
  if (!options_.report.empty()) ready = checkReport(options_.report);
  if (ready.ok()) ready = makeFolder();
  if (!ready.ok()) return reportFailure(ready);
  record_ = std::make_unique<BatchRecord>(options_.folder, options_.settings);
  if (!record_->note().ok()) printNote(record_->note().message());
  makeAll();
  keepRecord(true);
  return printResults();
}

}  // namespace

int runBatch(const BatchOptions& options) { return Batch(options).run(); }

}  // namespace mcc::tool
