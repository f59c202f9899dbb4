// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "convert_summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "host/text.h"
#include "mcc/glb.h"
#include "notes.h"

namespace mcc::tool {
namespace {

using gltf::AttributeReport;
using gltf::Contents;
using gltf::ConvertReport;

std::string percentOf(uint64_t part, uint64_t whole) {
  if (whole == 0) return "";
  return fmt::format(" ({:.1f} %)", 100 * static_cast<double>(part) / static_cast<double>(whole));
}

/// The lines under the title: a name, and bytes before and after in columns.
class Lines {
 public:
  explicit Lines(uint64_t largest) : width_(grouped(largest).size()) {}

  void add(const std::string& name, const std::string& text) {
    if (!text.empty()) text_ += fmt::format("  {:<12}{}\n", name, text);
  }
  void addBytes(const std::string& name, uint64_t before, uint64_t after, const std::string& more) {
    if (before == 0 && after == 0) return;
    std::string line =
        fmt::format("{:>{}} -> {:>{}} bytes", grouped(before), width_, grouped(after), width_);
    if (before != after) line += percentOf(after, before);
    add(name, more.empty() ? line : line + ", " + more);
  }
  const std::string& text() const { return text_; }

 private:
  const size_t width_;
  std::string text_;
};

std::string geometryText(const ConvertReport& report) {
  uint64_t triangles = 0;
  uint64_t vertices = 0;
  for (const gltf::PayloadReport& payload : report.payloads) {
    triangles += payload.triangle_count;
    vertices += payload.wedge_count;
  }
  std::string text = counted(triangles, "triangle", "triangles") + " of " +
                     counted(vertices, "vertex", "vertices");
  const auto compressed =
      std::count_if(report.primitives.begin(), report.primitives.end(),
                    [](const gltf::PrimitiveReport& primitive) { return primitive.compressed; });
  if (static_cast<size_t>(compressed) == report.primitives.size()) return text;
  return text + fmt::format(" in {} of {}; -v says why the others stay as they are", compressed,
                            counted(report.primitives.size(), "primitive", "primitives"));
}

std::string imagesText(const Contents& contents) {
  if (contents.image_count == 0) return "";
  return counted(contents.image_count, "image stays as it is", "images stay as they are");
}

std::string animationsText(const Contents& contents) {
  if (contents.animation_count == 0) return "skins stay as they are";
  return counted(contents.animation_count, "animation stays as it is",
                 "animations stay as they are");
}

std::string brotliText(const Converted& converted) {
  const WholeSize* input = nullptr;
  const WholeSize* output = nullptr;
  for (const WholeSize& size : converted.sizes) {
    if (size.name == "input") input = &size;
    if (size.name == "output") output = &size;
  }
  if (input == nullptr || output == nullptr) return "";
  return fmt::format("after brotli {}: {} -> {}{}", kBrotliQuality, grouped(input->brotli_bytes),
                     grouped(output->brotli_bytes),
                     percentOf(output->brotli_bytes, input->brotli_bytes));
}

/// Returns a number with two digits that matter.
std::string shortNumber(double value) {
  constexpr double kSmallest = 0.0001;
  if (value > 0 && value < kSmallest) return fmt::format("below {}", kSmallest);
  return value >= 100 ? fmt::format("{:.0f}", value) : fmt::format("{:.2g}", value);
}

/// What people call an attribute, and what they can judge its errors by.
struct Measure {
  const char* prefix;  ///< of the attribute's name
  const char* name;
  double scale;
  const char* unit;
};

constexpr Measure kMeasures[] = {
    {"NORMAL", "normals", 1, ""},
    {"TANGENT", "tangents", 1, ""},
    {"TEXCOORD", "texture coordinates", 2048, " pixels of a 2,048 texture"},
    {"COLOR", "colours", 255, " of 255"},
    {"WEIGHTS", "skin weights", 1, ""},
    {"target ", "normals and other values of morph targets", 1, ""},
    {"", "other attributes", 1, ""},
};

bool isPosition(const AttributeReport& attribute) {
  return attribute.name == "POSITION" ||
         (attribute.name.starts_with("target ") && attribute.name.ends_with(" POSITION"));
}

/// Returns the largest error of positions, those of morph targets among them, as a share of the
/// longest side; or in units of the file where a distance was promised. Empty when all are exact.
std::string positionText(const ConvertReport& report) {
  double worst = -1;
  double distance = -1;
  for (const gltf::PayloadReport& payload : report.payloads) {
    double extent = 0;
    for (const AttributeReport& attribute : payload.attributes) {
      extent = std::max(extent, attribute.extent);
    }
    for (const AttributeReport& attribute : payload.attributes) {
      if (!isPosition(attribute) || attribute.bits == 0) continue;
      if (attribute.promised_distance > 0) {
        distance = std::max(distance, attribute.max_distance);
      } else {
        worst = std::max(worst, extent > 0 ? attribute.max_error / extent : 0);
      }
    }
  }
  if (distance >= 0) return fmt::format("positions {} units", shortNumber(distance));
  return worst < 0 ? ""
                   : fmt::format("positions {} % of the longest side", shortNumber(100 * worst));
}

const Measure& measureOf(const std::string& name) {
  return *std::find_if(std::begin(kMeasures), std::end(kMeasures),
                       [&](const Measure& measure) { return name.starts_with(measure.prefix); });
}

/// Returns "POSITION 12 bits: why", with "10 to 12 bits" where meshes differ.
std::string choiceText(const gltf::QualityChoice& choice) {
  std::string text = gltf::printable(choice.name);
  if (choice.exact_count != choice.attribute_count) {
    text += fmt::format(" {}", choice.fewest_bits);
    if (choice.fewest_bits != choice.most_bits) text += fmt::format(" to {}", choice.most_bits);
    text += " bits: " + choice.why;
  }
  if (choice.exact_count == 0) return text;
  if (choice.exact_count == choice.attribute_count) return text + " stays exact";
  return text + fmt::format("; {} of {} stay exact", choice.exact_count, choice.attribute_count);
}

std::string checkText(const ConvertReport& report) {
  if (!report.checked || report.payloads.empty()) return "";
  return "decoded and compared: every vertex and triangle is there, with no larger errors";
}

}  // namespace

std::string accuracyText(const ConvertReport& report) {
  std::vector<std::string> words = {positionText(report)};
  for (const Measure& measure : kMeasures) {
    double worst = -1;
    bool is_angle = false;
    for (const gltf::PayloadReport& payload : report.payloads) {
      for (const AttributeReport& attribute : payload.attributes) {
        const bool is_wanted =
            attribute.bits != 0 && !isPosition(attribute) && &measureOf(attribute.name) == &measure;
        if (!is_wanted) continue;
        worst = std::max(worst, attribute.max_error);
        is_angle |= attribute.is_angle;
      }
    }
    if (worst <= 0) continue;
    words.push_back(fmt::format("{} {}{}", measure.name, shortNumber(measure.scale * worst),
                                is_angle ? " degrees" : measure.unit));
  }
  std::string text;
  for (const std::string& word : words) {
    if (!word.empty()) text += text.empty() ? word : ", " + word;
  }
  if (text.empty() && !report.payloads.empty()) return "none: every number keeps every bit";
  return text;
}

std::string titleText(const Converted& converted) {
  const std::string names =
      gltf::printable(converted.input) + " -> " + gltf::printable(converted.output);
  if (converted.report.copied) {
    return fmt::format("{}: copied, {} bytes\n", names, grouped(converted.report.output_bytes));
  }
  return names + "\n";
}

std::string summaryText(const Converted& converted) {
  const ConvertReport& report = converted.report;
  if (report.copied) return "";
  const Contents& before = report.input_contents;
  const Contents& after = report.output_contents;
  Lines lines(std::max(report.input_bytes, report.output_bytes));
  lines.addBytes("geometry", before.geometry_bytes, after.geometry_bytes, geometryText(report));
  lines.addBytes("images", before.image_bytes, after.image_bytes, imagesText(after));
  if (after.image_file_count != 0) {
    lines.add("images", counted(after.image_file_count, "image", "images") +
                            " in files of their own, which are not counted here");
  }
  lines.addBytes("animations", before.animation_bytes, after.animation_bytes,
                 animationsText(after));
  lines.addBytes("the rest", before.other_bytes, after.other_bytes, "");
  lines.addBytes("file", report.input_bytes, report.output_bytes, brotliText(converted));
  if (report.preview_bytes != 0) {
    lines.add("preview", grouped(report.preview_bytes) + " bytes in front");
  }
  if (report.fallback_bytes != 0) {
    lines.add("fallback", grouped(report.fallback_bytes) + " bytes in a second file");
  }
  for (const gltf::QualityChoice& choice : report.quality_choices) {
    const bool is_first = &choice == &report.quality_choices.front();
    lines.add(is_first ? "quality" : "", choiceText(choice));
  }
  lines.add("errors", accuracyText(report));
  lines.add("check", checkText(report));
  lines.add("Draco", converted.draco);
  return lines.text();
}

}  // namespace mcc::tool
