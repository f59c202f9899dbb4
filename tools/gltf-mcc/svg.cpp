// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "svg.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace mcc::tool {

std::string nameOf(const Color& color) {
  const auto byte = [](double value) {
    return static_cast<int>(std::clamp(value, 0., 255.) + 0.5);
  };
  return fmt::format("#{:02x}{:02x}{:02x}", byte(color.red), byte(color.green), byte(color.blue));
}

Color between(const Color& a, const Color& b, double share) {
  return {a.red + (b.red - a.red) * share, a.green + (b.green - a.green) * share,
          a.blue + (b.blue - a.blue) * share};
}

namespace {

int64_t tenthsOf(double value) { return static_cast<int64_t>(std::floor(value * 10 + 0.5)); }

std::string numberOf(int64_t tenths) {
  if (tenths % 10 == 0) return std::to_string(tenths / 10);
  const char* sign = tenths < 0 ? "-" : "";
  return fmt::format("{}{}.{}", sign, std::abs(tenths) / 10, std::abs(tenths) % 10);
}

}  // namespace

std::string number(double value) { return numberOf(tenthsOf(value)); }

std::string place(double x, double y) { return number(x) + " " + number(y); }

void PathData::moveTo(double x, double y) {
  add('m', x, y);
  start_ = point_;
}

void PathData::lineTo(double x, double y) { add('l', x, y); }

void PathData::close() {
  text_ += 'z';
  last_ = 0;
  point_ = start_;
}

void PathData::add(char command, double x, double y) {
  // Points that follow "m" without a letter are those of lines; a second "m" needs its letter.
  if (command == 'm' || last_ == 0) {
    text_ += command;
    last_ = command;
  }
  const Point next = {tenthsOf(x), tenthsOf(y)};
  addTenths(next.x - point_.x);
  addTenths(next.y - point_.y);
  point_ = next;
}

/// Adds a number, behind a space where it would join the one before: a sign separates, too.
void PathData::addTenths(int64_t tenths) {
  std::string number = numberOf(tenths);
  if (const size_t zero = number.find("0."); zero <= 1 && std::abs(tenths) < 10) {
    number.erase(zero, 1);
  }
  const bool is_after_letter = text_.back() == 'm' || text_.back() == 'l';
  if (!is_after_letter && tenths >= 0) text_ += ' ';
  text_ += number;
}

std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '<') {
      result += "&lt;";
    } else if (c == '&') {
      result += "&amp;";
    } else if (c == '>') {
      result += "&gt;";
    } else if (static_cast<unsigned char>(c) >= 0x20 && c != 0x7f) {
      result += c;
    }
  }
  return result;
}

double lengthOf(const std::string& text) {
  const std::string narrow = "fijlrt,.:;|'()- ";
  double length = 0;
  for (const char c : text) length += narrow.find(c) == std::string::npos ? 0.6 : 0.36;
  return length;
}

}  // namespace mcc::tool
