// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "gltf/files/destination.h"

#include <gtest/gtest.h>
#include <atomic>
#include <fstream>
#include <map>
#include <thread>

#include "host/work_lock.h"
#include "support/gltf_builder.h"
#include "support/scratch_folder.h"
#if !defined(_WIN32)
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>
#endif

namespace mcc::gltf::test {
namespace {

namespace fs = std::filesystem;

std::vector<uint8_t> bytesOf(const std::string& text) { return {text.begin(), text.end()}; }

/// A buffer or fallback of a.gltf.
SideFile madeOf(SideFile::Kind kind, const std::string& content) {
  return {kind, nameOfMade({true, "a.gltf", "a"}, kind, bytesOf(content)), bytesOf(content)};
}

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
    package.beside = {madeOf(SideFile::Kind::kFallback, "fallback " + content),
                      {SideFile::Kind::kCopy, "./new/folder/a.png", bytesOf("image " + content)},
                      madeOf(SideFile::Kind::kBuffer, "buffer " + content)};
    package.main = bytesOf(R"({"buffers":[{"uri":")" + package.beside[2].path + R"("},{"uri":")" +
                           package.beside[0].path + R"("}],"extras":")" + content + "\"}");
    return package;
  }

  mcc::test::ScratchFolder folder_;
};

TEST(NamesOfMade, BelongToOneDocument) {
  const Container a{true, "a.gltf", "a"};
  const auto name = [](const Container& container, const std::string& bytes) {
    return nameOfMade(container, SideFile::Kind::kBuffer, bytesOf(bytes));
  };
  EXPECT_EQ(name(a, "bytes"), name(a, "bytes"));
  EXPECT_NE(name(a, "bytes"), name(a, "byteS"));
  EXPECT_NE(name(a, "bytes"), name({false, "a.glb", "a"}, "bytes"));
  EXPECT_EQ(name(a, ""), "a.2d2395995a98d3a7.bin");
  for (const std::string& made : {name(a, "x"), nameOfMade(a, SideFile::Kind::kFallback, {}),
                                  std::string("a.bin"), std::string("a.fallback.bin")}) {
    EXPECT_TRUE(isNameOfMade(a, made)) << made;
  }
  for (const char* other :
       {"", "a", "bin", "a.", "b.bin", "ab.bin", "a.0123.bin", "a.png", "a.0123456789ABCDEF.bin",
        "a.0123456789abcdefbin", "a.0123456789abcdef0.bin", "a.0123456789abcdef", "a.x.bin"}) {
    EXPECT_FALSE(isNameOfMade(a, other)) << other;
  }
}

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
    const SideFile expected = package(content).beside[2];
    ASSERT_TRUE(destination.reader()(expected.path, "", buffer).ok());
    EXPECT_EQ(buffer, expected.bytes);
    EXPECT_FALSE(destination.reader()("b.bin", "/buffers/0", buffer).ok());
    ASSERT_EQ(destination.commit().message(), "");
    FilesInUse files;
    destination.listFiles(files);
    EXPECT_EQ(files.output, (std::vector<fs::path>{path("a.gltf"), path(expected.path)}));
    EXPECT_EQ(files.other_output, std::vector<fs::path>{path(package(content).beside[0].path)});
  }
  const auto files = everything();
  EXPECT_EQ(files.size(), 6u);
  EXPECT_EQ(files.at(package("2").beside[2].path), "buffer 2");
  EXPECT_EQ(files.at(package("2").beside[0].path), "fallback 2");
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
    EXPECT_EQ(files.at(package(content).beside[2].path), "buffer " + content);
    fs::remove_all(path("new"));
  }
}

/// A folder appears where the main file should go: its rename, the last one, fails.
TEST_F(DestinationTest, TakesEverythingBack) {
  for (const bool with_older : {false, true}) {
    if (with_older) {
      const std::vector<uint8_t> older = package("").main;
      store("a.gltf", std::string(older.begin(), older.end()));
      store(package("").beside[2].path, "older buffer");
      store(package("").beside[0].path, "older fallback");
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
      EXPECT_EQ(after.at(package("").beside[2].path), "older buffer");
      EXPECT_EQ(after.at(package("").beside[0].path), "older fallback");
    }
    fs::remove_all(path("a.gltf"));
  }
}

