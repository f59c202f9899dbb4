// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "gltf/inspect/coding_names.h"

#include <initializer_list>

#include "container/payload_header.h"
#include "format/methods.h"

namespace mcc::gltf {
namespace {

/// Collects words: one for a number, and one for each bit that is set.
class Words {
 public:
  explicit Words(uint8_t bits) : bits_(bits) {}

  Words& number(uint8_t mask, uint32_t shift, std::initializer_list<const char*> names) {
    const uint32_t value = static_cast<uint32_t>(bits_ & mask) >> shift;
    if (value < names.size()) word(names.begin()[value]);
    return *this;
  }
  Words& bit(uint8_t mask, const char* name) {
    if ((bits_ & mask) != 0) word(name);
    return *this;
  }
  Words& word(const std::string& name) {
    if (!name.empty()) text_ += (text_.empty() ? "" : ", ") + name;
    return *this;
  }
  std::string text() const { return text_; }

 private:
  const uint8_t bits_;
  std::string text_;
};

std::string nameOfPosition(uint8_t bits) {
  return Words(bits)
      .bit(position_mode::kWeights, "weights")
      .bit(position_mode::kSelect, "tip selection")
      .bit(position_mode::kShear, "shear")
      .bit(position_mode::kPalette, "palette")
      .bit(position_mode::kPlanes, "planes")
      .bit(position_mode::kFold, "fold")
      .bit(position_mode::kOwnScale, "own scale")
      .bit(position_mode::kSplit, "split")
      .text();
}

}  // namespace

std::string predictorName(const AttributeInfo* attributes, uint32_t count, uint32_t index) {
  if (index == 0) return nameOfPosition(attributes[0].predictor);
  const AttributeMethod method = methodOf(attributes, count, index);
  const PredictorFields fields = fieldsOf(method);
  const uint8_t bits = attributes[index].predictor;
  Words words(bits);
  words.word(fields.name);
  for (const PredictorField& field : fields) words.word(field.words[field.valueOf(bits)]);
  if (!isWithAnother(method)) words.bit(kHasEqualities, "equalities");
  return words.text();
}

}  // namespace mcc::gltf
