// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "gltf/files/file_io.h"

#include <gtest/gtest.h>

#if !defined(_WIN32)
#include <sys/stat.h>
#include <unistd.h>

#include <fstream>

#include "host/system.h"
#include "support/scratch_folder.h"

namespace mcc::gltf::test {
namespace {

namespace fs = std::filesystem;

class NamedFiles : public testing::Test {
 protected:
  void SetUp() override {
    fs::create_directories(path("in/sub"));
    fs::create_directories(path("out"));
    for (const char* name : {"in/a", "in/sub/b", "out/secret"}) std::ofstream(path(name)) << name;
  }

  fs::path path(const std::string& name) const { return folder_.path() / name; }
  /// Returns what a document in the folder reads, or the message.
  std::string read(const std::string& name, const std::string& folder = "in",
                   const std::string& within = "") const {
    std::vector<uint8_t> bytes;
    const FileReader reader = readerOf(path(folder), within.empty() ? fs::path() : path(within));
    const Result result = reader(name, "/uri", bytes);
    return result.ok() ? std::string(bytes.begin(), bytes.end()) : result.message();
  }

  mcc::test::ScratchFolder folder_;
};

constexpr char kOut[] = "is a symbolic link out of the folder";

TEST_F(NamedFiles, LinksAreFollowedInsideOfTheFolder) {
  fs::create_symlink("sub/b", path("in/link"));
  fs::create_symlink("../a", path("in/sub/up"));
  fs::create_directory_symlink("sub", path("in/folder"));
  fs::create_symlink(path("in/a"), path("in/absolute"));
  fs::create_directory_symlink("in", path("other"));
  EXPECT_EQ(read("a"), "in/a");
  EXPECT_EQ(read("sub/../a"), "in/a");
  EXPECT_EQ(read("link"), "in/sub/b");
  EXPECT_EQ(read("sub/up"), "in/a");
  EXPECT_EQ(read("folder/b"), "in/sub/b");
  EXPECT_EQ(read("absolute"), "in/a");
  EXPECT_EQ(read("folder/b", "other"), "in/sub/b");
}

TEST_F(NamedFiles, LinksOutOfTheFolderAreRefused) {
  fs::create_symlink("../out/secret", path("in/link"));
  fs::create_directory_symlink("../out", path("in/folder"));
  fs::create_symlink("link", path("in/link2"));
  fs::create_symlink("/dev/zero", path("in/zero"));
  fs::create_symlink("../a", path("in/sub/up"));
  for (const char* name : {"link", "folder/secret", "link2", "zero"}) {
    EXPECT_EQ(read(name).find(std::string("/uri: \"") + name + "\": " + kOut), 0u) << read(name);
  }
  EXPECT_NE(read("up", "in/sub").find(kOut), std::string::npos);
  EXPECT_EQ(read("up", "in/sub", "in"), "in/a");
  EXPECT_NE(read("link", "in", "in").find(kOut), std::string::npos);
}

TEST_F(NamedFiles, OnlyRegularFilesAreOpened) {
  ASSERT_EQ(mkfifo(path("in/pipe").c_str(), 0600), 0);
  fs::create_symlink("pipe", path("in/link"));
  fs::create_symlink("nowhere", path("in/dangling"));
  for (const char* name : {"pipe", "link"}) {
    EXPECT_EQ(read(name), std::string("/uri: \"") + name + "\": is not a regular file");
  }
  for (const char* name : {"none", "none/a", "a/b", "dangling"}) {
    EXPECT_EQ(read(name), std::string("/uri: \"") + name + "\": there is no such file");
  }
  EXPECT_NE(read("sub").find("is a folder"), std::string::npos);
}

/// What was a file when its name was resolved may be a link or a pipe when it is opened.
TEST_F(NamedFiles, WhatIsPutThereMeanwhileIsNotFollowed) {
  fs::create_symlink("../out/secret", path("in/link"));
  fs::create_directory_symlink("../out", path("in/folder"));
  ASSERT_EQ(mkfifo(path("in/pipe").c_str(), 0600), 0);
  EXPECT_EQ(system::openInside(path("in"), "link"), -1);
  EXPECT_EQ(system::openInside(path("in"), "folder/secret"), -1);
  const int file = system::openInside(path("in"), "sub/b");
  ASSERT_GE(file, 0);
  EXPECT_EQ(system::sizeOfRegular(file), 8u);
  system::close(file);
  const int pipe = system::openInside(path("in"), "pipe");  // does not wait
  ASSERT_GE(pipe, 0);
  EXPECT_FALSE(system::sizeOfRegular(pipe));
  system::close(pipe);
}

/// Names are found in the folder that the process is in, too.
TEST_F(NamedFiles, TheFolderMayHaveNoName) {
  const fs::path before = fs::current_path();
  fs::current_path(path("in"));
  std::vector<uint8_t> bytes;
  const Result result = readerOf("")("sub/b", "", bytes);
  fs::current_path(before);
  EXPECT_TRUE(result.ok()) << result.message();
  EXPECT_EQ(bytes.size(), 8u);
}

}  // namespace
}  // namespace mcc::gltf::test
#endif
