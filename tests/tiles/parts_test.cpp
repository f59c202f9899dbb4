// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Tilesets that several machines make in parts, and runs that must not meet.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>

#include <atomic>
#include <optional>
#include <set>
#include <thread>

#include "host/work_lock.h"
#include "tiles/part.h"
#include "tiles/part_record.h"
#include "tiles/tiles_fixture.h"

namespace mcc::test {
namespace {

namespace fs = std::filesystem;

TEST(Part, EveryNameIsInExactlyOne) {
  std::set<uint32_t> used;
  for (int name = 0; name < 1000; ++name) {
    uint32_t count = 0;
    for (uint32_t number = 1; number <= 7; ++number) {
      const bool has = tiles::Part{number, 7}.has(std::to_string(name));
      count += has ? 1 : 0;
      if (has) used.insert(number);
    }
    EXPECT_EQ(count, 1u);
    EXPECT_TRUE(tiles::Part().has(std::to_string(name)));
  }
  EXPECT_EQ(used.size(), 7u);
}

class TileParts : public TilesTest {
 protected:
  void SetUp() override {
    TilesTest::SetUp();
    if (IsSkipped()) return;
    // The finest tile of a level decides about the grid of all parts, whichever part it is in.
    Json tileset = Json::parse(contentOf(path("in/tileset.json")));
    double error = 16;
    for (Json& tile : tileset["root"]["children"]) tile["geometricError"] = error /= 2;
    storeText(path("in/tileset.json"), tileset.dump());
    ASSERT_EQ(run("tiles in/tileset.json out").status, 0);
    whole_ = filesOf("out");
  }

