// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// What a person sees of `convert`: some eight lines about the file, tables only when asked for.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

#include "cli/run_tool.h"
#include "gltf/round_trip.h"

namespace mcc::gltf::test {
namespace {

namespace fs = std::filesystem;
using mcc::test::contentOf;
using mcc::test::samplePath;
using Outcome = mcc::test::ToolResult;

class ConvertOutput : public testing::Test {
 protected:
  void SetUp() override {
#ifndef MCC_TOOL_GLTF_MCC
    GTEST_SKIP() << "the tool is not part of this build";
#endif
  }

  Outcome run(const std::string& arguments) const {
    return mcc::test::runTool(scratch_, arguments);
  }

  void store(const std::string& name, const std::vector<uint8_t>& bytes) const {
    std::ofstream(folder_ / name, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
  }

  static size_t linesOf(const std::string& text) {
    return static_cast<size_t>(std::count(text.begin(), text.end(), '\n'));
  }

  /// Returns the line that begins with this word, without its indentation.
  static std::string lineOf(const std::string& text, const std::string& word) {
    const size_t begin = text.find("\n  " + word + " ");
    return begin == std::string::npos
               ? ""
               : text.substr(begin + 3, text.find('\n', begin + 1) - begin - 3);
  }

  const mcc::test::ScratchFolder scratch_;
  const fs::path folder_ = scratch_.path();
};

/// The conversion, Draco and the measurement of whole files share the bytes of the input, also when
/// the output replaces it.
TEST_F(ConvertOutput, InputIsHeldOnce) {
#ifdef MCC_IS_SANITIZED
  if (MCC_IS_SANITIZED) GTEST_SKIP() << "the sanitizer's memory counts as well";
#endif
  constexpr uint32_t kMebibytes = 160;
  constexpr uint32_t kBytes = kMebibytes << 20;
  Builder builder;
  builder.addMesh({Sheet(12).addTo(builder)});
  builder.json["buffers"] = {{{"byteLength", kBytes}}};
  std::vector<uint8_t> file = fileOf(builder);
  const size_t bin_at = file.size() - (builder.bin.size() + 3) / 4 * 4;
  const uint32_t file_bytes = static_cast<uint32_t>(bin_at) + kBytes;
  std::memcpy(&file[8], &file_bytes, 4);
  std::memcpy(&file[bin_at - 8], &kBytes, 4);
  store("large.glb", file);
  fs::resize_file(folder_ / "large.glb", file_bytes);
  EXPECT_LT(mcc::test::memoryOf(scratch_, {"convert", "large.glb", "out.glb"}), 1.5 * kMebibytes);
  const Outcome result = run("convert --in-place -j 2 large.glb large.glb");
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(contentOf(folder_ / "large.glb"), contentOf(folder_ / "out.glb"));
#if defined(MCC_HAS_FOREIGN)
  EXPECT_NE(lineOf(result.out, "Draco").find("times our"), std::string::npos) << result.out;
#endif
}

TEST_F(ConvertOutput, IsAboutTheFileAndNotAboutTheCodec) {
  const Outcome result = run("convert " + samplePath("genus3.glb") + " out.glb");
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_LE(linesOf(result.out), 8u) << result.out;
  EXPECT_NE(lineOf(result.out, "geometry").find("triangles"), std::string::npos) << result.out;
  EXPECT_NE(lineOf(result.out, "file").find("157,732 ->   7,600 bytes (4.8 %)"), std::string::npos)
      << result.out;
  EXPECT_NE(lineOf(result.out, "errors").find("positions 0.0"), std::string::npos) << result.out;
  EXPECT_NE(lineOf(result.out, "errors").find(" degrees"), std::string::npos) << result.out;
  EXPECT_NE(lineOf(result.out, "check"), "") << result.out;
  for (const char* word : {"stream", "bits", "payload", "header", "positions)"}) {
    EXPECT_EQ(result.out.find(word), std::string::npos) << word << " in " << result.out;
  }
#if defined(MCC_HAS_FOREIGN)
  EXPECT_NE(lineOf(result.out, "Draco").find("times our"), std::string::npos) << result.out;
#endif
}

TEST_F(ConvertOutput, TablesAreThereWithV) {
  const Outcome result = run("convert -v " + samplePath("torus.glb") + " out.glb");
  ASSERT_EQ(result.status, 0) << result.err;
  for (const char* word : {"stream", "bits/vertex", "/meshes/0/primitives/0", "whole file"}) {
    EXPECT_NE(result.out.find(word), std::string::npos) << word << " in " << result.out;
  }
}

/// A picture that dwarfs the mesh hides nothing: what became smaller has a line of its own.
TEST_F(ConvertOutput, ImagesAndAnimationsHaveLines) {
  Builder builder;
  builder.addMesh({Sheet(30).addTo(builder)});
  const uint32_t image = builder.addView(std::vector<uint8_t>(500000, 9));
  builder.json["images"] = {{{"bufferView", image}, {"mimeType", "image/png"}}};
  const uint32_t times = builder.addFloats({0, 1}, 1);
  builder.json["animations"].push_back(
      {{"samplers", {{{"input", times}, {"output", builder.addFloats({0, 0, 0, 1, 1, 1}, 3)}}}},
       {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "scale"}}}}}}});
  store("in.glb", builder.toGlb());
  const Outcome result = run("convert in.glb out.glb");
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_NE(lineOf(result.out, "images").find("500,000 -> 500,000 bytes, 1 image stays as it is"),
            std::string::npos)
      << result.out;
  EXPECT_NE(lineOf(result.out, "animations").find("1 animation stays as it is"), std::string::npos)
      << result.out;
  EXPECT_NE(lineOf(result.out, "geometry").find("%"), std::string::npos) << result.out;
}

