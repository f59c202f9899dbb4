// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "tiles_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <memory>
#include <mutex>

#include "convert_report.h"
#include "gltf/api/convert.h"
#include "gltf/document/package.h"
#include "gltf/files/file_io.h"
#include "gltf/inspect/report.h"
#include "host/parallel.h"
#include "host/result.h"
#include "host/system.h"
#include "host/text.h"
#include "interrupt.h"
#include "jobs/run.h"
#include "json/json.h"
#include "progress_line.h"
#include "tiles/accuracy.h"
#include "tiles/convert_tile.h"
#include "tiles/part_record.h"
#include "tiles/tile_file.h"
#include "tiles_report.h"

namespace mcc::tool {
namespace {

namespace fs = std::filesystem;
using gltf::Json;
using gltf::Result;
using tiles::genericText;
using tiles::isInside;

class TilesRun {
 public:
  explicit TilesRun(const TilesOptions& options)
      : options_(options), line_(options.common.is_quiet) {}

  int run();

 private:
  /// What becomes of a file.
  enum class Role : uint8_t {
    kNone,  ///< nothing: another part has it, or its place belongs to somebody else
    kCopy,
    kModel,
    kGltf,  ///< a model whose buffers are other files
  };

  /// The buffers of a .gltf that is compressed, relative to the folder.
  using Buffers = std::vector<std::string>;

  Result openFolders();
  Result walk();
  void addLevelNotes();
  void assignRoles();
  void assignGltf();
  Result claimOutputs();
  void makeAll();
  void makeAll(std::vector<uint32_t> files, const char* what);
  Result makeOne(uint32_t file);
  Result makeModel(uint32_t file);
  Result makeGltf(uint32_t file);
  Result copyOne(uint32_t file);
  Result convertBytes(uint32_t file, std::vector<uint8_t> bytes, std::vector<uint8_t>& output,
                      tiles::TileFigures& figures, std::vector<std::string>& notes) const;
  Result chooseFor(uint32_t file, std::span<const uint8_t> glb, const tiles::TileModel& model,
                   tiles::Accuracy& accuracy) const;
  Result store(const std::string& name, std::span<const uint8_t> bytes);
  Result makeFolderOf(const std::string& name) const;
  jobs::Job describe(uint32_t file) const;
  bool take(uint32_t file, const Json& made);
  void keep(uint32_t file, const std::vector<std::string>& notes,
            const std::vector<fs::path>& beside = {});
  void addNotes(uint32_t file, const std::vector<std::string>& notes);
  std::string makerOf(uint32_t file) const;
  std::vector<std::string> inputsOf(uint32_t file) const;
  int printResults();

  std::string name(uint32_t file) const { return std::string(result_.table.name(file)); }
  bool isModel(uint32_t file) const {
    return roles_[file] == Role::kModel || roles_[file] == Role::kGltf;
  }
  fs::path in(const std::string& of) const { return input_ / gltf::pathOf(of); }
  fs::path out(const std::string& of) const { return output_ / gltf::pathOf(of); }
  Result read(const std::string& of, std::vector<uint8_t>& bytes) const {
    return gltf::inFile(in(of), gltf::readNamed(input_, of, bytes));
  }

