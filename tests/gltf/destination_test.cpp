// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "gltf/destination.h"

#include <gtest/gtest.h>

#include <fstream>
#include <map>

#include "gltf/gltf_builder.h"
#include "support/scratch_folder.h"

namespace mcc::gltf::test {
namespace {

namespace fs = std::filesystem;

class DestinationTest : public testing::Test {
 protected:
  fs::path path(const std::string& name) const { return folder_.path() / name; }

  void store(const std::string& name, const std::string& content) const {
    fs::create_directories(path(name).parent_path());
    std::ofstream(path(name), std::ios::binary) << content;
  }

  /// All files, and folders as "name/", with their contents.
  std::map<std::string, std::string> everything() const {
    std::map<std::string, std::string> found;
    for (const auto& entry : fs::recursive_directory_iterator(folder_.path())) {
      const std::string name = entry.path().lexically_relative(folder_.path()).string();
      if (entry.is_directory()) {
        found[name + "/"];
        continue;
      }
      std::ifstream stream(entry.path(), std::ios::binary);
      found[name] = {std::istreambuf_iterator<char>(stream), {}};
    }
    return found;
  }

  /// A .gltf with its buffer, a fallback and an image in a folder of its own.
  static Package package(const std::string& content) {
    Package package;
    const auto bytes = [&](const std::string& text) {
      const std::string all = text + content;
      return std::vector<uint8_t>(all.begin(), all.end());
    };
    package.main = bytes(R"({"buffers":[{"uri":"a.bin"},{"uri":"a.fallback.bin"}],"extras":")");
    package.main.insert(package.main.end(), {'"', '}'});
    package.beside = {{SideFile::Kind::kFallback, "a.fallback.bin", bytes("fallback ")},
                      {SideFile::Kind::kCopy, "./new/folder/a.png", bytes("image ")},
                      {SideFile::Kind::kBuffer, "a.bin", bytes("buffer ")}};
    return package;
  }

  mcc::test::ScratchFolder folder_;
};

TEST_F(DestinationTest, WritesAllFiles) {
  for (const std::string content : {"1", "2"}) {
    // The second time the image belongs to nobody: the JSON does not name it.
    fs::remove_all(path("new"));
    Destination destination(path("a.gltf"));
    ASSERT_EQ(destination.check(true).message(), "");
    ASSERT_EQ(destination.write(package(content)).message(), "");
    std::vector<uint8_t> main;
    std::vector<uint8_t> buffer;
    ASSERT_TRUE(destination.readBack(main).ok());
    EXPECT_EQ(main, package(content).main);
    ASSERT_TRUE(destination.reader()("a.bin", "", buffer).ok());
    EXPECT_EQ(buffer, package(content).beside[2].bytes);
    EXPECT_FALSE(destination.reader()("b.bin", "/buffers/0", buffer).ok());
    ASSERT_EQ(destination.commit().message(), "");
    EXPECT_EQ(destination.files(), (std::vector<fs::path>{path("a.gltf"), path("a.bin")}));
  }
  const auto files = everything();
  EXPECT_EQ(files.size(), 6u);
  EXPECT_EQ(files.at("a.bin"), "buffer 2");
  EXPECT_EQ(files.at("a.fallback.bin"), "fallback 2");
  EXPECT_EQ(files.at("new/folder/a.png"), "image 2");
}

TEST_F(DestinationTest, LeavesNothingWithoutCommit) {
  {
    Destination destination(path("a.gltf"));
    ASSERT_TRUE(destination.check(true).ok());
    ASSERT_TRUE(destination.write(package("")).ok());
    EXPECT_GT(everything().size(), 4u);
  }
  EXPECT_TRUE(everything().empty());
}

/// What a program does that is ended in the middle of it.
TEST_F(DestinationTest, TemporariesAreKnown) {
  TemporaryFiles temporaries;
  {
    Destination destination(path("a.gltf"), &temporaries);
    ASSERT_TRUE(destination.check(true).ok());
    ASSERT_TRUE(destination.write(package("")).ok());
    EXPECT_GT(everything().size(), 4u);
    const TemporaryFiles::Lock held = temporaries.removeAll();
    EXPECT_TRUE(everything().empty());
  }
  for (const std::string content : {"1", "2"}) {
    Destination destination(path("a.gltf"), &temporaries);
    ASSERT_TRUE(destination.check(true).ok());
    ASSERT_TRUE(destination.write(package(content)).ok());
    ASSERT_EQ(destination.commit().message(), "");
    (void)temporaries.removeAll();  // what has its name stays; nothing else is left
    const auto files = everything();
    EXPECT_EQ(files.size(), 6u) << content;
    EXPECT_EQ(files.at("a.bin"), "buffer " + content);
    fs::remove_all(path("new"));
  }
}

/// A folder appears where the main file should go: its rename, the last one, fails.
TEST_F(DestinationTest, TakesEverythingBack) {
  for (const bool with_older : {false, true}) {
    if (with_older) {
      const std::vector<uint8_t> older = package("").main;
      store("a.gltf", std::string(older.begin(), older.end()));
      store("a.bin", "older buffer");
      store("a.fallback.bin", "older fallback");
    }
    {
      Destination destination(path("a.gltf"));
      ASSERT_EQ(destination.check(true).message(), "");
      ASSERT_EQ(destination.write(package("new")).message(), "");
      fs::remove(path("a.gltf"));
      store("a.gltf/in_the_way", "");
      EXPECT_NE(destination.commit().message().find("a.gltf: cannot be written"),
                std::string::npos);
    }
    const auto after = everything();
    EXPECT_EQ(after.size(), with_older ? 4u : 2u);
    if (with_older) {
      EXPECT_EQ(after.at("a.bin"), "older buffer");
      EXPECT_EQ(after.at("a.fallback.bin"), "older fallback");
    }
    fs::remove_all(path("a.gltf"));
  }
}

TEST_F(DestinationTest, AFileThatAppearsIsNotReplaced) {
  Destination destination(path("a.gltf"));
  ASSERT_TRUE(destination.check(true).ok());
  ASSERT_TRUE(destination.write(package("")).ok());
  store("a.bin", "precious");
  const Result result = destination.commit();
  EXPECT_NE(result.message().find("a.bin: another file appeared there"), std::string::npos)
      << result.message();
  EXPECT_EQ(everything().at("a.bin"), "precious");
  EXPECT_EQ(everything().count("a.gltf"), 0u);
  EXPECT_EQ(everything().count("a.fallback.bin"), 0u);
}

}  // namespace
}  // namespace mcc::gltf::test