TEST_F(DestinationTest, AFileThatAppearsIsNotReplaced) {
  Destination destination(path("a.gltf"));
  ASSERT_TRUE(destination.check(true).ok());
  ASSERT_TRUE(destination.write(package("")).ok());
  store("new/folder/a.png", "precious");
  const Result result = destination.commit();
  EXPECT_NE(result.message().find("a.png: another file appeared there"), std::string::npos)
      << result.message();
  EXPECT_EQ(everything().at("new/folder/a.png"), "precious");
  EXPECT_EQ(everything().count("a.gltf"), 0u);
  for (const SideFile& side : package("").beside) {
    if (side.kind == SideFile::Kind::kCopy) continue;
    EXPECT_EQ(everything().count(side.path), 0u);
  }
}

/// A .gltf with its buffer, each of which says who wrote it.
Package pairOf(const std::string& writer) {
  Package package;
  package.beside = {madeOf(SideFile::Kind::kBuffer, writer)};
  package.main = bytesOf(R"({"buffers":[{"uri":")" + package.beside[0].path + "\"}]}");
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
    int count = 0;
    for (int i = 0; i < kWriters; ++i) {
      const std::string writer = "writer " + std::to_string(i);
      const Package pair = pairOf(writer);
      const auto buffer = files.find(pair.beside[0].path);
      if (buffer == files.end()) continue;
      ++count;
      EXPECT_EQ(buffer->second, writer);
      EXPECT_EQ(bytesOf(files.at("a.gltf")), pair.main);
    }
    ASSERT_EQ(count, 1) << round;
    if (round % 3 == 0) {
      for (const auto& [name, content] : files) fs::remove(path(name));
    }
  }
}

/// Where the folder cannot be locked, old buffers stay, and every .gltf has its own.
TEST_F(DestinationTest, ALockedFolderCostsNoBuffer) {
  const auto write = [&](const std::string& writer) {
    Destination destination(path("a.gltf"));
    Result result = destination.check(false);
    if (result.ok()) result = destination.write(pairOf(writer));
    return result.ok() ? destination.commit() : result;
  };
  ASSERT_EQ(write("first").message(), "");
  {
    WorkLock lock;
    ASSERT_TRUE(lock.take(folder_.path()));
    // On Windows a thread may take a lock again that it holds.
    std::thread([&] { EXPECT_EQ(write("second").message(), ""); }).join();
  }
  EXPECT_EQ(everything().size(), 3u);
  EXPECT_EQ(everything().at(pairOf("second").beside[0].path), "second");
  ASSERT_EQ(write("third").message(), "");
  EXPECT_EQ(everything().count(pairOf("first").beside[0].path), 1u);
  EXPECT_EQ(everything().count(pairOf("second").beside[0].path), 0u);
  EXPECT_EQ(everything().at(pairOf("third").beside[0].path), "third");
}

/// Both copies go to one file, so equal ones are written once.
TEST_F(DestinationTest, OneFileUnderTwoNames) {
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
    const Package older = pairOf("older");
    const std::string old_buffer = older.beside[0].path;
    store("a.gltf", std::string(older.main.begin(), older.main.end()));
    store(old_buffer, "older");
    ASSERT_EQ(::chmod(path("a.gltf").c_str(), 0644), 0);
    ASSERT_EQ(::chmod(path(old_buffer).c_str(), mode), 0);
    Destination destination(path("a.gltf"));
    ASSERT_EQ(destination.check(false).message(), "");
    ASSERT_EQ(destination.write(pairOf("new")).message(), "");
    ASSERT_EQ(destination.commit().message(), "");
    const std::string new_buffer = pairOf("new").beside[0].path;
    EXPECT_EQ(everything().at(new_buffer), "new");
    EXPECT_EQ(everything().count(old_buffer), 0u);
    EXPECT_EQ(modeOf(path("a.gltf")), 0644);
    EXPECT_EQ(modeOf(path(new_buffer)), mode);
    fs::remove(path(new_buffer));
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
