// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "precision_options.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <memory>

#include "gltf/compress/quality.h"

namespace mcc::tool {
namespace {

/// Powers of two that --step takes.
constexpr int kLeastExponent = -126;
constexpr int kMostExponent = 127;

/// Reads a whole text as a number. Returns false for anything else, infinity and NaN among it.
template <class Number>
bool readNumber(std::string_view text, Number& number) {
  const char* const end = text.data() + text.size();
  const auto [rest, code] = std::from_chars(text.data(), end, number);
  return code == std::errc() && rest == end && std::isfinite(static_cast<double>(number));
}

/// Returns "2^-10 (0.0009765625)".
std::string powerText(int exponent) {
  return fmt::format("2^{} ({})", exponent, std::ldexp(1.0, exponent));
}

/// Reads "2^-10", or a number that is a power of two.
double stepOf(const std::string& text) {
  double step = 0;
  int exponent = 0;
  if (text.starts_with("2^")) {
    if (!readNumber(std::string_view(text).substr(2), exponent)) exponent = kMostExponent + 1;
    if (exponent >= kLeastExponent && exponent <= kMostExponent) return std::ldexp(1.0, exponent);
  } else if (readNumber(text, step) && step > 0) {
    const bool is_power = std::frexp(step, &exponent) == 0.5;
    const int below = exponent - 1;  // 2^below <= step < 2^exponent
    if (below >= kLeastExponent && below < kMostExponent + (is_power ? 1 : 0)) {
      if (is_power) return step;
      throw UsageError("--step", fmt::format("{} is not a power of two; the nearest are {} and {}",
                                             text, powerText(below), powerText(exponent)));
    }
  }
  throw UsageError("--step",
                   fmt::format("takes a power of two from 2^{} to 2^{}, as in 2^-10 or {}, not {}",
                               kLeastExponent, kMostExponent, std::ldexp(1.0, -10), text));
}

/// Reads "2048px" or, as a share of the model, "1/2048" or "0.0005". Returns pixels.
double qualityOf(const std::string& text) {
  const std::string_view all = text;
  double pixels = 0;
  double share = 0;
  bool is_known = false;
  if (all.ends_with("px")) {
    is_known = readNumber(all.substr(0, all.size() - 2), pixels);
  } else if (all.starts_with("1/")) {
    is_known = readNumber(all.substr(2), pixels);
  } else if (readNumber(all, share) && share > 0) {
    pixels = 1 / share;
    is_known = share < 1;
    if (share >= gltf::kLeastPixels) {
      throw UsageError("--quality", fmt::format("{} of what? Write {}px for a size on the screen, "
                                                "or 1/{} for a share of the model",
                                                text, text, text));
    }
  }
  if (is_known && pixels >= gltf::kLeastPixels && pixels <= gltf::kMostPixels) return pixels;
  throw UsageError("--quality", fmt::format("takes 16px to 1048576px, or 1/16 to 1/1048576 of the "
                                            "model's size, not {}",
                                            text));
}

}  // namespace

void addStep(Command& command, gltf::ConvertOptions& options) {
  const auto text = std::make_shared<std::string>();
  Option& step = command.add("--step", "2^N", text.get(),
                             "Step of a lattice through the origin, on which files can meet");
  step.excludes = {"--lossless", "--position-bits", "--max-position-error", "--position-lattice"};
  step.then = [text, &options]() { options.step = stepOf(*text); };
}

void addQuality(Command& command, gltf::ConvertOptions& options) {
  const auto text = std::make_shared<std::string>();
  Option& quality =
      command.add("--quality", "[Npx|1/N]", text.get(),
                  "Choose all bits: N pixels large, or errors of 1/N of size [4096px]");
  quality.when_alone = "4096px";
  quality.excludes = {"--lossless",        "--position-bits", "--normal-bits",
                      "--texcoord-bits",   "--color-bits",    "--tangent-bits",
                      "--weight-bits",     "--step",          "--max-position-error",
                      "--position-lattice"};
  quality.then = [text, &options]() { options.quality = qualityOf(*text); };
}

}  // namespace mcc::tool
