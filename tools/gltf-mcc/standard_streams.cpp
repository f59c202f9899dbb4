// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "standard_streams.h"

#include <cstdio>

#include "console.h"
#include "gltf/document/package.h"
#include "gltf/files/file_io.h"
#include "host/system.h"
#include "host/text.h"
#include "interrupt.h"

namespace mcc::tool {
namespace {

constexpr char kInputName[] = "standard input";
constexpr char kOutputName[] = "standard output";

}  // namespace

gltf::Result StreamSource::open(const std::string& name) {
  name_ = name;
  std::error_code ignored;
  if (!isStandardStream(name)) {
    // Pipes, such as <(command) of a shell, can be read only once.
    const std::filesystem::file_type type =
        std::filesystem::status(gltf::pathOf(name), ignored).type();
    const bool is_read_once =
        type == std::filesystem::file_type::fifo || type == std::filesystem::file_type::character;
    return is_read_once ? gltf::readFile(gltf::pathOf(name), bytes_.emplace()) : gltf::Result{};
  }
  name_ = kInputName;
  if (isTerminal(kStandardInput)) {
    return {kInputName, "is a terminal; redirect a file to it (gltf-mcc … < model.glb)"};
  }
  return gltf::readStream(kStandardInput, kInputName, bytes_.emplace());
}

gltf::Result StreamSource::read() {
  if (bytes_) return {};
  is_file_ = true;
  return gltf::readFile(gltf::pathOf(name_), bytes_.emplace());
}

gltf::Source StreamSource::source() const {
  gltf::Source source;
  source.path = gltf::pathOf(name_);
  if (bytes_) source.bytes = *bytes_;
  source.is_read = is_file_;
  return source;
}

gltf::Result writeStandardOutput(std::span<const uint8_t> bytes) {
  bool is_written = std::fwrite(bytes.data(), 1, bytes.size(), stdout) == bytes.size();
  is_written = std::fflush(stdout) == 0 && is_written;
  // Some file systems tell only when a file is closed that they could not store it.
  const int again = is_written ? gltf::system::duplicate(kStandardOutput) : -1;
  if (again >= 0) is_written = gltf::system::close(again) == 0;
  return is_written ? gltf::Result{} : gltf::Result{kOutputName, "cannot be written"};
}

bool isStandardOutput(const std::string& name) {
  return isStandardStream(name) || gltf::openStreamOf(gltf::pathOf(name)) == kStandardOutput;
}

gltf::Result StreamSink::open(const std::string& name) {
  name_ = name;
  is_standard_output_ = tool::isStandardOutput(name);
  is_stream_ = is_standard_output_ || gltf::isStream(gltf::pathOf(name));
  if (is_standard_output_ && isTerminal(kStandardOutput)) {
    return {kOutputName,
            "is a terminal, and a GLB is binary; redirect it to a file (… > small.glb)"};
  }
  gltf::Container container;
  const bool is_gltf =
      gltf::containerOf(gltf::textOf(gltf::pathOf(name).filename()), container).ok() &&
      container.is_gltf;
  if (is_stream_ && is_gltf) {
    return {name,
            "is a device or a pipe, and a .gltf has its buffer in a file next to it; name a file"};
  }
  return gltf::checkWritable(gltf::pathOf(name));
}

gltf::ListedSink StreamSink::sink() {
  if (is_stream_)
    return {{gltf::pathOf(is_standard_output_ ? kOutputName : name_), &bytes_}, nullptr};
  return {{gltf::pathOf(name_), nullptr}, &temporaryFiles()};
}

WholeSize StreamSink::measure(const std::vector<std::filesystem::path>& files) const {
  WholeSize size = {"output"};
  is_stream_ ? size.add(bytes_) : size.addFiles(files);
  return size;
}

gltf::Result StreamSink::finish() const {
  if (!is_stream_) return {};
  return is_standard_output_ ? writeStandardOutput(bytes_)
                             : gltf::writeStream(gltf::pathOf(name_), bytes_);
}

}  // namespace mcc::tool
