// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "tiles_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <memory>
#include <mutex>
#include <numeric>

#include "convert_report.h"
#include "gltf/api/convert.h"
#include "gltf/base/parallel.h"
#include "gltf/base/path_text.h"
#include "gltf/base/printable.h"
#include "gltf/base/result.h"
#include "gltf/document/package.h"
#include "gltf/files/file_io.h"
#include "gltf/inspect/report_json.h"
#include "interrupt.h"
#include "progress_line.h"
#include "tiles/accuracy.h"
#include "tiles/convert_tile.h"
#include "tiles/record.h"
#include "tiles/tile_file.h"
#include "tiles_report.h"

namespace mcc::tool {
namespace {

namespace fs = std::filesystem;
using gltf::Result;
using Json = nlohmann::ordered_json;

std::string genericText(const fs::path& path) {
  const std::u8string text = path.generic_u8string();
  return {text.begin(), text.end()};
}

/// Whether a path is a folder or lies in it. Both are absolute and without links.
bool isInside(const fs::path& path, const fs::path& folder) {
  const fs::path relative = path.lexically_relative(folder);
  return !relative.empty() && *relative.begin() != "..";
}

class TilesRun {
 public:
  explicit TilesRun(const TilesOptions& options)
      : options_(options), line_(options.common.is_quiet) {}

  int run();

 private:
  /// What the survey found out about a content, apart from the placements.
  struct Side {
    std::vector<std::string> buffers;  ///< files of its buffers, relative to the folder
    bool is_gltf = false;              ///< JSON, with its buffers in other files
    Result failure;
  };

  Result openFolders();
  Result listFiles();
  Result addFile(const fs::directory_entry& entry);
  void surveyAll();
  Result surveyOne(const TilesFile& file);
  void settleBuffers();
  Result claimOutputs();
  void chooseAll();
  void makeAll();
  void makeOne(TilesFile& file);
  Result convertOne(TilesFile& file);
  Result convertGltf(TilesFile& file);
  Result copyOne(TilesFile& file, const std::string& name);
  Result store(const std::string& name, std::span<const uint8_t> bytes);
  Result makeFolderOf(const std::string& name) const;
  bool takeUpToDate(TilesFile& file) const;
  void keep(const TilesFile& file);
  bool isModel(const TilesFile& file) const {
    return file.content != kNone && !surveys_[file.content].placements.empty();
  }
  std::string makerOf(const TilesFile& file) const;
  std::vector<std::string> inputsOf(const TilesFile& file) const;
  std::vector<std::string> outputsOf(const TilesFile& file) const;
  void showProgress(const char* what);
  void runAll(const std::vector<size_t>& order, const char* what,
              const std::function<void(TilesFile&)>& job);
  int printResults();

  fs::path in(const std::string& name) const { return input_ / gltf::pathOf(name); }
  fs::path out(const std::string& name) const { return output_ / gltf::pathOf(name); }

