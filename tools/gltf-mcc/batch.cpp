// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "batch.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <system_error>

#include "convert_report.h"
#include "file_roles.h"
#include "gltf/files/file_io.h"
#include "host/system.h"
#include "host/text.h"
#include "jobs/run.h"
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

constexpr char kRecordName[] = ".gltf-mcc.json";

class Batch {
 public:
  explicit Batch(const BatchOptions& options)
      : options_(options),
        maker_(jobs::makerOf(options.settings.dump())),
        record_(options.folder / kRecordName, {}, options.folder),
        line_(options.common.is_quiet) {}

  int run();

 private:
  gltf::Result listFiles();
  gltf::Result checkRoles() const;
  gltf::Result makeFolder() const;
  void openRecord();
  void makeAll();
  jobs::Job describe(const BatchFile& file) const;
  bool take(BatchFile& file, const Json& made) const;
  gltf::Result make(BatchFile& file);
  void end(BatchFile& file, const gltf::Result& result, size_t done);
  void keep(const BatchFile& file, const BatchResult& made);
  std::string nameOf(Outcome outcome) const;
  void showProgress(size_t done) const;
  void printNote(const std::string& text) const;
  std::string lineOf(const BatchFile& file, size_t done) const;
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
  const std::string maker_;
  std::vector<BatchFile> files_;
  jobs::Record record_;
  ProgressLine line_;
  bool has_output_failed_ = false;
};

