// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "gltf/files/destination.h"

#include <gtest/gtest.h>
#include <atomic>
#include <fstream>
#include <map>
#include <thread>

#include "gltf/gltf_builder.h"
#include "support/scratch_folder.h"
#if !defined(_WIN32)
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>
#endif

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

  /// Returns all files with their contents, and folders as "name/".
  std::map<std::string, std::string> everything() const {
    std::map<std::string, std::string> found;
    for (const auto& entry : fs::recursive_directory_iterator(folder_.path())) {
      const std::string name = entry.path().lexically_relative(folder_.path()).generic_string();
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
    // The second time nothing owns the image, because the JSON does not name it.
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

/// Does what a program does that a signal ends in the middle of its work.
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
    (void)temporaries.removeAll();  // finished files stay; nothing else is left
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

/// A .gltf with its buffer, each of which says who wrote it.
Package pairOf(const std::string& writer) {
  Package package;
  const std::string main = R"({"buffers":[{"uri":"a.bin"}],"extras":")" + writer + "\"}";
  package.main.assign(main.begin(), main.end());
  package.beside = {{SideFile::Kind::kBuffer, "a.bin", {writer.begin(), writer.end()}}};
  return package;
}

/// Both files belong to whoever wrote last. No writer reports success while only half of its pair
/// is there.
TEST_F(DestinationTest, APairIsAlwaysOneWriters) {
  constexpr int kRounds = 80;
  constexpr int kWriters = 3;
  for (int round = 0; round < kRounds; ++round) {
    std::atomic<int> ready{0};
    std::vector<std::string> messages(kWriters);
    std::vector<std::thread> threads;
    for (int i = 0; i < kWriters; ++i) {
      threads.emplace_back([&, i]() {
        Destination destination(path("a.gltf"));
        Result result = destination.check(false);
        if (result.ok()) result = destination.write(pairOf("writer " + std::to_string(i)));
        ++ready;
        while (ready < kWriters) std::this_thread::yield();
        if (result.ok()) result = destination.commit();
        messages[static_cast<size_t>(i)] = result.message();
      });
    }
    for (std::thread& thread : threads) thread.join();
    for (const std::string& message : messages) ASSERT_EQ(message, "") << round;
    const auto files = everything();
    ASSERT_EQ(files.size(), 2u) << round;
    ASSERT_NE(files.at("a.gltf").find('"' + files.at("a.bin") + '"'), std::string::npos)
        << round << ": " << files.at("a.gltf") << " beside " << files.at("a.bin");
    if (round % 3 == 0) {
      fs::remove(path("a.gltf"));
      fs::remove(path("a.bin"));
    }
  }
}

/// Where folders cannot be locked, a pair that another program has broken up is detected.
TEST_F(DestinationTest, ABrokenPairIsFoundOut) {
  Destination first(path("a.gltf"));
  ASSERT_TRUE(first.check(false).ok());
  ASSERT_TRUE(first.write(pairOf("first")).ok());
  ASSERT_EQ(first.commit().message(), "");
  EXPECT_EQ(first.checkTogether().message(), "");
  ASSERT_TRUE(writeFile(path("a.bin"), asBytes("second")).ok());
  EXPECT_NE(first.checkTogether().message().find("may not belong together"), std::string::npos);
  // A complete pair of another program is fine.
  ASSERT_TRUE(writeFile(path("a.gltf"), pairOf("second").main).ok());
  EXPECT_EQ(first.checkTogether().message(), "");
}

/// Both copies go to one file, so equal ones are written once.
TEST_F(DestinationTest, OneFileUnderTwoNames) {
  const auto bytesOf = [](const std::string& text) {
    return std::vector<uint8_t>(text.begin(), text.end());
  };
  const auto copies = [&](const std::string& second) {
    Package package;
    package.main = bytesOf("{}");
    package.beside = {{SideFile::Kind::kCopy, "t/a.png", bytesOf("image")},
                      {SideFile::Kind::kCopy, "./t//a.png", bytesOf(second)}};
    return package;
  };
  {
    Destination destination(path("a.gltf"));
    ASSERT_EQ(destination.check(false).message(), "");
    EXPECT_NE(destination.write(copies("another")).message().find("which is another file"),
              std::string::npos);
  }
  Destination destination(path("a.gltf"));
  ASSERT_EQ(destination.check(false).message(), "");
  ASSERT_EQ(destination.write(copies("image")).message(), "");
  std::vector<uint8_t> bytes;
  EXPECT_EQ(destination.reader()("t/../t/a.png", "", bytes).message(), "");
  EXPECT_EQ(bytes, bytesOf("image"));
  ASSERT_EQ(destination.commit().message(), "");
  EXPECT_EQ(everything().at("t/a.png"), "image");
}

#if !defined(_WIN32)

mode_t modeOf(const fs::path& file) {
  struct stat status = {};
  return ::stat(file.c_str(), &status) == 0 ? status.st_mode & 07777 : 0;
}

TEST_F(DestinationTest, PermissionsStay) {
  for (const mode_t mode : {0600U, 0640U, 0644U, 0666U, 0700U}) {
    store("a.gltf", R"({"buffers":[{"uri":"a.bin"}]})");
    store("a.bin", "older");
    ASSERT_EQ(::chmod(path("a.gltf").c_str(), mode), 0);
    ASSERT_EQ(::chmod(path("a.bin").c_str(), mode), 0);
    Destination destination(path("a.gltf"));
    ASSERT_EQ(destination.check(false).message(), "");
    ASSERT_EQ(destination.write(pairOf("new")).message(), "");
    ASSERT_EQ(destination.commit().message(), "");
    EXPECT_EQ(everything().at("a.bin"), "new");
    EXPECT_EQ(modeOf(path("a.gltf")), mode);
    EXPECT_EQ(modeOf(path("a.bin")), mode);
  }
}

TEST_F(DestinationTest, OwnersStay) {
  if (::geteuid() != 0) GTEST_SKIP() << "only root may give files away";
  store("a.glb", "older");
  ASSERT_EQ(::chown(path("a.glb").c_str(), 1234, 2345), 0);
  ASSERT_EQ(writeFile(path("a.glb"), asBytes("new")).message(), "");
  struct stat status = {};
  ASSERT_EQ(::stat(path("a.glb").c_str(), &status), 0);
  EXPECT_EQ(status.st_uid, 1234u);
  EXPECT_EQ(status.st_gid, 2345u);
}

TEST_F(DestinationTest, LinksStay) {
  fs::create_directory(path("elsewhere"));
  store("elsewhere/model.glb", "older");
  fs::create_symlink("elsewhere/model.glb", path("link.glb"));
  fs::create_symlink("link.glb", path("link2.glb"));
  fs::create_symlink("elsewhere/new.glb", path("dangling.glb"));
  ASSERT_EQ(writeFile(path("link2.glb"), asBytes("new")).message(), "");
  ASSERT_EQ(writeFile(path("dangling.glb"), asBytes("first")).message(), "");
  for (const char* name : {"link.glb", "link2.glb", "dangling.glb"}) {
    EXPECT_TRUE(fs::is_symlink(path(name))) << name;
  }
  EXPECT_EQ(everything().at("elsewhere/model.glb"), "new");
  EXPECT_EQ(everything().at("elsewhere/new.glb"), "first");
  EXPECT_EQ(everything().size(), 6u);  // nothing else
  fs::create_symlink("round.glb", path("round.glb"));
  EXPECT_NE(writeFile(path("round.glb"), asBytes("")).message(), "");
}

TEST_F(DestinationTest, StreamsAreWrittenTo) {
  ASSERT_EQ(::mkfifo(path("pipe").c_str(), 0600), 0);
  EXPECT_TRUE(isStream(path("pipe")));
  EXPECT_FALSE(isStream(path("none")));
  const int reader = ::open(path("pipe").c_str(), O_RDONLY | O_NONBLOCK);
  ASSERT_EQ(writeFile(path("pipe"), asBytes("through")).message(), "");
  char text[16] = {};
  EXPECT_EQ(::read(reader, text, sizeof text), 7);
  EXPECT_STREQ(text, "through");
  ::close(reader);
  EXPECT_TRUE(fs::is_fifo(path("pipe")));
  EXPECT_NE(Destination(path("pipe")).check(false).message().find("a device or a pipe"),
            std::string::npos);
  fs::remove(path("pipe"));
  // An open stream continues at its position.
  store("log", "begin ");
  const int log = ::open(path("log").c_str(), O_WRONLY | O_APPEND);
  fs::create_symlink("/dev/fd/" + std::to_string(log), path("stream"));
  ASSERT_EQ(writeFile(path("stream"), asBytes("end")).message(), "");
  ::close(log);
  EXPECT_EQ(everything().at("log"), "begin end");
  EXPECT_EQ(openStreamOf("/dev/stdout"), 1);
  EXPECT_EQ(openStreamOf("/dev/../dev/fd/12"), 12);
  EXPECT_EQ(openStreamOf("/dev/fd/x"), std::nullopt);
  EXPECT_EQ(openStreamOf("stdout"), std::nullopt);
}

TEST_F(DestinationTest, FilesAreKnownWhateverTheirNames) {
  store("a", "");
  fs::create_directory(path("d"));
  fs::create_symlink("..", path("d/up"));
  fs::create_symlink("a", path("link"));
  fs::create_hard_link(path("a"), path("hard"));
  for (const char* name : {"./a", "link", "hard", "d/../a", "d/up/a"}) {
    EXPECT_TRUE(isSameFile(path("a"), path(name))) << name;
  }
  EXPECT_TRUE(isSameFile(path("new"), path("d/up/new")));
  EXPECT_FALSE(isSameFile(path("new"), path("d/new")));
  EXPECT_FALSE(isSameFile(path("a"), path("d/a")));
  EXPECT_FALSE(isSameFile(path("none/a"), path("none/a")));  // neither can be written
  EXPECT_FALSE(isSameFile("/dev/null", "/dev/null"));
  // Open streams have keys, too.
  const int file = ::open(path("a").c_str(), O_RDONLY);
  EXPECT_EQ(keyOfStream(file), fileKey(path("a")));
  EXPECT_EQ(fileKey("/dev/fd/" + std::to_string(file)), fileKey(path("a")));
  ::close(file);
  int pipe[2] = {-1, -1};
  ASSERT_EQ(::pipe(pipe), 0);
  EXPECT_NE(keyOfStream(pipe[0]), "");
  for (const int end : pipe) ::close(end);
}

#endif

}  // namespace
}  // namespace mcc::gltf::test