TEST_F(ConvertOutput, LosslessSaysThatNothingIsLost) {
  const Outcome result = run("convert --lossless " + samplePath("torus.glb") + " out.glb");
  EXPECT_NE(lineOf(result.out, "errors").find("none: every number keeps every bit"),
            std::string::npos)
      << result.out;
}

/// Draco cannot code the triangles alone, so there is nothing like to compare with.
TEST_F(ConvertOutput, IndicesAloneAreNotComparedWithWholeMeshes) {
  const Outcome result = run("convert --indices-only " + samplePath("torus.glb") + " out.glb");
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(lineOf(result.out, "Draco"), "") << result.out;
}

TEST_F(ConvertOutput, LosslessExcludesBits) {
  for (const char* name : {"position", "normal", "texcoord", "color", "tangent", "weight"}) {
    const Outcome result =
        run("convert --lossless --" + std::string(name) + "-bits 8 in.glb out.glb");
    EXPECT_EQ(result.status, 2) << name;
    EXPECT_NE(result.err.find("--lossless"), std::string::npos) << result.err;
  }
}

TEST_F(ConvertOutput, MorphTargetsAreComparedLikeWithLike) {
  MCC_REQUIRE_COMPARISON();
  const Outcome result = run("convert " + samplePath("koi.glb") + " out.glb");
  EXPECT_NE(lineOf(result.out, "errors").find("of morph targets 0.0"), std::string::npos)
      << result.out;
  const std::string draco = lineOf(result.out, "Draco");
  EXPECT_NE(draco.find("such as morph targets"), std::string::npos) << result.out;
  // The tables count the same bytes.
  const Json report =
      Json::parse(run("convert " + samplePath("koi.glb") + " o.glb --format json").out);
  const Json& codecs = report["comparison"]["codecs"];
  const std::string best = report["comparison"]["best"];
  const std::string bytes = std::to_string(codecs[best]["bytes"].get<uint64_t>());
  std::string digits = draco;
  std::erase(digits, ',');
  EXPECT_NE(digits.find(bytes + " bytes"), std::string::npos) << draco << bytes;
}