  Files whole_;
};

TEST_F(TileParts, InOneFolderTheyAreTheWhole) {
  for (const char* part : {"2/3", "1/3", "3/3"}) {
    const ToolResult result = run(std::string("tiles in/tileset.json parts --part ") + part);
    ASSERT_EQ(result.status, 0) << result.err;
  }
  EXPECT_TRUE(filesOf("parts") == whole_);
  // A run without parts finds everything made.
  const ToolResult again = run("tiles in/tileset.json parts --format json");
  ASSERT_EQ(again.status, 0) << again.err;
  const Json report = Json::parse(again.out);
  EXPECT_EQ(report["files"].size(), 27u);
  for (const Json& file : report["files"]) EXPECT_TRUE(file["up_to_date"]) << file;
}

TEST_F(TileParts, FoldersAreMergedByCopying) {
  Files merged;
  uint64_t file_count = 0;
  for (int number = 1; number <= 4; ++number) {
    const std::string folder = "part" + std::to_string(number);
    const ToolResult result = run("tiles in/tileset.json " + folder + " --part " +
                                  std::to_string(number) + "/4 --report report.json");
    ASSERT_EQ(result.status, 0) << result.err;
    const Files made = filesOf(folder);
    EXPECT_LT(made.size(), whole_.size());
    file_count += made.size();
    merged.insert(made.begin(), made.end());
  }
  EXPECT_EQ(file_count, whole_.size()) << "no file is made twice";
  EXPECT_TRUE(merged == whole_);
}

/// One worker is killed, again and again; its part is made by somebody else in the end.
TEST_F(TileParts, AWorkerMayDie) {
  for (int delay_ms = 2; delay_ms < 60; delay_ms += 7) {
    const pid_t other = start({"tiles", "in/tileset.json", "parts", "--part", "1/2"});
    const pid_t child = start({"tiles", "in/tileset.json", "parts", "--part", "2/2"});
    std::this_thread::sleep_for(std::chrono::milliseconds(delay_ms));
    kill(child, SIGKILL);
    int code = 0;
    waitpid(child, &code, 0);
    waitpid(other, &code, 0);
    EXPECT_TRUE(WIFEXITED(code) && WEXITSTATUS(code) == 0) << "the other part goes on";
    for (const auto& [name, content] : filesOf("parts")) {
      if (name.find(".tmp-") != std::string::npos) continue;
      EXPECT_TRUE(whole_.contains(name) && whole_.at(name) == content) << name;
    }
  }
  ASSERT_EQ(run("tiles in/tileset.json parts --part 2/2").status, 0);
  EXPECT_TRUE(filesOf("parts") == whole_);
}

/// GNU Parallel as in docs/cli.md, with one job killed by a time limit of its first try.
TEST_F(TileParts, WithParallel) {
  if (runCommand(folder_, "command -v parallel").status != 0) GTEST_SKIP() << "no GNU Parallel";
  const std::string job =
      "sh -c 'if [ {} = 2 ] && [ ! -e tried ]; then touch tried; kill -9 $$; "
      "fi; exec \"" MCC_TOOL_GLTF_MCC "\" tiles -q in/tileset.json parts --part {}/3'";
  const ToolResult result = runCommand(
      folder_, "seq 3 | parallel -j 2 --retries 2 \"" + [&] {
        std::string quoted;
        for (const char c : job) {
          if (c == '"' || c == '$') quoted += '\\';
          quoted += c;
        }
        return quoted;
      }() + "\"");
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_TRUE(fs::exists(path("tried")));
  EXPECT_TRUE(filesOf("parts") == whole_);
}

TEST_F(TileParts, WrongUse) {
  for (const char* part : {"0/3", "4/3", "1", "1/", "/3", "1/3x", "-1/3", "1/0", "1/9999999"}) {
    const ToolResult result = run(std::string("tiles in/tileset.json none --part ") + part);
    EXPECT_EQ(result.status, 2) << part;
    EXPECT_NE(result.err.find("--part"), std::string::npos) << result.err;
  }
  EXPECT_FALSE(fs::exists(path("none")));
}

/// The test holds the lock that a run of a part would hold.
TEST_F(TileParts, TwoRunsDoNotMeet) {
  ASSERT_EQ(run("tiles in/tileset.json shared --part 1/2").status, 0);
  const Files part = filesOf("shared");
  std::optional<gltf::WorkLock> lock(std::in_place);
  ASSERT_TRUE(lock->take(path("shared/.gltf-mcc-tiles.1-of-2.jsonl")));
  for (const char* arguments : {"--part 1/2", "", "--part 3/5"}) {
    const ToolResult result = run(std::string("tiles in/tileset.json shared ") + arguments);
    EXPECT_EQ(result.status, 1) << arguments;
    EXPECT_NE(result.err.find("another run is writing to this folder"), std::string::npos)
        << arguments << result.err;
    EXPECT_TRUE(filesOf("shared") == part);
  }
  EXPECT_EQ(run("tiles in/tileset.json shared --part 2/2").status, 0);
  EXPECT_TRUE(filesOf("shared") == whole_);
  // A run that waits goes on as soon as the other one is gone.
  const pid_t waiting = start({"tiles", "in/tileset.json", "shared", "--wait"});
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  int code = 0;
  EXPECT_EQ(waitpid(waiting, &code, WNOHANG), 0) << "it does not wait";
  lock.reset();
  waitpid(waiting, &code, 0);
  EXPECT_TRUE(WIFEXITED(code) && WEXITSTATUS(code) == 0);
  EXPECT_TRUE(filesOf("shared") == whole_);
}

/// Runs that overlap and begin together take turns: they wait, but not for each other.
TEST_F(TileParts, RunsThatWaitAllEnd) {
  std::vector<pid_t> runs;
  for (const char* part : {"1/1", "1/2", "2/2", "1/3", "2/3"}) {
    runs.push_back(start({"tiles", "in/tileset.json", "together", "--wait", "--part", part}));
  }
  for (const pid_t run : runs) {
    int code = 0;
    waitpid(run, &code, 0);
    EXPECT_TRUE(WIFEXITED(code) && WEXITSTATUS(code) == 0);
  }
  EXPECT_TRUE(filesOf("together") == whole_);
}

/// If each of two let go because it saw the other, they could go on like that for ever.
TEST_F(TileParts, OfTwoRunsThatBeginTogetherOneWorks) {
  constexpr int kRounds = 300;
  for (int round = 0; round < kRounds; ++round) {
    const fs::path output = path("o" + std::to_string(round));
    fs::create_directory(output);
    tiles::PartRecord records[] = {{path("in"), output, {1, 2}}, {path("in"), output, {2, 3}}};
    std::atomic<int> ready = 0;
    bool is_open[2] = {};
    const auto open = [&](int i) {
      for (++ready; ready != 2;) {
      }
      is_open[i] = records[i].open(false).ok();
    };
    std::thread other(open, 1);
    open(0);
    other.join();
    EXPECT_EQ(is_open[0] + is_open[1], 1) << round;
    // The one that works holds its own lock alone, so that parts apart from it may begin.
    gltf::WorkLock of_loser;
    const char* names[] = {".gltf-mcc-tiles.1-of-2.jsonl", ".gltf-mcc-tiles.2-of-3.jsonl"};
    EXPECT_TRUE(of_loser.take(output / names[is_open[0] ? 1 : 0]));
  }
}

/// A million tiles in one file, of which few have contents, and 1.4 million implicit ones.
TEST_F(TileParts, LargeTreesTakeLittleMemory) {
#ifdef MCC_IS_SANITIZED
  if (MCC_IS_SANITIZED) GTEST_SKIP() << "the sanitizer's memory counts as well";
#endif
  constexpr int kTiles = 1000000;
  {
    fs::create_directories(path("explicit"));
    std::ofstream json(path("explicit/tileset.json"), std::ios::binary);
    json
        << "{\"asset\":{\"version\":\"1.1\"},\"geometricError\":64,\"root\":{\"geometricError\":32,"
           "\"boundingVolume\":{\"sphere\":[0,0,0,900]},\"children\":[";
    for (int i = 0; i < kTiles; ++i) {
      json << (i == 0 ? "" : ",")
           << "{\"boundingVolume\":{\"box\":[0.5,0.25,0.125,1,0,0,0,1,0,0,0,1]},"
              "\"geometricError\":0,\"content\":{\"uri\":\""
           << i % 20 << ".glb\"}}";
    }
    json << "]}}\n";
    for (int i = 0; i < 20; ++i) {
      storeBytes(path("explicit") / (std::to_string(i) + ".glb"), makePatchGlb(2, 1, 1));
    }
  }
  EXPECT_LT(memoryOf(folder_, {"tiles", "explicit/tileset.json", "large", "--report", "r.json"}),
            500);
  EXPECT_EQ(Json::parse(contentOf(path("r.json")))["levels"][1]["tiles"], kTiles);
}

}  // namespace
}  // namespace mcc::test
