// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Feeds a file to a SAX parser, which then knows at which byte of the file it is.
#ifndef MCC_TILES_JSON_FILE_H_
#define MCC_TILES_JSON_FILE_H_

#include <cstddef>
#include <cstdint>
#include <iterator>
#include <vector>

#include "gltf/files/named_file.h"

namespace mcc::tiles {

/// A file that is read from its beginning to its end in parts.
class JsonFile {
 public:
  /// `file` is open, and stays so as long as this object exists. Borrowed.
  explicit JsonFile(gltf::NamedFile& file) : file_(file), part_(kPartBytes) {}

  bool isAtEnd() { return at_ == filled_ && !refill(); }
  char byte() const { return part_[at_]; }
  void advance() { ++at_; }
  /// Returns how many bytes the parser has taken. After the end of a string, an object or an array
  /// that is the byte after it, because the parser looks no farther then.
  uint64_t position() const { return begin_ + at_; }

  /// What nlohmann's parser takes; the iterators of one file share its position.
  class Iterator {
   public:
    using iterator_category = std::input_iterator_tag;
    using value_type = char;
    using difference_type = ptrdiff_t;
    using pointer = const char*;
    using reference = char;

    Iterator() = default;
    explicit Iterator(JsonFile* file) : file_(file) {}
    char operator*() const { return file_->byte(); }
    Iterator& operator++() {
      file_->advance();
      return *this;
    }
    Iterator operator++(int) { return ++*this; }
    /// Only a comparison with the end has a meaning.
    bool operator==(const Iterator&) const { return file_ == nullptr || file_->isAtEnd(); }

   private:
    JsonFile* file_ = nullptr;
  };

  Iterator begin() { return Iterator(this); }
  static Iterator end() { return {}; }

 private:
  static constexpr size_t kPartBytes = size_t{1} << 16;

  bool refill() {
    begin_ += filled_;
    at_ = 0;
    filled_ = file_.readSome(part_.data(), part_.size());
    return filled_ != 0;
  }

  gltf::NamedFile& file_;
  std::vector<char> part_;
  size_t at_ = 0;
  size_t filled_ = 0;
  uint64_t begin_ = 0;  ///< of the part in the file
};

}  // namespace mcc::tiles

#endif  // MCC_TILES_JSON_FILE_H_
