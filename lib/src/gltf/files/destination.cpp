// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "gltf/files/destination.h"

#include <algorithm>
#include <optional>
#include <system_error>

#include "gltf/base/path_text.h"
#include "gltf/document/uri.h"
#include "gltf/files/folder_lock.h"
#include "gltf/files/system.h"

namespace mcc::gltf {
namespace {

namespace fs = std::filesystem;

/// Normalises a path: "./a//b" becomes "a/b".
std::string normalized(const std::string& path) {
  return textOf(pathOf(path).lexically_normal().generic_u8string());
}

/// Returns a key that is equal for all relative paths of one file, links aside.
std::string keyOfName(const std::string& path) {
  return system::nameKey(pathOf(path).lexically_normal());
}

/// Whether the file at `main` is a document that refers to the file with this key next to it.
bool refersTo(const fs::path& main, const std::string& key) {
  std::vector<uint8_t> bytes;
  if (!readFile(main, bytes).ok()) return false;
  Json json;
  if (!readJson(bytes, json).ok()) return false;
  const std::vector<std::string> paths = filesBeside(json);
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

std::vector<std::string> Destination::ownNames() const {
  std::vector<std::string> names;
  if (container_.is_gltf) names.push_back(container_.buffer_name);
  if (with_fallback_) names.push_back(container_.fallback_name);
  return names;
}

Result Destination::checkOwner(const std::string& name) const {
  const fs::path path = folder_ / pathOf(name);
  std::error_code ignored;
  if (!fs::exists(fs::symlink_status(path, ignored)) || refersTo(main_path_, keyOfName(name)))
    return {};
  return error(textOf(main_path_), "\"" + textOf(path) +
                                       "\" would be replaced, which does not belong to it; move "
                                       "that file or choose another name");
}

Result Destination::check(bool with_fallback) {
  MCC_GLTF_TRY(main_.check());
  MCC_GLTF_TRY(containerOf(textOf(main_path_.filename()), container_));
  with_fallback_ = with_fallback;
  if (with_fallback && !isUsableName(container_.fallback_name)) {
    return error(textOf(main_path_), "no URI can name a file \"" + container_.fallback_name +
                                         "\"; choose another name");
  }
  for (const std::string& name : ownNames()) {
    MCC_GLTF_TRY(ReplacementFile(folder_ / pathOf(name)).check());
    MCC_GLTF_TRY(checkOwner(name));
  }
  return {};
}

Result Destination::checkSource(const fs::path& source, const Json& json) const {
  const bool is_in_place = isSameFile(source, main_path_);
  const auto refuse = [&](const fs::path& path) {
    return error(textOf(main_path_), "\"" + textOf(path) +
                                         "\" is part of the input and would be replaced; choose "
                                         "another name or folder");
  };
  const std::vector<std::string> of_source = filesBeside(json);
  for (const std::string& beside : of_source) {
    if (isSameFile(main_path_, folderOf(source) / pathOf(beside))) return refuse(main_path_);
  }
  for (const std::string& name : ownNames()) {
    const fs::path path = folder_ / pathOf(name);
    if (isSameFile(path, source)) return refuse(path);
    if (is_in_place) continue;
    for (const std::string& beside : of_source) {
      if (isSameFile(path, folderOf(source) / pathOf(beside))) return refuse(path);
    }
  }
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
    if (code) return error(textOf(*path), "cannot be created: " + code.message());
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
    return error(textOf(main_path_), "a file next to the input has to be copied to \"" +
                                         textOf(path) +
                                         "\", which is another file; choose another folder");
  }
  MCC_GLTF_TRY(createFolders(folderOf(path)));
  return writeSide(copy);
}

Result Destination::writeSide(const SideFile& side) {
  const std::string name = normalized(side.path);
  MCC_GLTF_TRY(ReplacementFile(folder_ / pathOf(name)).check());
  std::error_code ignored;
  const bool is_new = !fs::exists(fs::symlink_status(folder_ / pathOf(name), ignored));
  sides_.push_back(std::unique_ptr<Side>(new Side{
      side.kind, is_new, keyOfName(name), ReplacementFile(folder_ / pathOf(name), temporaries_)}));
  return sides_.back()->file.write(side.bytes);
}

Result Destination::write(const Package& package) {
  for (const SideFile& side : package.beside) {
    if (side.kind != SideFile::Kind::kCopy) MCC_GLTF_TRY(writeSide(side));
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
    return error(where, "\"" + path + "\" was not written");
  };
}

/// Commits a file next to the main one. Where no file was when the work began, another conversion
/// to the same name may have finished first; then its whole set of files is replaced by ours.
Result Destination::commitSide(Side& side) {
  if (!side.is_new) return side.file.commitForNow();
  Result result = side.file.commitNew();
  return !result.ok() && refersTo(main_path_, side.key) ? side.file.commitForNow() : result;
}

Result Destination::commit() {
  // Taken before the lock of the temporary files, because the thread that handles signals waits for
  // that one.
  std::optional<FolderLock> alone;
  if (!sides_.empty()) alone.emplace(folder_, FolderLock::Kind::kAlone);
  const TemporaryFiles::Lock held = lockOf(temporaries_);
  Result result;
  size_t done = 0;
  while (done < sides_.size() && result.ok()) {
    result = commitSide(*sides_[done]);
    if (result.ok()) ++done;
  }
  if (result.ok()) result = main_.commit();
  if (!result.ok()) {
    while (done-- != 0) sides_[done]->file.undo();
    return result;
  }
  for (const auto& side : sides_) side->file.keep();
  for (const fs::path& folder : new_folders_) {
    if (temporaries_ != nullptr) temporaries_->forget(folder);
  }
  new_folders_.clear();
  MCC_GLTF_TRY(checkTogether());
  for (const auto& side : sides_) MCC_GLTF_TRY(side->file.flushName());
  return main_.flushName();
}

Result Destination::checkTogether() const {
  const bool is_ours = std::all_of(sides_.begin(), sides_.end(),
                                   [](const auto& side) { return side->file.isInPlace(); });
  if (is_ours || !main_.isInPlace()) return {};
  return error(textOf(main_path_),
               "another program wrote the same files at the same time, and they "
               "may not belong together; write them again");
}

std::vector<fs::path> Destination::files() const {
  std::vector<fs::path> paths = {main_path_};
  for (const auto& side : sides_) {
    if (side->kind == SideFile::Kind::kBuffer) paths.push_back(side->file.destination());
  }
  return paths;
}

}  // namespace mcc::gltf