/// A file that does not shrink says so in its first line, and then why.
TEST_F(ConvertOutput, CopyHasItsReason) {
  Builder builder;
  builder.addMesh({Sheet(1).addTo(builder), Sheet(1).addTo(builder), Sheet(1).addTo(builder)});
  store("in.glb", builder.toGlb());
  const Outcome result = run("convert in.glb out.glb");
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_NE(result.out.find("in.glb -> out.glb: copied, "), std::string::npos) << result.out;
  EXPECT_NE(result.out.find("(and 2 more like this)"), std::string::npos) << result.out;
  EXPECT_LE(linesOf(result.out), 4u) << result.out;
  EXPECT_TRUE(contentOf(folder_ / "in.glb") == contentOf(folder_ / "out.glb"));
}

TEST_F(ConvertOutput, NotesOfOneKindShareALine) {
  Builder builder;
  std::vector<Json> primitives;
  for (uint32_t i = 0; i < 20; ++i) {
    Sheet sheet(20);
    sheet.positions[3 * i] = std::numeric_limits<float>::quiet_NaN();
    primitives.push_back(sheet.addTo(builder));
  }
  builder.addMesh(primitives);
  store("in.glb", builder.toGlb());
  const Outcome result = run("convert in.glb out.glb");
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_NE(result.out.find("(and 19 more like this)"), std::string::npos) << result.out;
  const Outcome all = run("convert -v in.glb out.glb");
  EXPECT_EQ(all.out.find("more like this"), std::string::npos) << all.out;
}

TEST_F(ConvertOutput, SourceIsNotReplacedWithoutAWord) {
  fs::copy_file(MCC_SAMPLES_DIR "/torus.glb", folder_ / "a.glb");
  fs::create_symlink("a.glb", folder_ / "link.glb");
  const std::string before = contentOf(folder_ / "a.glb");
  for (const char* command : {"convert a.glb a.glb", "convert a.glb ./a.glb",
                              "convert link.glb a.glb", "decode a.glb a.glb"}) {
    const Outcome result = run(command);
    EXPECT_EQ(result.status, 2) << command;
    EXPECT_NE(result.err.find("--in-place"), std::string::npos) << result.err;
    EXPECT_TRUE(contentOf(folder_ / "a.glb") == before) << command;
  }
  EXPECT_EQ(run("convert --in-place a.glb a.glb").status, 0);
  const std::string compressed = contentOf(folder_ / "a.glb");
  EXPECT_LT(compressed.size(), before.size());
  EXPECT_EQ(run("decode --in-place a.glb a.glb").status, 0);
  EXPECT_GT(contentOf(folder_ / "a.glb").size(), compressed.size());
}

/// A batch says about each file what `convert` says about one.
TEST_F(ConvertOutput, BatchShowsNotes) {
  Builder builder;
  Sheet sheet(20);
  sheet.positions[7] = std::numeric_limits<float>::infinity();
  builder.addMesh({sheet.addTo(builder)});
  store("odd.glb", builder.toGlb());
  fs::copy_file(MCC_SAMPLES_DIR "/torus.glb", folder_ / "torus.glb");
  const Outcome result = run("convert -o d/ odd.glb torus.glb");
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_NE(result.out.find("\n  note: /meshes/0"), std::string::npos) << result.out;
  EXPECT_NE(result.out.find("1 file has notes"), std::string::npos) << result.out;
  const Json json = Json::parse(run("convert -o d/ --force odd.glb torus.glb --format json").out);
  EXPECT_EQ(json["files"][0]["notes"].size(), 1u);
  EXPECT_FALSE(json["files"][1].contains("notes"));
}

