// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "gltf/files/destination.h"

#include <algorithm>
#include <chrono>
#include <system_error>

#include "host/system.h"
#include "host/text.h"
#include "host/work_lock.h"

namespace mcc::gltf {
namespace {

namespace fs = std::filesystem;

/// How long to wait for others that write to the folder, who need it for a few renames.
constexpr std::chrono::milliseconds kPatience(2000);

/// Normalises a path: "./a//b" becomes "a/b".
std::string normalized(const std::string& path) {
  return textOf(pathOf(path).lexically_normal().generic_u8string());
}

/// Returns a key that is equal for all relative paths of one file, links aside.
std::string keyOfName(const std::string& path) {
  return system::nameKey(pathOf(path).lexically_normal());
}

/// Returns the files next to the document at `main`; none if it is not a document.
std::vector<std::string> filesOfDocument(const fs::path& main) {
  std::vector<uint8_t> bytes;
  Json json;
  const bool is_document = readFile(main, bytes).ok() && readJson(bytes, json).ok();
  return is_document ? filesBeside(json) : std::vector<std::string>();
}

/// Whether the file at `main` is a document that refers to the file with this key next to it.
bool refersTo(const fs::path& main, const std::string& key) {
  const std::vector<std::string> paths = filesOfDocument(main);
  return std::any_of(paths.begin(), paths.end(),
                     [&](const std::string& path) { return keyOfName(path) == key; });
}

bool hasContent(const fs::path& path, std::span<const uint8_t> content) {
  std::error_code code;
  if (fs::file_size(path, code) != content.size() || code) return false;
  std::vector<uint8_t> bytes;
  return readFile(path, bytes).ok() &&
         std::equal(bytes.begin(), bytes.end(), content.begin(), content.end());
}

}  // namespace

Destination::Destination(fs::path main, TemporaryFiles* temporaries)
    : temporaries_(temporaries),
      main_path_(std::move(main)),
      folder_(folderOf(main_path_)),
      main_(main_path_, temporaries) {}

Destination::~Destination() {
  sides_.clear();
  std::error_code ignored;
  for (auto folder = new_folders_.rbegin(); folder != new_folders_.rend(); ++folder) {
    fs::remove(*folder, ignored);  // fails if something was put into it, so that it stays
    if (temporaries_ != nullptr) temporaries_->forget(*folder);
  }
}

std::vector<fs::path> Destination::madeFiles() const {
  std::vector<fs::path> made;
  for (const std::string& path : filesOfDocument(main_path_)) {
    const std::string name = normalized(path);
    if (isNameOfMade(container_, name)) made.push_back(folder_ / pathOf(name));
  }
  return made;
}

Result Destination::check(bool with_fallback) {
  MCC_GLTF_TRY(main_.check());
  MCC_GLTF_TRY(containerOf(textOf(main_path_.filename()), container_));
  if (!with_fallback) return {};
  return checkName(container_.stem + ".fallback.bin", textOf(main_path_));
}

Result Destination::checkSource(const fs::path& source, const Json& json) {
  std::vector<fs::path> beside;
  for (const std::string& path : filesBeside(json)) {
    beside.push_back(folderOf(source) / pathOf(path));
    if (!isSameFile(main_path_, beside.back())) continue;
    return error(textOf(main_path_), "\"", textOf(main_path_),
                 "\" is part of the input and would be replaced; choose "
                 "another name or folder");
  }
  if (isSameFile(source, main_path_)) return {};
  kept_ = std::move(beside);
  kept_.push_back(source);
  return {};
}

bool Destination::isBeside(const fs::path& source) const {
  return isSameFile(folderOf(source), folder_);
}

Result Destination::createFolders(const fs::path& folder) {
  std::vector<fs::path> missing;
  std::error_code code;
  for (fs::path path = folder; !path.empty() && !fs::exists(path, code);
       path = path.parent_path()) {
    missing.push_back(path);
  }
  for (auto path = missing.rbegin(); path != missing.rend(); ++path) {
    const TemporaryFiles::Lock held = lockOf(temporaries_);
    // Another thread may have created it in the meantime.
    if (fs::create_directory(*path, code)) {
      new_folders_.push_back(*path);
      if (temporaries_ != nullptr) temporaries_->add(*path);
    }
    if (code) return error(textOf(*path), "cannot be created: ", code.message());
  }
  return {};
}

const Destination::Side* Destination::sideOf(const std::string& key) const {
  const auto found = std::find_if(sides_.begin(), sides_.end(),
                                  [&](const auto& side) { return side->key == key; });
  return found == sides_.end() ? nullptr : found->get();
}

/// Writes a copy, unless an equal file is already there, or will be under another spelling.
Result Destination::writeCopy(const SideFile& copy) {
  const std::string name = normalized(copy.path);
  const fs::path path = folder_ / pathOf(name);
  std::error_code ignored;
  const bool is_there = fs::exists(fs::symlink_status(path, ignored));
  if (is_there && hasContent(path, copy.bytes)) return {};
  const std::string key = keyOfName(name);
  const Side* side = sideOf(key);
  if (side != nullptr && hasContent(side->file.temporaryPath(), copy.bytes)) return {};
  const bool is_ours = side != nullptr || key == keyOfName(textOf(main_path_.filename()));
  if (is_ours || (is_there && !refersTo(main_path_, key))) {
    return error(textOf(main_path_), "a file next to the input has to be copied to \"",
                 textOf(path), "\", which is another file; choose another folder");
  }
  MCC_GLTF_TRY(createFolders(folderOf(path)));
  return writeSide(copy);
}

/// `older` is a file that the new one stands for, under another name.
Result Destination::writeSide(const SideFile& side, const fs::path& older) {
  const std::string name = normalized(side.path);
  sides_.push_back(std::unique_ptr<Side>(
      new Side{side.kind, keyOfName(name), ReplacementFile(folder_ / pathOf(name), temporaries_)}));
  ReplacementFile& file = sides_.back()->file;
  MCC_GLTF_TRY(file.check());
  return file.write(side.bytes, older);
}

Result Destination::write(const Package& package) {
  fs::path older = main_path_;
  for (const fs::path& made : package.beside.empty() ? std::vector<fs::path>() : madeFiles()) {
    std::error_code ignored;
    if (fs::exists(made, ignored)) older = made;
  }
  for (const SideFile& side : package.beside) {
    if (side.kind != SideFile::Kind::kCopy) MCC_GLTF_TRY(writeSide(side, older));
  }
  for (const SideFile& side : package.beside) {
    if (side.kind == SideFile::Kind::kCopy) MCC_GLTF_TRY(writeCopy(side));
  }
  return main_.write(package.main);
}

Result Destination::readBack(std::vector<uint8_t>& main) const {
  return readFile(main_.temporaryPath(), main);
}

FileReader Destination::reader() const {
  return [this](const std::string& path, const std::string& where, std::vector<uint8_t>& bytes) {
    const Side* side = sideOf(keyOfName(path));
    if (side != nullptr) return readFile(side->file.temporaryPath(), bytes);
    return error(where, "\"", path, "\" was not written");
  };
}

/// Gives a file next to the main one its name. If a file has it, it must be equal, or a copy that
/// belongs to the main file.
Result Destination::commitSide(Side& side) {
  const fs::path& path = side.file.destination();
  Result placed = side.file.commitNew();
  if (placed.ok()) new_files_.push_back(path);
  if (placed.ok()) return placed;
  std::vector<uint8_t> bytes;
  const bool may_replace =
      (readFile(side.file.temporaryPath(), bytes).ok() && hasContent(path, bytes)) ||
      (side.kind == SideFile::Kind::kCopy && refersTo(main_path_, side.key));
  return may_replace ? side.file.commit() : placed;
}

/// Removes files that the main file does not name, apart from those of the source.
void Destination::removeUnnamed(const std::vector<fs::path>& paths) const {
  if (paths.empty()) return;
  const std::vector<fs::path> named = madeFiles();
  for (const fs::path& path : paths) {
    const auto isIt = [&](const fs::path& other) { return isSameFile(path, other); };
    std::error_code ignored;
    if (std::any_of(named.begin(), named.end(), isIt)) continue;
    if (std::any_of(kept_.begin(), kept_.end(), isIt)) continue;
    system::remove(path, ignored);
  }
}

Result Destination::commit() {
  // Taken before the lock of the temporary files, because the thread that handles signals waits for
  // that one.
  WorkLock alone;
  const bool has_made = container_.is_gltf || !sides_.empty();
  if (has_made) alone.take(folder_, kPatience);
  const TemporaryFiles::Lock held = lockOf(temporaries_);
  Result result;
  for (size_t i = 0; i < sides_.size() && result.ok(); ++i) result = commitSide(*sides_[i]);
  std::vector<fs::path> older;
  if (has_made) older = madeFiles();
  if (result.ok()) result = main_.commit();
  if (!result.ok()) {
    removeUnnamed(new_files_);
    return result;
  }
  for (const fs::path& folder : new_folders_) {
    if (temporaries_ != nullptr) temporaries_->forget(folder);
  }
  new_folders_.clear();
  for (const auto& side : sides_) {
    if (side->kind == SideFile::Kind::kCopy) MCC_GLTF_TRY(side->file.flushName());
  }
  MCC_GLTF_TRY(main_.flushName());
  // After a crash either main file may be there, until the new one is stored.
  if (alone.isHeld()) removeUnnamed(older);
  return {};
}

void Destination::listFiles(FilesInUse& files) const {
  files.output = {main_path_};
  files.other_output.clear();
  for (const auto& side : sides_) {
    if (side->kind == SideFile::Kind::kCopy) continue;
    const bool is_buffer = side->kind == SideFile::Kind::kBuffer;
    (is_buffer ? files.output : files.other_output).push_back(side->file.destination());
  }
}

}  // namespace mcc::gltf