  const TilesOptions& options_;
  fs::path input_;
  fs::path output_;
  TilesRunResult result_;
  std::vector<tiles::Survey> surveys_;  ///< by content, as the two below
  std::vector<Side> sides_;
  std::vector<std::vector<tiles::Accuracy>> accuracies_;
  std::unique_ptr<tiles::Record> record_;
  std::map<std::string, size_t> file_numbers_;
  std::vector<bool> is_claimed_;  ///< by file: false: its output is somebody else's
  ProgressLine line_;
  std::mutex mutex_;  ///< guards record_, done_ and line_
  size_t done_ = 0;
  size_t job_total_ = 0;
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

Result TilesRun::addFile(const fs::directory_entry& entry) {
  std::error_code code;
  const std::string name = genericText(entry.path().lexically_relative(input_));
  if (entry.is_directory(code) && !entry.is_symlink(code)) return {};
  if (!entry.is_regular_file(code)) {
    result_.notes.push_back(name + ": is neither a file nor a folder, and is left out");
    return {};
  }
  if (entry.is_symlink(code)) {
    const fs::path target = fs::canonical(entry.path(), code);
    if (!isInside(target, fs::canonical(input_, code))) {
      result_.notes.push_back(name + ": is a link to a file elsewhere, and is left out");
      return {};
    }
  }
  if (name == genericText(tiles::Record::pathIn({}))) return {};  // IN was the OUT of a run
  TilesFile file;
  file.path = name;
  file.size = entry.file_size(code);
  result_.files.push_back(std::move(file));
  return {};
}

/// Lists every file in the folder of the tileset, so that OUT is complete whatever names them.
Result TilesRun::listFiles() {
  std::error_code code;
  for (fs::recursive_directory_iterator it(input_, code), end; !code && it != end;
       it.increment(code)) {
    MCC_GLTF_TRY(addFile(*it));
  }
  if (code) return {gltf::textOf(input_), "the folder cannot be read: " + code.message()};
  std::vector<TilesFile>& files = result_.files;
  std::sort(files.begin(), files.end(),
            [](const TilesFile& a, const TilesFile& b) { return a.path < b.path; });
  for (size_t i = 0; i < files.size(); ++i) file_numbers_[files[i].path] = i;
  const auto& contents = result_.tileset.contents;
  for (uint32_t c = 0; c < contents.size(); ++c) {
    const auto found = file_numbers_.find(contents[c].path);
    if (found != file_numbers_.end()) {
      files[found->second].content = c;
    } else {
      result_.tileset.failures.push_back(
          {contents[c].where, "names no file that is there: \"" + contents[c].path + "\""});
    }
  }
  surveys_.resize(contents.size());
  sides_.resize(contents.size());
  return {};
}

/// Reads a content to find out where its models are. What is damaged is found out here.
Result TilesRun::surveyOne(const TilesFile& file) {
  std::vector<uint8_t> bytes;
  MCC_GLTF_TRY(gltf::readFile(in(file.path), bytes));
  tiles::Survey& survey = surveys_[file.content];
  Side& side = sides_[file.content];
  const tiles::TileKind kind = tiles::kindOf(bytes);
  if (kind == tiles::TileKind::kOther) return {};
  tiles::TileFile tile;
  std::vector<tiles::TileModel> models;
  if (kind == tiles::TileKind::kJson) {
    side.is_gltf = gltf::pathOf(file.path).extension() == ".gltf";
    if (!side.is_gltf) return {};
    models.push_back({0, bytes.size()});
  } else {
    MCC_GLTF_TRY(tile.read(bytes));
    models = tile.models();
  }
  const fs::path folder = gltf::pathOf(file.path).parent_path();
  for (const tiles::TileModel& model : models) {
    const auto of_model =
        std::span<const uint8_t>(bytes).subspan(model.begin, model.end - model.begin);
    Json json;
    MCC_GLTF_TRY(gltf::readJson(of_model, json));
    for (const std::string& name : gltf::filesOf(json, "buffers")) {
      side.buffers.push_back(genericText((folder / gltf::pathOf(name)).lexically_normal()));
    }
    tiles::Placement placement;
    MCC_GLTF_TRY(tiles::placementOf(of_model, model, placement));
    survey.placements.push_back(std::move(placement));
  }
  return {};
}

void TilesRun::surveyAll() {
  std::vector<size_t> order;
  for (size_t i = 0; i < result_.files.size(); ++i) {
    if (result_.files[i].content != kNone) order.push_back(i);
  }
  runAll(order, "looked at", [this](TilesFile& file) {
    file.failure = gltf::inFile(in(file.path), surveyOne(file));
    if (!file.failure.ok()) surveys_[file.content].placements.clear();
  });
}

/// Decides what becomes of the buffers of .gltf files. The library writes a.gltf with a.bin, which
/// must not be the place of anything else, and the old buffers are not copied. Where that cannot
/// be, the .gltf is copied.
void TilesRun::settleBuffers() {
  std::map<std::string, uint32_t> user_counts;
  for (const Side& side : sides_) {
    for (const std::string& name : side.buffers) ++user_counts[name];
  }
  std::vector<bool> is_replaced(result_.files.size(), false);
  for (TilesFile& file : result_.files) {
    if (!isModel(file) || !sides_[file.content].is_gltf) continue;
    Side& side = sides_[file.content];
    std::string bin = genericText(gltf::pathOf(file.path).replace_extension(".bin"));
    bool is_free = !file_numbers_.contains(bin) ||
                   std::find(side.buffers.begin(), side.buffers.end(), bin) != side.buffers.end();
    for (const std::string& name : side.buffers) is_free = is_free && user_counts[name] == 1;
    if (!is_free) {
      file.figures.notes.push_back("shares its buffers with other files, and is only copied");
      surveys_[file.content].placements.clear();
      continue;
    }
    for (const std::string& name : side.buffers) {
      const auto found = file_numbers_.find(name);
      if (found != file_numbers_.end()) is_replaced[found->second] = true;
    }
  }
  std::vector<TilesFile> kept;
  for (size_t i = 0; i < result_.files.size(); ++i) {
    if (!is_replaced[i]) kept.push_back(std::move(result_.files[i]));
  }
  result_.files = std::move(kept);
}

std::vector<std::string> TilesRun::inputsOf(const TilesFile& file) const {
  std::vector<std::string> names = {file.path};
  if (isModel(file) && sides_[file.content].is_gltf) {
    const Side& side = sides_[file.content];
    names.insert(names.end(), side.buffers.begin(), side.buffers.end());
  }
  return names;
}

/// Returns every name that may be written for a file.
std::vector<std::string> TilesRun::outputsOf(const TilesFile& file) const {
  std::vector<std::string> names = inputsOf(file);
  if (isModel(file) && sides_[file.content].is_gltf) {
    const std::string bin = genericText(gltf::pathOf(file.path).replace_extension(".bin"));
    if (std::find(names.begin(), names.end(), bin) == names.end()) names.push_back(bin);
  }
  return names;
}

/// Makes sure that no output is the file of somebody else, and records those that are ours.
Result TilesRun::claimOutputs() {
  std::error_code code;
  if (!fs::is_directory(output_, code)) {
    fs::create_directory(output_, code);
    if (code) return {options_.output, "the folder cannot be created: " + code.message()};
  }
  record_ = std::make_unique<tiles::Record>(input_, output_);
  MCC_GLTF_TRY(record_->read());
  record_->removeTemporaries();
  std::vector<std::string> names;
  is_claimed_.assign(result_.files.size(), true);
  for (size_t i = 0; i < result_.files.size(); ++i) {
    TilesFile& file = result_.files[i];
    const std::vector<std::string> outputs = outputsOf(file);
    for (const std::string& name : outputs) {
      const fs::file_status status = fs::symlink_status(out(name), code);
      if (!fs::exists(status) || (record_->isOurs(name) && fs::is_regular_file(status))) continue;
      file.failure = {gltf::textOf(out(name)),
                      "is there and was not written by this command; remove it or choose another "
                      "folder"};
      is_claimed_[i] = false;
    }
    if (is_claimed_[i]) names.insert(names.end(), outputs.begin(), outputs.end());
  }
  return record_->begin(names, &temporaryFiles());
}

void TilesRun::chooseAll() {
  if (options_.has_fixed_bits) {
    for (const tiles::Survey& survey : surveys_) {
      accuracies_.emplace_back(survey.placements.size());
      for (size_t m = 0; m < survey.placements.size(); ++m) {
        accuracies_.back()[m].scale = survey.placements[m].scale;
      }
    }
    return;
  }
  tiles::Accuracies chosen =
      tiles::chooseAccuracies(result_.tileset, surveys_, options_.error_share);
  accuracies_ = std::move(chosen.of_models);
  result_.notes.insert(result_.notes.end(), chosen.notes.begin(), chosen.notes.end());
}

std::string TilesRun::makerOf(const TilesFile& file) const {
  std::string maker = MCC_VERSION;
  if (!isModel(file)) return maker + " copy";
  maker += " " + result_.settings.dump();
  for (const tiles::Accuracy& accuracy : accuracies_[file.content]) maker += " " + accuracy.key();
  return maker;
}

bool TilesRun::takeUpToDate(TilesFile& file) const {
  if (options_.is_forced) return false;
  const Json* made = record_->findUpToDate(file.path, makerOf(file), inputsOf(file));
  if (made == nullptr) return false;
  try {
    tiles::TileFigures& figures = file.figures;
    file.input_bytes = made->at("input_bytes").get<uint64_t>();
    file.output_bytes = made->at("output_bytes").get<uint64_t>();
    file.outcome =
        made->at("is_copy").get<bool>() ? TilesOutcome::kCopied : TilesOutcome::kConverted;
    figures.has_positions = made->at("has_positions").get<bool>();
    figures.bits_low = made->at("bits").at(0).get<uint8_t>();
    figures.bits_high = made->at("bits").at(1).get<uint8_t>();
    figures.promised_error = made->at("promised").get<double>();
    figures.measured_error = made->at("measured").get<double>();
    figures.notes = made->at("notes").get<std::vector<std::string>>();
  } catch (const Json::exception&) {
    file.figures = {};
    return false;  // the record is damaged
  }
  file.is_up_to_date = true;
  return true;
}

void TilesRun::keep(const TilesFile& file) {
  const tiles::TileFigures& figures = file.figures;
  const Json made = {{"input_bytes", file.input_bytes},
                     {"output_bytes", file.output_bytes},
                     {"is_copy", file.outcome == TilesOutcome::kCopied},
                     {"has_positions", figures.has_positions},
                     {"bits", {figures.bits_low, figures.bits_high}},
                     {"promised", figures.promised_error},
                     {"measured", figures.measured_error},
                     {"notes", figures.notes}};
  record_->add(file.path, makerOf(file), inputsOf(file), outputsOf(file), made);
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
  if (!is_new) return file.commit();
  MCC_GLTF_TRY(file.commitNew());  // fails if somebody else's file has appeared meanwhile
  file.keep();
  return {};
}

Result TilesRun::copyOne(TilesFile& file, const std::string& name) {
  std::vector<uint8_t> bytes;
  MCC_GLTF_TRY(gltf::readFile(in(name), bytes));
  MCC_GLTF_TRY(store(name, bytes));
  file.input_bytes += bytes.size();
  file.output_bytes += bytes.size();
  file.outcome = TilesOutcome::kCopied;
  return {};
}

/// Converts a JSON glTF, whose buffers are other files.
Result TilesRun::convertGltf(TilesFile& file) {
  gltf::ConvertOptions options = options_.convert;
  accuracies_[file.content].at(0).applyTo(options);
  MCC_GLTF_TRY(makeFolderOf(file.path));
  gltf::ConvertReport report;
  MCC_GLTF_TRY(gltf::convertTo({{out(file.path), nullptr}, &temporaryFiles()}, {in(file.path), {}},
                               options, report));
  file.figures.add(report, accuracies_[file.content][0]);
  file.input_bytes = report.input_bytes;
  file.output_bytes = report.output_bytes;
  file.outcome = report.copied ? TilesOutcome::kCopied : TilesOutcome::kConverted;
  return {};
}

Result TilesRun::convertOne(TilesFile& file) {
  if (sides_[file.content].is_gltf) return convertGltf(file);
  std::vector<uint8_t> bytes;
  MCC_GLTF_TRY(gltf::readFile(in(file.path), bytes));
  std::vector<uint8_t> output;
  MCC_GLTF_TRY(
      gltf::inFile(in(file.path), tiles::convertTile(bytes, accuracies_[file.content],
                                                     options_.convert, output, file.figures)));
  MCC_GLTF_TRY(store(file.path, output.empty() ? bytes : output));
  file.input_bytes = bytes.size();
  file.output_bytes = output.empty() ? bytes.size() : output.size();
  file.outcome = output.empty() ? TilesOutcome::kCopied : TilesOutcome::kConverted;
  return {};
}

/// Makes one output. A tile that cannot be converted is copied as it is.
void TilesRun::makeOne(TilesFile& file) {
  if (takeUpToDate(file)) return;
  Result made;
  if (isModel(file)) {
    made = gltf::guarded([&]() { return convertOne(file); });
    if (!made.ok()) file.failure = made;
  }
  if (!isModel(file) || !made.ok()) {
    if (!made.ok()) file.figures = {};
    file.input_bytes = 0;
    file.output_bytes = 0;
    made = {};
    for (const std::string& name : inputsOf(file)) {
      const Result copied = gltf::guarded([&]() { return copyOne(file, name); });
      if (!copied.ok()) made = copied;
    }
    if (!made.ok()) {
      file.failure = made;
      file.outcome = TilesOutcome::kRefused;
    } else if (!file.failure.ok()) {
      file.figures.notes.push_back("cannot be converted, and is only copied");
    }
  }
  if (!file.failure.ok()) return;
  const std::lock_guard lock(mutex_);
  keep(file);
}

void TilesRun::showProgress(const char* what) {
  constexpr size_t kBarWidth = 24;
  const size_t filled = job_total_ == 0 ? kBarWidth : kBarWidth * done_ / job_total_;
  line_.show(fmt::format("[{}{}] {} of {} files {}", std::string(filled, '#'),
                         std::string(kBarWidth - filled, '-'), done_, job_total_, what));
}

/// Runs a job for each of the files. A file that fails does not stop the others.
void TilesRun::runAll(const std::vector<size_t>& order, const char* what,
                      const std::function<void(TilesFile&)>& job) {
  done_ = 0;
  job_total_ = order.size();
  const Result all = gltf::runParallel(order.size(), options_.job_count, [&](size_t i) -> Result {
    TilesFile& file = result_.files[order[i]];
    const Result done = gltf::guarded([&]() -> Result {
      job(file);
      return {};
    });
    if (!done.ok()) file.failure = {file.path, done.what};
    const std::lock_guard lock(mutex_);
    ++done_;
    showProgress(what);
    return {};
  });
  if (!all.ok()) result_.tileset.failures.push_back(all);
  line_.clear();
}

/// Copies before it converts, because a .gltf refuses to replace an image that differs. Within each
/// the largest files come first, because they take longest.
void TilesRun::makeAll() {
  std::vector<size_t> copies;
  std::vector<size_t> models;
  for (size_t i = 0; i < result_.files.size(); ++i) {
    if (is_claimed_[i]) (isModel(result_.files[i]) ? models : copies).push_back(i);
  }
  for (std::vector<size_t>* order : {&copies, &models}) {
    std::stable_sort(order->begin(), order->end(), [&](size_t a, size_t b) {
      return result_.files[a].size > result_.files[b].size;
    });
  }
  runAll(copies, "copied", [this](TilesFile& file) { makeOne(file); });
  runAll(models, "converted", [this](TilesFile& file) { makeOne(file); });
}

int TilesRun::printResults() {
  int status = kDone;
  const Json json = tilesReportJson(result_);
  if (!options_.report.empty()) {
    const Result written = writeReport(options_.report, printReport(json));
    if (!written.ok()) status = reportFailure(written);
  }
  if (!options_.common.is_quiet) {
    const std::string text = options_.common.format == Format::kJson
                                 ? printReport(json)
                                 : tilesReportText(result_, options_.common);
    if (printOut(text) != kDone) status = kFailed;
  }
  for (const Result& failure : result_.tileset.failures) status = reportFailure(failure);
  for (const TilesFile& file : result_.files) {
    if (!file.failure.ok()) status = reportFailure(file.failure);
  }
  return status;
}

int TilesRun::run() {
  Result ready = openFolders();
  if (ready.ok()) ready = tiles::readTileset(gltf::pathOf(options_.input), result_.tileset);
  if (ready.ok() && !options_.report.empty()) ready = checkReport(options_.report);
  if (ready.ok()) ready = listFiles();
  if (!ready.ok()) return reportFailure(ready);
  result_.input = options_.input;
  result_.output = options_.output;
  result_.settings = gltf::optionsJson(options_.convert);
  result_.settings["error_share"] =
      options_.has_fixed_bits ? Json(nullptr) : Json(options_.error_share);
  if (result_.tileset.implicit_count != 0) {
    result_.notes.push_back(
        fmt::format("{} with implicit tiling: their tiles are copied and not compressed",
                    counted(result_.tileset.implicit_count, "tile", "tiles")));
  }
  if (result_.tileset.remote_count != 0) {
    result_.notes.push_back(counted(result_.tileset.remote_count, "content", "contents") +
                            " on servers or in data URIs stay as they are");
  }
  surveyAll();
  settleBuffers();
  ready = claimOutputs();
  if (!ready.ok()) return reportFailure(ready);
  chooseAll();
  makeAll();
  return printResults();
}

}  // namespace

int runTiles(const TilesOptions& options) { return TilesRun(options).run(); }

}  // namespace mcc::tool