  const TilesOptions& options_;
  fs::path input_;
  fs::path output_;
  TilesRunResult result_;
  std::string settings_;               ///< as JSON
  std::vector<Role> roles_;            ///< by file, as in the table
  std::map<uint32_t, Buffers> gltfs_;  ///< of the files with the role kGltf
  std::unique_ptr<tiles::PartRecord> record_;
  ProgressLine line_;
  std::mutex mutex_;  ///< guards result_.failures and result_.file_notes
};

/// Checks the folders before anything is read or written.
Result TilesRun::openFolders() {
  const fs::path file = gltf::pathOf(options_.input);
  std::error_code code;
  if (fs::is_directory(file, code)) {
    return {options_.input,
            "is a folder; name the tileset in it, as in " + genericText(file / "tileset.json")};
  }
  if (!fs::exists(file, code)) return {options_.input, "does not exist"};
  input_ = gltf::folderOf(file);
  output_ = gltf::pathOf(options_.output);
  if (fs::exists(output_, code) && !fs::is_directory(output_, code)) {
    return {options_.output, "is a file; the output is a folder"};
  }
  const fs::path from = fs::weakly_canonical(fs::absolute(input_), code);
  const fs::path to = fs::weakly_canonical(fs::absolute(output_), code);
  const fs::path plain_to = to.has_filename() ? to : to.parent_path();
  if (isInside(plain_to, from)) {
    return {options_.output, "is the folder of the tileset or inside of it; choose another one"};
  }
  if (isInside(from, plain_to)) {
    return {options_.output, "contains the tileset; choose another folder"};
  }
  if (!options_.report.empty()) {
    const fs::path report = fs::weakly_canonical(fs::absolute(gltf::pathOf(options_.report)), code);
    if (isInside(report, from) || isInside(report, plain_to)) {
      return {options_.report,
              "the report cannot lie in the folder of the tileset or of the output"};
    }
  }
  return {};
}

/// Lists every file in the folder of the tileset, so that OUT is complete whatever names them, and
/// finds out what the tiles ask of them.
Result TilesRun::walk() {
  const fs::path file = gltf::pathOf(options_.input);
  MCC_GLTF_TRY(result_.table.read(input_, options_.part, tiles::PartRecord::isName, result_.notes));
  return result_.walk.run(input_, genericText(file.filename()), result_.table, options_.part,
                          options_.max_tiles);
}

void TilesRun::assignRoles() {
  const tiles::FileTable& table = result_.table;
  result_.files.resize(table.size());
  roles_.assign(table.size(), Role::kNone);
  for (uint32_t i = 0; i < table.size(); ++i) {
    if (!options_.part.has(table.name(i))) continue;
    const bool is_shown = result_.walk.demandOf(i) != nullptr;
    roles_[i] = is_shown ? Role::kModel : Role::kCopy;
  }
  assignGltf();
}

/// Decides what becomes of .gltf files and their buffers. The library writes a .gltf with a buffer
/// of its own, and the old buffers are not copied. Where others need these, the .gltf is copied.
/// All parts of a tileset look at all .gltf files, and come to the same decisions.
void TilesRun::assignGltf() {
  const tiles::FileTable& table = result_.table;
  std::map<std::string, uint32_t> user_counts;
  std::map<uint32_t, Buffers> found;
  for (uint32_t i = 0; i < table.size(); ++i) {
    if (result_.walk.demandOf(i) == nullptr || !table.name(i).ends_with(".gltf")) continue;
    std::vector<uint8_t> bytes;
    Json json;
    Result read = this->read(name(i), bytes);
    if (read.ok()) read = gltf::inFile(in(name(i)), gltf::readJson(bytes, json));
    if (!read.ok()) {
      if (roles_[i] != Role::kNone) roles_[i] = Role::kCopy;
      if (roles_[i] != Role::kNone) result_.failures[i] = read;
      continue;
    }
    const fs::path folder = gltf::pathOf(table.name(i)).parent_path();
    for (const std::string& buffer : gltf::filesOf(json, "buffers")) {
      found[i].push_back(genericText((folder / gltf::pathOf(buffer)).lexically_normal()));
      ++user_counts[found[i].back()];
    }
    found[i];
  }
  for (auto& [file, buffers] : found) {
    const bool is_free = std::all_of(buffers.begin(), buffers.end(),
                                     [&](const auto& buffer) { return user_counts[buffer] == 1; });
    if (is_free) {
      for (const std::string& buffer : buffers) {
        const uint32_t number = table.find(buffer);
        if (number != kNone) roles_[number] = Role::kNone;
      }
    }
    if (roles_[file] == Role::kNone) continue;
    roles_[file] = is_free ? Role::kGltf : Role::kCopy;
    if (is_free)
      gltfs_[file] = std::move(buffers);
    else
      addNotes(file, {"shares its buffers with other files, and is only copied"});
  }
}

std::vector<std::string> TilesRun::inputsOf(uint32_t file) const {
  std::vector<std::string> names = {name(file)};
  const auto buffers = gltfs_.find(file);
  if (buffers != gltfs_.end()) {
    names.insert(names.end(), buffers->second.begin(), buffers->second.end());
  }
  return names;
}

/// Makes sure that no output is the file of somebody else, and records those that are ours.
Result TilesRun::claimOutputs() {
  std::error_code code;
  if (!fs::is_directory(output_, code)) {
    fs::create_directory(output_, code);
    if (code && !fs::is_directory(output_)) {
      return {options_.output, "the folder cannot be created: " + code.message()};
    }
  }
  if (!gltf::system::mayWrite(output_)) {
    return {options_.output, "the folder is read-only; choose another one"};
  }
  record_ = std::make_unique<tiles::PartRecord>(input_, output_, options_.part);
  MCC_GLTF_TRY(record_->open(options_.waits));
  record_->removeTemporaries();
  for (uint32_t i = 0; i < roles_.size(); ++i) {
    if (roles_[i] == Role::kNone) continue;
    const std::vector<std::string> outputs = inputsOf(i);  // if it is copied
    const auto foreign = std::find_if(outputs.begin(), outputs.end(), [&](const auto& output) {
      const fs::file_status status = fs::symlink_status(out(output), code);
      return fs::exists(status) && !(fs::is_regular_file(status) && record_->lines().has(output));
    });
    if (foreign == outputs.end()) {
      for (const std::string& output : outputs) {
        if (!record_->lines().hasOfOwn(output)) record_->lines().claim(output);
      }
      continue;
    }
    result_.failures[i] = {gltf::textOf(out(*foreign)),
                           "is there and was not written by this command; remove it or choose "
                           "another folder"};
    result_.files[i].outcome = TilesOutcome::kRefused;
    roles_[i] = Role::kNone;
  }
  return record_->lines().flush();
}

/// Returns a text that is equal as long as everything is that the output of a file depends on,
/// apart from the file. There is one for each file in the record, so it is short.
std::string TilesRun::makerOf(uint32_t file) const {
  if (!isModel(file)) return std::string(MCC_VERSION) + " copy";
  const tiles::TileDemand& demand = *result_.walk.demandOf(file);
  std::string all = settings_;
  if (!options_.has_fixed_bits) {
    all += fmt::format(" {} {} {} {}", demand.world_distance, demand.tile_distance, demand.scale,
                       static_cast<int>(demand.up_axis));
    if (demand.has_group) {
      all += fmt::format(" {} {} {} {}", result_.walk.groups().distanceOf(demand.group),
                         demand.offset[0], demand.offset[1], demand.offset[2]);
    }
  }
  return jobs::makerOf(all);
}

/// Whether a line of the record holds what keep() wrote; it may be damaged.
bool isMade(const Json& json) {
  const auto areNumbers = [](const Json& numbers) {
    return numbers[0].is_number() && numbers[1].is_number();
  };
  const Json& notes = json["notes"];
  return json["input_bytes"].is_number() && json["output_bytes"].is_number() &&
         json["is_copy"].is_boolean() && json["has_positions"].is_boolean() &&
         areNumbers(json["bits"]) && areNumbers(json["promised"]) && json["measured"].is_number() &&
         notes.is_array() &&
         std::all_of(notes.begin(), notes.end(), [](const Json& note) { return note.is_string(); });
}

jobs::Job TilesRun::describe(uint32_t file) const {
  return {name(file), makerOf(file), inputsOf(file)};
}

bool TilesRun::take(uint32_t file, const Json& json) {
  if (!isMade(json)) return false;
  TilesFile taken;
  tiles::TileFigures& figures = taken.figures;
  taken.input_bytes = json["input_bytes"].get<uint64_t>();
  taken.output_bytes = json["output_bytes"].get<uint64_t>();
  taken.outcome = json["is_copy"].get<bool>() ? TilesOutcome::kCopied : TilesOutcome::kConverted;
  figures.has_positions = json["has_positions"].get<bool>();
  figures.bits_low = json["bits"][0].get<uint8_t>();
  figures.bits_high = json["bits"][1].get<uint8_t>();
  figures.promised_error = json["promised"][0].get<double>();
  figures.largest_promise = json["promised"][1].get<double>();
  figures.measured_error = json["measured"].get<double>();
  const auto notes = json["notes"].get<std::vector<std::string>>();
  taken.is_up_to_date = true;
  result_.files[file] = taken;
  addNotes(file, notes);
  return true;
}

/// Records a file that was made, and what was made with it.
void TilesRun::keep(uint32_t file, const std::vector<std::string>& notes,
                    const std::vector<fs::path>& beside) {
  std::vector<std::string> outputs = inputsOf(file);
  for (const fs::path& path : beside)
    outputs.push_back(genericText(path.lexically_relative(output_)));
  const TilesFile& made = result_.files[file];
  const tiles::TileFigures& figures = made.figures;
  const Json json = {{"input_bytes", made.input_bytes},
                     {"output_bytes", made.output_bytes},
                     {"is_copy", made.outcome == TilesOutcome::kCopied},
                     {"has_positions", figures.has_positions},
                     {"bits", {figures.bits_low, figures.bits_high}},
                     {"promised", {figures.promised_error, figures.largest_promise}},
                     {"measured", figures.measured_error},
                     {"notes", notes}};
  record_->lines().add(describe(file), inputsOf(file), outputs, json);
}

void TilesRun::addNotes(uint32_t file, const std::vector<std::string>& notes) {
  const std::lock_guard lock(mutex_);
  for (const std::string& note : notes) result_.file_notes[note].push_back(file);
}

/// Creates the folders that a name in OUT needs. A link there could lead out of OUT.
Result TilesRun::makeFolderOf(const std::string& name) const {
  fs::path folder = output_;
  for (const fs::path& part : gltf::pathOf(name).parent_path()) {
    folder /= part;
    std::error_code code;
    const fs::file_status status = fs::symlink_status(folder, code);
    if (fs::is_directory(status)) continue;
    if (fs::exists(status)) {
      return {gltf::textOf(folder), "is not a folder; remove it or choose another output"};
    }
    fs::create_directory(folder, code);
    if (code && !fs::is_directory(folder)) {
      return {gltf::textOf(folder), "the folder cannot be created: " + code.message()};
    }
  }
  return {};
}

/// Writes a file of OUT, which appears complete or not at all.
Result TilesRun::store(const std::string& name, std::span<const uint8_t> bytes) {
  MCC_GLTF_TRY(makeFolderOf(name));
  std::error_code code;
  const bool is_new = !fs::exists(fs::symlink_status(out(name), code));
  gltf::ReplacementFile file(out(name), &temporaryFiles());
  MCC_GLTF_TRY(file.check());
  MCC_GLTF_TRY(file.write(bytes));
  if (!is_new) {
    MCC_GLTF_TRY(file.commit());
    return file.flushName();
  }
  return file.commitNew();  // fails if somebody else's file has appeared meanwhile
}

Result TilesRun::copyOne(uint32_t file) {
  TilesFile& made = result_.files[file];
  made = {};
  const std::vector<std::string> inputs = inputsOf(file);
  std::vector<std::string> notes;
  for (size_t i = 0; i < inputs.size(); ++i) {
    std::vector<uint8_t> bytes;
    const Result found = read(inputs[i], bytes);
    if (i == 0) MCC_GLTF_TRY(found);
    if (!found.ok()) {
      notes.push_back("its buffer \"" + inputs[i] + "\" is not copied: " + found.what);
      continue;
    }
    MCC_GLTF_TRY(store(i == 0 ? name(file) : inputs[i], bytes));
    made.input_bytes += bytes.size();
    made.output_bytes += bytes.size();
  }
  addNotes(file, notes);
  made.outcome = TilesOutcome::kCopied;
  return {};
}

Result TilesRun::chooseFor(uint32_t file, std::span<const uint8_t> glb,
                           const tiles::TileModel& model, tiles::Accuracy& accuracy) const {
  tiles::Placement placement;
  MCC_GLTF_TRY(tiles::placementOf(glb, model, placement));
  accuracy = tiles::chooseAccuracy(*result_.walk.demandOf(file), result_.walk.groups(), model,
                                   placement, options_.has_fixed_bits ? 0 : options_.error_share);
  return {};
}

/// Converts a JSON glTF, whose buffers are other files.
Result TilesRun::makeGltf(uint32_t file) {
  TilesFile& made = result_.files[file];
  std::vector<uint8_t> bytes;
  MCC_GLTF_TRY(read(name(file), bytes));
  tiles::Accuracy accuracy;
  MCC_GLTF_TRY(chooseFor(file, bytes, {0, bytes.size()}, accuracy));
  gltf::ConvertOptions options = options_.convert;
  accuracy.applyTo(options);
  MCC_GLTF_TRY(makeFolderOf(name(file)));
  gltf::ConvertReport report;
  gltf::FilesInUse files;
  MCC_GLTF_TRY(gltf::convertTo({{out(name(file)), nullptr}, &temporaryFiles(), &files},
                               {in(name(file)), {}}, options, report, input_));
  made.figures.add(report, accuracy);
  made.input_bytes = report.input_bytes;
  made.output_bytes = report.output_bytes;
  made.outcome = report.copied ? TilesOutcome::kCopied : TilesOutcome::kConverted;
  std::vector<std::string> notes = report.notes;
  if (!accuracy.note.empty()) notes.push_back(accuracy.note);
  addNotes(file, notes);
  keep(file, notes, {files.output.begin() + 1, files.output.end()});
  return {};
}

/// Converts a tile in memory. `output` is what is to be stored.
Result TilesRun::convertBytes(uint32_t file, std::vector<uint8_t> bytes,
                              std::vector<uint8_t>& output, tiles::TileFigures& figures,
                              std::vector<std::string>& notes) const {
  const auto choose = [&](std::span<const uint8_t> glb, const tiles::TileModel& model,
                          tiles::Accuracy& accuracy) {
    return chooseFor(file, glb, model, accuracy);
  };
  MCC_GLTF_TRY(tiles::convertTile(bytes, choose, options_.convert, output, figures, notes));
  if (output.empty()) output = std::move(bytes);
  return {};
}

Result TilesRun::makeModel(uint32_t file) {
  TilesFile& made = result_.files[file];
  std::vector<uint8_t> bytes;
  MCC_GLTF_TRY(read(name(file), bytes));
  std::vector<uint8_t> output;
  std::vector<std::string> notes;
  MCC_GLTF_TRY(
      gltf::inFile(in(name(file)), convertBytes(file, bytes, output, made.figures, notes)));
  MCC_GLTF_TRY(store(name(file), output));
  made.input_bytes = bytes.size();
  made.output_bytes = output.size();
  made.outcome = output == bytes ? TilesOutcome::kCopied : TilesOutcome::kConverted;
  addNotes(file, notes);
  keep(file, notes);
  return {};
}

/// Makes one output. What cannot be converted is copied as it is.
Result TilesRun::makeOne(uint32_t file) {
  const Role role = roles_[file];
  Result made = gltf::guarded([&]() -> Result {
    if (role == Role::kModel) return makeModel(file);
    if (role == Role::kGltf) return makeGltf(file);
    MCC_GLTF_TRY(copyOne(file));
    keep(file, {});
    return {};
  });
  if (made.ok()) return made;
  if (role != Role::kCopy) {
    const Result copied = gltf::guarded([&]() { return copyOne(file); });
    if (copied.ok())
      addNotes(file, {"cannot be converted, and is only copied"});
    else
      made = copied;
  }
  if (role == Role::kCopy || result_.files[file].outcome != TilesOutcome::kCopied) {
    result_.files[file].outcome = TilesOutcome::kRefused;
  }
  return made;
}

void TilesRun::makeAll(std::vector<uint32_t> files, const char* what) {
  const size_t count = files.size();
  jobs::Work work;
  work.bytesOf = [this](uint32_t file) { return result_.table.bytes(file); };
  work.describe = [this](uint32_t file) { return describe(file); };
  work.take = [this](uint32_t file, const Json& made) { return take(file, made); };
  work.make = [this](uint32_t file) { return makeOne(file); };
  work.end = [&](uint32_t file, const Result& made, size_t done) {
    if (!made.ok()) {
      const std::lock_guard lock(mutex_);
      result_.failures[file] = made;
    }
    line_.show(jobs::progressText(done, count) + " " + what);
  };
  work.thread_count = options_.job_count;
  work.is_forced = options_.is_forced;
  const Result all = runJobs(std::move(files), work, record_->lines());
  line_.clear();
  if (!all.ok()) result_.notes.push_back(all.message());
}

/// Copies before it converts, because a .gltf refuses to replace an image that differs. Tilesets
/// come last, so that what they name is there.
void TilesRun::makeAll() {
  std::vector<uint32_t> copies;
  std::vector<uint32_t> models;
  std::vector<uint32_t> tilesets;
  std::vector<bool> is_tileset(roles_.size(), false);
  for (const uint32_t file : result_.walk.tilesets()) is_tileset[file] = true;
  for (uint32_t i = 0; i < roles_.size(); ++i) {
    if (roles_[i] == Role::kNone) continue;
    (is_tileset[i] ? tilesets : isModel(i) ? models : copies).push_back(i);
  }
  makeAll(std::move(copies), "copied");
  makeAll(std::move(models), "converted");
  makeAll(std::move(tilesets), "copied");
}

int TilesRun::printResults() {
  int status = kDone;
  const bool is_json = options_.common.format == Format::kJson && !options_.common.is_quiet;
  const std::string json =
      is_json || !options_.report.empty() ? tilesReportJson(result_) : std::string();
  if (!options_.report.empty()) {
    const Result written = writeReport(options_.report, json);
    if (!written.ok()) status = reportFailure(written);
  }
  if (!options_.common.is_quiet) {
    const std::string text = is_json ? json : tilesReportText(result_, options_.common);
    if (printOut(text) != kDone) status = kFailed;
  }
  const tiles::TilesetWalk& walk = result_.walk;
  for (const Result& failure : walk.failures()) status = reportFailure(failure);
  if (walk.failureCount() > walk.failures().size()) {
    status =
        reportFailure({options_.input, fmt::format("{} more parts of the tilesets are wrong",
                                                   walk.failureCount() - walk.failures().size())});
  }
  for (const auto& [file, failure] : result_.failures) status = reportFailure(failure);
  return status;
}

void TilesRun::addLevelNotes() {
  if (result_.walk.remoteCount() != 0) {
    result_.notes.push_back(counted(result_.walk.remoteCount(), "content", "contents") +
                            " on servers or in data URIs stay as they are");
  }
  if (options_.has_fixed_bits) return;
  for (const auto& [level, count] : result_.walk.groups().countByLevel()) {
    if (count == 1) continue;
    result_.notes.push_back(
        fmt::format("the tiles of level {} have transforms of {} kinds, apart from translations; "
                    "borders are exact between tiles of one kind, and within the promised errors "
                    "elsewhere",
                    level, count));
  }
}

int TilesRun::run() {
  Result ready = openFolders();
  if (ready.ok() && !options_.report.empty()) ready = checkReport(options_.report);
  if (ready.ok()) ready = walk();
  if (!ready.ok()) return reportFailure(ready);
  result_.input = options_.input;
  result_.output = options_.output;
  result_.settings = gltf::optionsJson(options_.convert);
  result_.settings["error_share"] =
      options_.has_fixed_bits ? Json(nullptr) : Json(options_.error_share);
  result_.part = options_.part.name();
  settings_ = result_.settings.dump();
  addLevelNotes();
  assignRoles();
  ready = claimOutputs();
  if (!ready.ok()) return reportFailure(ready);
  makeAll();
  const int status = printResults();
  Result recorded = record_->lines().flush();
  if (recorded.ok()) return status;
  recorded.what += "; the next run makes again what is not in it";
  return reportFailure(recorded);
}

}  // namespace

int runTiles(const TilesOptions& options) { return TilesRun(options).run(); }

}  // namespace mcc::tool