gltf::Result Batch::listFiles() {
  std::map<std::string, std::string> taken;  // key of the name -> input
  const std::string record_key = gltf::system::nameKey(kRecordName);
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
    const std::string key = gltf::system::nameKey(gltf::pathOf(file.name));
    const auto [found, is_new] = taken.try_emplace(key, input);
    if (!is_new) {
      return {input, fmt::format("writes \"{}\", as \"{}\" does; name different folders for "
                                 "them or rename one",
                                 gltf::textOf(outputOf(file)), found->second)};
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
  gltf::Result apart = roles.write(options_.folder / kRecordName, "the record of the folder");
  for (size_t i = 0; i < files_.size() && apart.ok(); ++i) {
    apart = roles.write(outputOf(files_[i]), "the output of " + files_[i].input);
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
  const std::string name = gltf::textOf(options_.folder);
  if (fs::is_directory(options_.folder, code)) {
    if (gltf::system::mayWrite(options_.folder)) return {};
    return {name, "the folder is read-only; choose another one"};
  }
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

void Batch::showProgress(size_t done) const { line_.show(jobs::progressText(done, files_.size())); }

std::string Batch::lineOf(const BatchFile& file, size_t done) const {
  const std::string start =
      fmt::format("[{}/{}] {}: ", done, files_.size(), gltf::printable(file.input));
  switch (file.outcome) {
    case Outcome::kDone: return start + sizeChange(file.input_bytes, file.output_bytes) + "\n";
    case Outcome::kCopied: return start + "copied, " + options_.copied_why + "\n";
    case Outcome::kUpToDate: return start + "up to date\n";
    case Outcome::kFailed: break;
  }
  return start + "failed\n";
}

/// A file of the record's name that is not a record is replaced; anything else stays.
void Batch::openRecord() {
  constexpr uintmax_t kMostBytes = uintmax_t{1} << 26;
  const gltf::Result usable = record_.check(kMostBytes);
  if (!usable.ok()) printNote(usable.message() + "; it is ignored, and everything is made again");
  const gltf::Result opened = record_.open(usable.ok());  // makeAll() tells what was not written
  if (opened.ok()) record_.read(options_.folder / kRecordName);
}

jobs::Job Batch::describe(const BatchFile& file) const {
  std::error_code code;
  const fs::path input = fs::absolute(gltf::pathOf(file.input), code).lexically_normal();
  return {file.name, maker_, {gltf::textOf(input)}};
}

bool Batch::take(BatchFile& file, const Json& made) const {
  for (const char* key : {"input_bytes", "output_bytes"}) {
    if (!made.is_object() || !made.contains(key) || !made[key].is_number()) return false;
  }
  file.input_bytes = made["input_bytes"].get<uint64_t>();
  file.output_bytes = made["output_bytes"].get<uint64_t>();
  file.outcome = Outcome::kUpToDate;
  return true;
}

gltf::Result Batch::make(BatchFile& file) {
  BatchResult made;
  const auto count = static_cast<uint32_t>(files_.size());
  const uint32_t thread_count = std::max(1u, options_.job_count / std::max(1u, count));
  file.failure = options_.make(file.input, outputOf(file), thread_count, made);
  if (!file.failure.ok()) return file.failure;
  file.outcome = made.copied ? Outcome::kCopied : Outcome::kDone;
  file.input_bytes = made.input_bytes;
  file.output_bytes = made.output_bytes;
  file.notes = std::move(made.notes);
  file.report = std::move(made.details);
  keep(file, made);
  return {};
}

/// Records an output with all its files: those that were made, and copies of the input's.
void Batch::keep(const BatchFile& file, const BatchResult& made) {
  const jobs::Job job = describe(file);
  std::vector<fs::path> inputs = made.files.input;
  inputs.insert(inputs.end(), made.files.other_input.begin(), made.files.other_input.end());
  std::vector<std::string> input_names;
  std::vector<std::string> outputs = {file.name};
  const fs::path source_folder = gltf::folderOf(gltf::pathOf(file.input));
  for (size_t i = 0; i < inputs.size(); ++i) {
    std::error_code code;
    input_names.push_back(gltf::textOf(fs::absolute(inputs[i], code).lexically_normal()));
    const bool is_copied = i != 0 && (made.copied || i >= made.files.input.size());
    if (is_copied) outputs.push_back(gltf::textOf(inputs[i].lexically_relative(source_folder)));
  }
  for (const std::vector<fs::path>* list : {&made.files.output, &made.files.other_output}) {
    for (const fs::path& path : *list) {
      if (path == outputOf(file)) continue;
      outputs.push_back(gltf::textOf(path.lexically_relative(options_.folder)));
    }
  }
  record_.add(job, input_names, outputs,
              {{"input_bytes", made.input_bytes}, {"output_bytes", made.output_bytes}});
}

void Batch::end(BatchFile& file, const gltf::Result& result, size_t done) {
  if (!result.ok()) {
    file.outcome = Outcome::kFailed;
    if (file.failure.ok()) file.failure = {file.input, result.what};
    if (record_.hasOfOwn(file.name)) record_.claim(file.name);  // and no longer how it was made
  }
  line_.clear();
  if (printsLines()) {
    const size_t most = options_.common.is_verbose ? kAllNotes : kShownNotes;
    const std::string notes = notesText(file.notes, most, "  ");
    has_output_failed_ |= printOut(lineOf(file, done) + notes) != kDone;
  }
  showProgress(done);
}

void Batch::makeAll() {
  jobs::Work work;
  work.bytesOf = [this](uint32_t i) { return files_[i].size; };
  work.describe = [this](uint32_t i) { return describe(files_[i]); };
  work.take = [this](uint32_t i, const Json& made) { return take(files_[i], made); };
  work.make = [this](uint32_t i) { return make(files_[i]); };
  work.end = [this](uint32_t i, const gltf::Result& result, size_t done) {
    end(files_[i], result, done);
  };
  work.thread_count = options_.job_count;
  work.is_forced = options_.is_forced;
  std::vector<uint32_t> all(files_.size());
  std::iota(all.begin(), all.end(), 0u);
  showProgress(0);
  const gltf::Result done = runJobs(std::move(all), work, record_);
  for (BatchFile& file : files_) {
    const bool is_unsaid = file.outcome == Outcome::kFailed && file.failure.ok();
    if (is_unsaid) file.failure = {file.input, done.ok() ? "was left out" : done.what};
  }
  line_.clear();
  const gltf::Result recorded = record_.flush();
  if (!recorded.ok()) {
    printNote(recorded.message() + "; the next run will make everything again");
  }
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
  openRecord();
  makeAll();
  return printResults();
}

}  // namespace

int runBatch(const BatchOptions& options) { return Batch(options).run(); }

}  // namespace mcc::tool