/// A texture that is missing has a note, in a batch as in a single conversion.
TEST_F(ConvertOutput, BatchShowsMissingTextures) {
  Builder builder;
  builder.addMesh({Sheet(20).addTo(builder)});
  builder.json["images"] = {{{"uri", "wood.jpg"}}};
  store("in.glb", builder.toGlb());
  ASSERT_EQ(run("convert in.glb in.gltf").status, 0);
  fs::create_directory(folder_ / "one");
  const Outcome one = run("convert in.gltf one/in.gltf");
  const Outcome batch = run("convert -o many/ in.gltf in.glb");
  EXPECT_EQ(one.status, batch.status);
  EXPECT_NE(one.out.find("wood.jpg"), std::string::npos) << one.out;
  EXPECT_NE(batch.out.find("wood.jpg"), std::string::npos) << batch.out << batch.err;
}

/// So it is where the image would move into a GLB, which goes on naming it.
TEST_F(ConvertOutput, AGlbNamesAMissingTexture) {
  Builder builder;
  builder.addMesh({Sheet(20).addTo(builder)});
  builder.json["images"] = {{{"uri", "wood.jpg"}}, {{"uri", "wood.jpg"}}};
  store("in.glb", builder.toGlb());
  ASSERT_EQ(run("convert in.glb in.gltf").status, 0);
  for (const char* command : {"convert", "decode"}) {
    const Outcome result = run(std::string(command) + " in.gltf out.glb");
    ASSERT_EQ(result.status, 0) << result.err;
    EXPECT_NE(result.out.find("\"wood.jpg\": there is no such file; it stays a separate file"),
              std::string::npos)
        << result.out;
    EXPECT_NE(run("inspect out.glb --format json").status, 1);
    EXPECT_NE(contentOf(folder_ / "out.glb").find("\"uri\":\"wood.jpg\""), std::string::npos);
  }
}

/// An image that stays a separate file counts neither before nor after.
TEST_F(ConvertOutput, SumsAreWithoutImagesOfUnknownType) {
  Builder builder;
  builder.addMesh({Sheet(20).addTo(builder)});
  builder.json["images"] = {{{"uri", "odd.png"}}};
  store("in.glb", builder.toGlb());
  ASSERT_EQ(run("convert in.glb in.gltf --lossless").status, 0);
  ASSERT_EQ(run("decode in.gltf plain.gltf").status, 0);
  store("odd.png", std::vector<uint8_t>(5000, 'x'));
  const Outcome result = run("convert plain.gltf out.glb --report r.json");
  ASSERT_EQ(result.status, 0) << result.err;
  const Json report = Json::parse(contentOf(folder_ / "r.json"));
  EXPECT_EQ(report["files"]["input"]["bytes"], report["input_bytes"]);
  EXPECT_EQ(report["files"]["output"]["bytes"], report["output_bytes"]);
}

/// Rows of attributes that are coded in several ways say which primitives they are about.
TEST_F(ConvertOutput, AttributesNameTheirPrimitives) {
  const std::string koi = samplePath("koi.glb");
  const Outcome result = run("convert " + koi + " out.glb -v --grid primitive");
  ASSERT_EQ(result.status, 0) << result.err;
  const auto endOf = [&](const std::string& name, size_t from) {
    const size_t row = result.out.find("\n" + name, from);
    return result.out.find('\n', row + 1);
  };
  EXPECT_TRUE(result.out.substr(0, endOf("POSITION", 0)).ends_with(" all")) << result.out;
  // The second primitive is still.
  const size_t first = endOf("target 0 POSITION", 0);
  EXPECT_TRUE(result.out.substr(0, first).ends_with(" 0/0")) << result.out;
  EXPECT_TRUE(result.out.substr(0, endOf("target 0 POSITION", first)).ends_with(" 0/1"));
  const Outcome csv = run("convert " + koi + " out.glb --format csv");
  EXPECT_EQ(csv.out.find("mesh/primitive"), std::string::npos) << csv.out;
}

}  // namespace
}  // namespace mcc::gltf::test
