// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "documents/random_document.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <limits>

#include "foreign/draco_codec.h"
#include "foreign/meshopt_codec.h"
#include "gltf/document/glb.h"
#include "json/json.h"
#include "support/gltf_builder.h"
#include "support/mesh_generators.h"

namespace mcc::gltf::test {
namespace {

using mcc::test::Random;
using mcc::test::TestMesh;

constexpr char kMeshopt[] = "EXT_meshopt_compression";
constexpr char kDraco[] = "KHR_draco_mesh_compression";

/// Elements of an accessor before they are placed.
struct Column {
  std::string type = "VEC3";
  int component_type = kFloat;
  bool is_normalized = false;
  uint32_t count = 0;
  Bytes tight;
  bool is_for_vertices = true;

  uint32_t columns() const { return shapeOf(type).columns; }
  uint32_t rows() const { return shapeOf(type).rows; }
  uint32_t components() const { return columns() * rows(); }
  uint32_t tightBytes() const { return components() * widthOf(component_type); }
  uint32_t columnBytes() const {
    const uint32_t bytes = rows() * widthOf(component_type);
    return columns() == 1 ? bytes : (bytes + 3) / 4 * 4;
  }
  uint32_t elementBytes() const { return columns() * columnBytes(); }
  /// Writes all elements in the layout of a buffer, `stride` apart.
  void layOut(uint8_t* out, size_t stride) const {
    const uint32_t column_count = columns();
    const uint32_t tight_column = rows() * widthOf(component_type);
    const uint32_t column_bytes = columnBytes();
    const uint8_t* from = tight.data();
    for (uint32_t i = 0; i < count; ++i, out += stride) {
      std::memset(out, 0, size_t{column_count} * column_bytes);
      for (uint32_t c = 0; c < column_count; ++c, from += tight_column)
        std::memcpy(out + c * column_bytes, from, tight_column);
    }
  }
  void add(double value) {
    withType(component_type, [&](auto typed) {
      typed = static_cast<decltype(typed)>(value);
      const size_t at = tight.size();
      tight.resize(at + sizeof typed);
      std::memcpy(tight.data() + at, &typed, sizeof typed);
    });
  }
  double get(size_t number) const { return componentAt(component_type, tight.data(), number); }
};

/// The largest number of an integer type; 1 for floats.
double largestOf(int component_type) {
  static constexpr double kLargest[] = {127, 255, 32767, 65535, 1, 4294967295.0, 1};
  return kLargest[component_type - kByte];
}

double clampTo(int component_type, double value) {
  if (component_type == kFloat) return value;
  const double largest = largestOf(component_type);
  const bool is_signed = component_type == kByte || component_type == kShort;
  return std::clamp(value, is_signed ? -largest - 1 : 0.0, largest);
}

const std::vector<TestMesh>& zoo() {
  static const std::vector<TestMesh> kZoo = [] {
    std::vector<TestMesh> small;
    for (TestMesh& mesh : mcc::test::smallZoo()) {
      if (mesh.triangleCount() <= 700 && mesh.vertexCount() <= 700)
        small.push_back(std::move(mesh));
    }
    return small;
  }();
  return kZoo;
}

// ---- JSON as other tools spell it --------------------------------------------------

class Printer {
 public:
  Printer(Random& random, bool is_odd) : random_(random), is_odd_(is_odd) {}

  std::string print(const Json& json) {
    out_.clear();
    add(json);
    return out_;
  }

 private:
  void space() {
    if (is_odd_ && random_.chance(5)) out_ += random_.chance(50) ? "\n\t" : "  ";
  }

  void addText(const std::string& text) {
    const std::string plain = Json(text).dump();
    if (!is_odd_ || !random_.chance(20)) {
      out_ += plain;
      return;
    }
    for (size_t i = 0; i < plain.size(); ++i) {
      const char c = plain[i];
      const bool is_letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
      if (c == '\\') {  // do not split an escape
        out_ += c;
        out_ += plain[++i];
        for (int k = 0; plain[i] == 'u' && k < 4; ++k)
          out_ += plain[i + 1 + static_cast<size_t>(k)];
        if (plain[i] == 'u') i += 4;
      } else if (is_letter && random_.chance(30)) {
        char escaped[8];
        std::snprintf(escaped, sizeof escaped, random_.chance(50) ? "\\u%04x" : "\\u%04X", c);
        out_ += escaped;
      } else if (c == '/' && random_.chance(50)) {
        out_ += "\\/";
      } else {
        out_ += c;
      }
    }
  }

  void addNumber(const Json& json) {
    const std::string plain = json.dump();
    if (!is_odd_ || !random_.chance(8) || plain.find_first_of("eE") != std::string::npos) {
      out_ += plain;
      return;
    }
    const bool is_whole = plain.find('.') == std::string::npos;
    switch (random_.below(5)) {
      case 0: out_ += plain == "0" ? (random_.chance(50) ? "-0" : "-0.0") : plain + "e0"; break;
      case 1: out_ += is_whole ? plain + ".0" : plain + "000"; break;
      case 2: out_ += is_whole && plain != "0" && plain != "-0" ? plain + "0E-1" : plain; break;
      case 3: out_ += is_whole ? plain + ".000e+00" : plain + "E0"; break;
      default: out_ += plain; break;
    }
  }

  void add(const Json& json) {
    space();
    if (json.is_object()) {
      char separator = '{';
      for (const auto& [key, value] : json.items()) {
        out_ += separator;
        space();
        addText(key);
        space();
        out_ += ':';
        add(value);
        separator = ',';
      }
      if (separator == '{') out_ += '{';
      space();
      out_ += '}';
    } else if (json.is_array()) {
      char separator = '[';
      for (const Json& value : json) {
        out_ += separator;
        add(value);
        separator = ',';
      }
      if (separator == '[') out_ += '[';
      out_ += ']';
    } else if (json.is_number()) {
      addNumber(json);
    } else if (json.is_string()) {
      addText(json.text());
    } else {
      out_ += json.dump();
    }
    space();
  }

  Random& random_;
  bool is_odd_;
  std::string out_;
};

// ---- The document ------------------------------------------------------------------------------

class Maker {
 public:
  explicit Maker(uint64_t seed) : random_(seed) { random_.next(); }

  RandomDocument make() {
    chooseStyle();
    json_["asset"] = {{"version", "2.0"}};
    if (random_.chance(30)) json_["asset"]["generator"] = "random document";
    const uint32_t mesh_count = random_.chance(4)    ? 0
                                : random_.chance(3)  ? random_.between(5, 40)
                                : random_.chance(60) ? 1
                                                     : random_.between(2, 4);
    for (uint32_t i = 0; i < mesh_count; ++i) addMesh();
    addNodes();
    addSkins();
    addAnimations();
    addImages();
    addMaterials();
    addLooseAccessors();
    addExtrasAndExtensions();
    if (codes_views_) codeViews();
    finishLists();
    write();
    chooseOptions();
    return std::move(document_);
  }

 private:
  bool chance(uint32_t percent) { return random_.chance(percent); }
  uint32_t below(uint32_t bound) { return random_.below(bound); }
  double real(double low, double high) { return low + (high - low) * random_.unit(); }

  void chooseStyle() {
    buffer_count_ = chance(75) ? 1 : random_.between(2, 4);
    buffers_.resize(buffer_count_);
    is_odd_ = chance(25);
    is_wild_ = chance(30);       // NaN, infinity, huge values
    is_quantized_ = chance(25);  // KHR_mesh_quantization
    codes_views_ = chance(8);
    codes_meshes_ = !codes_views_ && chance(8);
    is_plain_ = chance(25);  // nothing but tight views
  }

  // ---- buffers, views, accessors ----

  uint32_t addView(const Bytes& bytes, uint32_t stride, uint32_t alignment) {
    const uint32_t number = below(buffer_count_);
    Bytes& buffer = buffers_[number];
    if (!is_plain_ && chance(15)) {  // a gap with something in it
      for (uint32_t n = below(23); n > 0; --n) buffer.push_back(static_cast<uint8_t>(below(256)));
    }
    while (buffer.size() % alignment != 0) buffer.push_back(0);
    Json view = {{"buffer", number}, {"byteOffset", buffer.size()}, {"byteLength", bytes.size()}};
    if (buffer.empty() && chance(50)) view.erase("byteOffset");
    if (stride != 0) view["byteStride"] = stride;
    if (!is_plain_ && chance(5)) view["name"] = "view";
    buffer.insert(buffer.end(), bytes.begin(), bytes.end());
    json_["bufferViews"].push_back(view);
    return static_cast<uint32_t>(json_["bufferViews"].size() - 1);
  }

  Json describeColumn(const Column& column) {
    Json accessor = {
        {"componentType", column.component_type}, {"count", column.count}, {"type", column.type}};
    if (column.is_normalized) {
      accessor["normalized"] = true;
    } else if (chance(3)) {
      accessor["normalized"] = false;
    }
    if (chance(3)) accessor["name"] = "accessor \u00fc";
    return accessor;
  }

  void addBounds(const Column& column, Json& accessor) {
    std::vector<double> values;
    for (size_t i = 0; i < size_t{column.count} * column.components(); ++i) {
      values.push_back(column.get(i));
      if (!std::isfinite(values.back())) return;
    }
    if (values.empty()) return;
    if (column.component_type == kFloat)
      return Builder::setBounds<double>(accessor, values, column.components());
    const std::vector<int64_t> whole(values.begin(), values.end());
    Builder::setBounds<int64_t>(accessor, whole, column.components());
  }

  uint32_t addAccessor(const Column& column, Json accessor, bool with_bounds) {
    if (with_bounds || chance(10)) addBounds(column, accessor);
    json_["accessors"].push_back(std::move(accessor));
    columns_.push_back(column);
    return static_cast<uint32_t>(columns_.size() - 1);
  }

  static uint32_t strideOf(const Column& column) {
    const uint32_t bytes = column.elementBytes();
    return column.is_for_vertices ? (bytes + 3) / 4 * 4 : bytes;
  }

  /// The elements at multiples of `stride`; the last one without padding or with it.
  Bytes layOut(const Column& column, uint32_t stride) {
    const uint32_t element_bytes = column.elementBytes();
    Bytes bytes(size_t{column.count} * stride);
    column.layOut(bytes.data(), stride);
    for (uint32_t i = 0; i < column.count; ++i) {
      if (i + 1 == column.count && chance(50)) {
        bytes.resize(size_t{i} * stride + element_bytes);
        break;
      }
      for (uint32_t k = element_bytes; k < stride; ++k)
        bytes[size_t{i} * stride + k] = static_cast<uint8_t>(below(3));
    }
    return bytes;
  }

  /// Places elements in a view of their own, packed or strided.
  void putAlone(const Column& column, Json& accessor) {
    uint32_t stride = strideOf(column);
    const bool may_stride = column.is_for_vertices && stride <= 252;
    bool is_strided = stride != column.elementBytes() && may_stride;
    if (may_stride && !is_plain_ && chance(20)) {
      stride = std::min<uint32_t>(252, stride + 4 * below(4));
      is_strided = true;
    }
    if (chance(1)) {  // what some exporters get wrong: elements of three bytes without padding
      stride = column.elementBytes();
      is_strided = false;
    }
    if (!is_strided) stride = column.elementBytes();
    Bytes bytes = layOut(column, stride);
    uint32_t offset = 0;
    if (!is_plain_ && chance(10)) {
      offset = 4 * below(5);
      bytes.insert(bytes.begin(), offset, uint8_t{7});
    }
    if (bytes.empty()) bytes.resize(4);
    const uint32_t view = addView(bytes, is_strided ? stride : 0, 4);
    if (column.is_for_vertices && chance(30)) json_["bufferViews"][view]["target"] = 34962;
    accessor["bufferView"] = view;
    if (offset != 0 || chance(20)) accessor["byteOffset"] = offset;
    if (!is_plain_ && chance(3)) {  // another view of the same bytes
      json_["bufferViews"].push_back(json_["bufferViews"][view]);
      accessor["bufferView"] = json_["bufferViews"].size() - 1;
    }
  }

  /// Places elements in a view that others use, too.
  bool putBeside(const Column& column, Json& accessor) {
    if (column.is_for_vertices || shared_view_ == kNone) return false;
    Json& view = json_["bufferViews"][shared_view_];
    Bytes& buffer = buffers_[view["buffer"]];
    const uint64_t begin = view.contains("byteOffset") ? view["byteOffset"].get<uint64_t>() : 0;
    if (begin + view["byteLength"].get<uint64_t>() != buffer.size()) return false;
    while (buffer.size() % 4 != 0) buffer.push_back(0);
    accessor["bufferView"] = shared_view_;
    accessor["byteOffset"] = buffer.size() - begin;
    const Bytes bytes = layOut(column, column.elementBytes());
    buffer.insert(buffer.end(), bytes.begin(), bytes.end());
    view["byteLength"] = buffer.size() - begin;
    return true;
  }

  void putSparse(const Column& column, Json& accessor) {
    Column base = column;
    std::vector<uint32_t> changed;
    const bool has_view = chance(50);
    const uint32_t share = random_.between(1, 60);
    for (uint32_t i = 0; i < column.count; ++i) {
      const auto begin = column.tight.begin() + i * column.tightBytes();
      const bool is_zero =
          std::all_of(begin, begin + column.tightBytes(), [](uint8_t byte) { return byte == 0; });
      const bool is_changed = has_view ? chance(share) : !is_zero || chance(3);
      if (!is_changed) continue;
      changed.push_back(i);
      std::fill_n(base.tight.begin() + i * column.tightBytes(), column.tightBytes(),
                  static_cast<uint8_t>(below(64)));
    }
    if (has_view) putAlone(base, accessor);
    if (changed.empty()) {
      if (!has_view && column.count != 0) return;
      return;
    }
    int type = column.count < 200 && chance(50)     ? kUnsignedByte
               : column.count < 60000 && chance(70) ? kUnsignedShort
                                                    : kUnsignedInt;
    if (column.count > 255 && type == kUnsignedByte) type = kUnsignedShort;
    Column indices = {"SCALAR", type, false, static_cast<uint32_t>(changed.size()), {}, false};
    Column values = column;
    values.count = indices.count;
    values.tight.clear();
    values.is_for_vertices = false;
    for (const uint32_t i : changed) {
      indices.add(i);
      const auto begin = column.tight.begin() + i * column.tightBytes();
      values.tight.insert(values.tight.end(), begin, begin + column.tightBytes());
    }
    const Bytes index_bytes = layOut(indices, indices.elementBytes());
    const Bytes value_bytes = layOut(values, values.elementBytes());
    Json sparse = {{"count", changed.size()},
                   {"indices", {{"bufferView", 0}, {"componentType", type}}},
                   {"values", {{"bufferView", 0}}}};
    if (chance(30)) {  // both in one view
      Bytes both = index_bytes;
      while (both.size() % 4 != 0) both.push_back(0);
      sparse["values"]["byteOffset"] = both.size();
      both.insert(both.end(), value_bytes.begin(), value_bytes.end());
      const uint32_t view = addView(both, 0, 4);
      sparse["indices"]["bufferView"] = view;
      sparse["values"]["bufferView"] = view;
    } else {
      sparse["indices"]["bufferView"] = addView(index_bytes, 0, 4);
      sparse["values"]["bufferView"] = addView(value_bytes, 0, 4);
    }
    accessor["sparse"] = sparse;
  }

  uint32_t place(const Column& column, bool with_bounds = false) {
    Json accessor = describeColumn(column);
    const bool is_zero = std::all_of(column.tight.begin(), column.tight.end(),
                                     [](uint8_t byte) { return byte == 0; });
    if (column.count != 0 && is_zero && !is_plain_ && chance(60)) {
      // No bytes at all.
    } else if (!is_plain_ && column.count != 0 && chance(12)) {
      putSparse(column, accessor);
    } else if (is_plain_ || !chance(30) || !putBeside(column, accessor)) {
      putAlone(column, accessor);
      if (!column.is_for_vertices) shared_view_ = accessor["bufferView"];
    }
    return addAccessor(column, std::move(accessor), with_bounds);
  }

  /// Several vertex attributes in one view.
  std::vector<uint32_t> placeInterleaved(const std::vector<Column>& columns) {
    uint32_t stride = 0;
    std::vector<uint32_t> offsets;
    for (const Column& column : columns) {
      offsets.push_back(stride);
      stride += strideOf(column);
    }
    if (chance(20)) stride += 4 * below(3);
    std::vector<uint32_t> numbers;
    if (stride > 252 || columns.empty() || columns[0].count == 0) {
      for (const Column& column : columns) numbers.push_back(place(column));
      return numbers;
    }
    Bytes bytes(size_t{stride} * columns[0].count, 0xcd);
    for (size_t k = 0; k < columns.size(); ++k) columns[k].layOut(&bytes[offsets[k]], stride);
    const uint32_t view = addView(bytes, stride, 4);
    for (size_t k = 0; k < columns.size(); ++k) {
      Json accessor = describeColumn(columns[k]);
      accessor["bufferView"] = view;
      accessor["byteOffset"] = offsets[k];
      numbers.push_back(addAccessor(columns[k], std::move(accessor), false));
    }
    return numbers;
  }

  // ---- geometry ----

  TestMesh randomShape() {
    using namespace mcc::test;
    TestMesh mesh;
    const uint64_t seed = random_.next();
    switch (below(12)) {
      case 0: mesh = icosphere(below(3)); break;
      case 1: mesh = randomSoup(seed % 1000); break;
      case 2:
        mesh = chartGrid(random_.between(2, 16), random_.between(2, 16), random_.between(1, 5));
        break;
      case 3: mesh = generated(seed, below(3), below(4), random_.between(1, 3)); break;
      case 4:
      case 5:
      case 6: mesh = zoo()[below(static_cast<uint32_t>(zoo().size()))]; break;
      case 7: mesh = looseTriangles(random_.between(1, 6)); break;
      case 8:
        mesh = withDegenerates(withUnused(grid(8, 8, QuadSplit::kRandom, seed), seed, below(9)),
                               seed, below(9));
        break;
      default:
        mesh = grid(random_.between(1, 20), random_.between(1, 20), QuadSplit::kRandom, seed);
        break;
    }
    if (mesh.triangleCount() > 1500 || mesh.vertexCount() > 1500) mesh = grid(7, 9);
    if (chance(15)) mesh = withFlippedTriangles(mesh, seed, random_.between(1, 50));
    if (chance(10)) mesh = withIndexDuplicates(mesh, seed, below(6));
    if (chance(10)) mesh = withRandomWedges(mesh, seed, 3);
    if (chance(20)) mesh = shuffled(mesh, seed);
    return mesh;
  }

  double specialValue() {
    static const double kValues[] = {std::numeric_limits<double>::quiet_NaN(),
                                     std::numeric_limits<double>::infinity(),
                                     -std::numeric_limits<double>::infinity(),
                                     3e38,
                                     -3e38,
                                     3.4028234663852886e38,
                                     1e-45,
                                     -1e-40,
                                     1.1754943508222875e-38,
                                     -0.0,
                                     1e20,
                                     16777217.0,
                                     0.1};
    return kValues[below(13)];
  }

  /// Makes values like those in real files; `base` are positions they may depend on.
  Column values(const std::string& type, int component_type, bool is_normalized, uint32_t count,
                const std::vector<float>& base) {
    Column column = {type, component_type, is_normalized, count, {}, true};
    const uint32_t components = column.components();
    const double unit = component_type == kFloat ? 1
                        : is_normalized          ? largestOf(component_type)
                                                 : 20;
    const uint32_t pattern = below(8);
    const uint32_t special_share =
        is_wild_ && component_type == kFloat && chance(35) ? random_.between(1, 30) : 0;
    const double scale = component_type != kFloat ? unit : std::pow(10.0, real(-4, 4));
    const double offset = chance(20) ? scale * real(-100, 100) : 0;
    const double constant = real(-1, 1);
    for (uint32_t i = 0; i < count; ++i) {
      for (uint32_t c = 0; c < components; ++c) {
        double value = 0;
        const double x = base.empty() ? double(i) : base[(3 * size_t{i} + c % 3) % base.size()];
        switch (pattern) {
          case 0: value = constant; break;
          case 1: value = below(4) / 4.0; break;
          case 2: value = real(-1, 1); break;
          case 3: value = 0; break;
          case 4: value = chance(10) ? real(0, 1) : 0; break;
          case 5: value = real(0, 1); break;
          default: value = 0.5 + 0.5 * std::sin(x * (c + 1.0)); break;
        }
        value = pattern == 1 || pattern == 5 ? value * unit : value * scale + offset;
        if (component_type != kFloat) value = std::floor(value);
        if (component_type == kUnsignedInt && chance(3)) value = 4294967295.0 - below(3);
        if (special_share != 0 && chance(special_share)) value = specialValue();
        column.add(clampTo(component_type, value));
      }
    }
    return column;
  }

  Column positionsOf(const TestMesh& mesh) {
    Column column = {"VEC3", kFloat, false, mesh.vertexCount(), {}, true};
    static const int kTypes[] = {kByte, kUnsignedByte, kShort, kUnsignedShort};
    if (is_quantized_ && chance(60)) {
      column.component_type = kTypes[below(4)];
      column.is_normalized = chance(50);
    }
    const double scale = column.component_type == kFloat
                             ? (chance(60) ? 1 : std::pow(10.0, real(-6, 6)))
                             : largestOf(column.component_type) / 4;
    const double offset =
        column.component_type == kFloat && chance(15) ? 1000 * scale * real(-1, 1) : 0;
    const uint32_t special_share =
        is_wild_ && column.component_type == kFloat && chance(25) ? random_.between(1, 12) : 0;
    const bool is_snapped = chance(15);
    for (const float position : mesh.positions) {
      double value = position * scale + offset;
      if (is_snapped) value = std::round(value * 16) / 16;
      if (column.component_type != kFloat)
        value = std::floor(value + largestOf(column.component_type) / 2);
      if (special_share != 0 && chance(special_share)) value = specialValue();
      column.add(clampTo(column.component_type, value));
    }
    return column;
  }

  Column unitVectors(const TestMesh& mesh, uint32_t components) {
    Column column = {vectorType(components), kFloat, false, mesh.vertexCount(), {}, true};
    if (is_quantized_ && chance(50)) {
      column.component_type = chance(50) ? kByte : kShort;
      column.is_normalized = true;
    }
    const uint32_t pattern = below(5);
    const bool is_wild = is_wild_ && column.component_type == kFloat && chance(20);
    for (uint32_t i = 0; i < column.count; ++i) {
      double v[3] = {mesh.positions[3 * i] + 0.01, mesh.positions[3 * i + 1],
                     mesh.positions[3 * i + 2]};
      if (pattern == 1) v[0] = 0, v[1] = 0, v[2] = 1;
      if (pattern == 2) v[0] = real(-1, 1), v[1] = real(-1, 1), v[2] = real(-1, 1);
      double length = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
      if (length == 0) v[2] = length = 1;
      if (pattern == 3 && chance(5)) length *= real(0.5, 2);
      for (uint32_t c = 0; c < components; ++c) {
        double value = c == 3 ? (chance(50) ? 1 : -1) : v[c] / length;
        if (pattern == 4 && c < 3 && i % 16 == 5) value = 0;
        if (column.component_type != kFloat)
          value = std::round(value * largestOf(column.component_type));
        if (is_wild && chance(5)) value = specialValue();
        column.add(value);
      }
    }
    return column;
  }

  void addSkinning(uint32_t count, std::vector<std::pair<std::string, Column>>& attributes) {
    const uint32_t sets = chance(75) ? 1 : 2;
    static const int kTypes[] = {kFloat, kFloat, kUnsignedByte, kUnsignedShort};
    const int weight_type = kTypes[below(4)];
    const int joint_type = chance(50) ? kUnsignedByte : kUnsignedShort;
    const double one = weight_type == kFloat ? 1 : largestOf(weight_type);
    const bool is_good = chance(85);
    std::vector<Column> joints(sets, {"VEC4", joint_type, false, count, {}, true});
    std::vector<Column> weights(sets,
                                {"VEC4", weight_type, weight_type != kFloat, count, {}, true});
    for (uint32_t i = 0; i < count; ++i) {
      const uint32_t used = random_.between(1, 4 * sets);
      std::vector<double> share(4 * sets, 0);
      double sum = 0;
      for (uint32_t k = 0; k < used; ++k) sum += share[k] = real(0.01, 1);
      double rest = one;
      for (uint32_t k = 0; k < 4 * sets; ++k) {
        double weight = k + 1 == used ? rest : share[k] / sum * one;
        if (weight_type != kFloat) weight = std::floor(weight);
        if (k >= used) weight = 0;
        rest -= weight;
        if (!is_good) weight = clampTo(weight_type, std::floor(real(-1, 2) * one));
        weights[k / 4].add(weight);
        joints[k / 4].add(weight == 0 && chance(90) ? 0 : below(kJointCount));
      }
    }
    for (uint32_t set = 0; set < sets; ++set) {
      attributes.push_back({"JOINTS_" + std::to_string(set), joints[set]});
      attributes.push_back({"WEIGHTS_" + std::to_string(set), weights[set]});
    }
    has_skin_ = true;
  }

  using Attributes = std::vector<std::pair<std::string, Column>>;

  /// All attributes but POSITION.
  void addAttributes(const TestMesh& mesh, Attributes& attributes) {
    const uint32_t count = mesh.vertexCount();
    if (chance(55)) attributes.push_back({"NORMAL", unitVectors(mesh, 3)});
    if (chance(20)) attributes.push_back({"TANGENT", unitVectors(mesh, 4)});
    static const int kTexcoordTypes[] = {kFloat, kFloat, kFloat, kUnsignedByte, kUnsignedShort};
    const uint32_t texcoord_sets = chance(50) ? 0 : random_.between(1, 3);
    for (uint32_t set = 0; set < texcoord_sets; ++set) {
      int type = kTexcoordTypes[below(5)];
      bool is_normalized = type != kFloat;
      if (is_quantized_ && chance(40)) {
        type = chance(50) ? kByte : kShort;
        is_normalized = chance(50);
      }
      attributes.push_back({"TEXCOORD_" + std::to_string(set),
                            values("VEC2", type, is_normalized, count, mesh.positions)});
    }
    const uint32_t color_sets = chance(75) ? 0 : random_.between(1, 2);
    static const int kColorTypes[] = {kFloat, kUnsignedByte, kUnsignedShort};
    for (uint32_t set = 0; set < color_sets; ++set) {
      const int type = kColorTypes[below(3)];
      attributes.push_back(
          {"COLOR_" + std::to_string(set),
           values(vectorType(random_.between(3, 4)), type, type != kFloat, count, mesh.positions)});
    }
    if (chance(15)) addSkinning(count, attributes);
    static const char* const kTypes[] = {"SCALAR", "VEC2", "VEC3", "VEC4", "MAT2", "MAT3", "MAT4"};
    static const int kComponentTypes[] = {kByte,          kUnsignedByte, kShort,
                                          kUnsignedShort, kUnsignedInt,  kFloat};
    for (uint32_t n = chance(75) ? 0 : random_.between(1, 3); n > 0; --n) {
      const int type = kComponentTypes[below(6)];
      const bool is_normalized = type < kUnsignedInt && chance(30);
      const char* shape = kTypes[below(7)];
      static const char* const kNames[] = {"_X", "_FEATURE_ID_0", "_TEMPERATURE", "_a b",
                                           "_\u00fc"};
      attributes.push_back(
          {kNames[below(5)], values(shape, type, is_normalized, count, mesh.positions)});
    }
    if (chance(10)) {
      Column ids = {"SCALAR", chance(50) ? kFloat : kUnsignedShort, false, count, {}, true};
      for (uint32_t i = 0; i < count; ++i) ids.add(i);
      attributes.push_back({"_FEATURE_ID_1", ids});
    }
    if (chance(3)) {  // a name that promises another type
      static const char* const kNames[] = {"NORMAL",  "TANGENT",  "TEXCOORD_0",
                                           "COLOR_0", "JOINTS_0", "WEIGHTS_0"};
      attributes.push_back({kNames[below(6)], values(kTypes[below(7)], kComponentTypes[below(6)],
                                                     false, count, mesh.positions)});
    }
  }

  Json addTargets(const TestMesh& mesh) {
    const uint32_t count = mesh.vertexCount();
    const uint32_t target_count = chance(90) ? random_.between(1, 4) : random_.between(20, 45);
    Json targets = Json::array();
    for (uint32_t k = 0; k < target_count; ++k) {
      Json target = Json::object();
      const auto delta = [&](const char* name, uint32_t components) {
        Column column = values(vectorType(components), kFloat, false, count, mesh.positions);
        if (chance(60)) {  // most vertices stay
          for (uint32_t i = 0; i < count; ++i) {
            if (chance(80))
              std::fill_n(column.tight.begin() + i * column.tightBytes(), column.tightBytes(),
                          uint8_t{0});
          }
        }
        target[name] = place(column, std::string(name) == "POSITION");
      };
      if (chance(85)) delta("POSITION", 3);
      if (chance(30)) delta("NORMAL", 3);
      if (chance(15)) delta("TANGENT", 3);
      if (chance(5)) delta("TEXCOORD_0", 2);
      if (chance(5)) delta("COLOR_0", 4);
      if (chance(4)) delta("_X", 1);
      targets.push_back(target);
    }
    return targets;
  }

  uint32_t addIndices(const std::vector<uint32_t>& indices, uint32_t vertex_count,
                      bool with_bounds) {
    int type = kUnsignedInt;
    if (vertex_count < 65535 && chance(75)) type = kUnsignedShort;
    if (vertex_count < 255 && chance(40)) type = kUnsignedByte;
    Column column = {"SCALAR", type, false, static_cast<uint32_t>(indices.size()), {}, false};
    for (const uint32_t index : indices) column.add(index);
    const uint32_t accessor = place(column, with_bounds);
    Json& json = json_["accessors"][accessor];
    if (json.contains("bufferView") && !json.contains("sparse") && chance(20)) {
      json_["bufferViews"][json["bufferView"].get<size_t>()]["target"] = 34963;
    }
    return accessor;
  }

  struct Known {
    Json primitive;
    TestMesh mesh;
  };

  /// Indices of a primitive on the vertices of `mesh`, and its mode.
  void addTopology(const TestMesh& mesh, Json& primitive) {
    const uint32_t count = mesh.vertexCount();
    std::vector<uint32_t> indices = mesh.indices;
    uint32_t mode = 4;
    if (chance(14)) {
      static const uint32_t kModes[] = {0, 1, 2, 3, 5, 5, 6, 6};
      mode = kModes[below(8)];
      if (mode == 1 && indices.size() % 2 != 0) indices.pop_back();
      if (indices.size() > 300) indices.resize(300);
    } else if (chance(10) && indices.size() >= 6) {  // some of the triangles
      indices.resize(3 * random_.between(1, static_cast<uint32_t>(indices.size() / 3)));
    }
    if (mode != 4 || chance(15)) primitive["mode"] = mode;
    if (chance(6) && (mode != 4 || count % 3 == 0)) return;  // no indices
    primitive["indices"] = addIndices(indices, count, chance(15));
  }

  Json newPrimitive(TestMesh& mesh) {
    Json primitive = Json::object();
    Attributes attributes = {{"POSITION", positionsOf(mesh)}};
    addAttributes(mesh, attributes);
    if (chance(20)) std::swap(attributes.front(), attributes.back());
    std::vector<uint32_t> numbers;
    if (!is_plain_ && chance(25)) {
      std::vector<Column> columns;
      for (const auto& [name, column] : attributes) columns.push_back(column);
      numbers = placeInterleaved(columns);
    } else {
      for (const auto& [name, column] : attributes) numbers.push_back(place(column));
    }
    Json map = Json::object();
    for (size_t i = 0; i < attributes.size(); ++i) {
      map[attributes[i].first] = numbers[i];
      if (attributes[i].first == "POSITION" && !chance(3)) {
        addBounds(attributes[i].second, json_["accessors"][numbers[i]]);
      }
    }
    addStrangeUses(mesh.vertexCount(), map);
    primitive["attributes"] = map;
    if (chance(12)) primitive["targets"] = addTargets(mesh);
    if (chance(2)) primitive["targets"] = Json::array({map});  // an attribute as its own delta
    addTopology(mesh, primitive);
    if (chance(1) && primitive.contains("indices")) {
      const uint32_t indices = primitive["indices"];
      if (columns_[indices].count == mesh.vertexCount())
        primitive["attributes"]["_INDEX"] = indices;
    }
    return primitive;
  }

  /// One accessor for two attributes.
  void addStrangeUses(uint32_t count, Json& map) {
    if (!chance(6) || map.empty()) return;
    const auto accessor = map[below(static_cast<uint32_t>(map.size()))].get<uint32_t>();
    static const char* const kNames[] = {"_COPY", "NORMAL", "TEXCOORD_5", "COLOR_3"};
    if (columns_[accessor].count == count) map[kNames[below(4)]] = accessor;
  }

  /// Adds a primitive that shares something with an existing one.
  Json sharingPrimitive(TestMesh& mesh) {
    const Known& known = known_[below(static_cast<uint32_t>(known_.size()))];
    mesh = known.mesh;
    Json primitive = known.primitive;
    switch (below(6)) {
      case 0: break;  // the same again
      case 1:         // other attributes on the same positions
        for (const char* name : {"NORMAL", "TEXCOORD_0", "COLOR_0"})
          primitive["attributes"].erase(name);
        primitive["attributes"]["_Y"] =
            place(values("SCALAR", kFloat, false, mesh.vertexCount(), mesh.positions));
        break;
      case 2:  // another mode on the same indices
        primitive["mode"] = random_.between(0, 6);
        if (chance(70)) primitive["mode"] = random_.between(4, 6);
        break;
      case 3:  // own positions, the same indices
        primitive["attributes"]["POSITION"] = place(positionsOf(mesh), true);
        break;
      default:  // other triangles on the same attributes
        primitive.erase("mode");
        addTopology(mesh, primitive);
        break;
    }
    return primitive;
  }

  /// Replaces the bytes of a primitive by Draco's.
  void codeWithDraco(Json& primitive) {
    if (primitive.contains("targets") || !primitive.contains("indices") ||
        primitive.contains("mode"))
      return;
    std::vector<AttributeView> views;
    std::vector<std::string> names;
    std::vector<Column> columns;
    for (const auto& [name, number] : primitive["attributes"].items()) {
      const Column& column = columns_[number.get<size_t>()];
      if (column.components() > 4) return;
      names.insert(name == "POSITION" ? names.begin() : names.end(), name);
      columns.insert(name == "POSITION" ? columns.begin() : columns.end(), column);
    }
    if (names.empty() || columns[0].type != "VEC3") return;
    static const std::map<int, ComponentType> kTypes = {
        {kByte, ComponentType::kInt8},          {kUnsignedByte, ComponentType::kUint8},
        {kShort, ComponentType::kInt16},        {kUnsignedShort, ComponentType::kUint16},
        {kUnsignedInt, ComponentType::kUint32}, {kFloat, ComponentType::kFloat32}};
    for (size_t i = 0; i < names.size(); ++i) {
      if (columns[i].count != columns[0].count) return;
      AttributeView view;
      view.format.semantic = i == 0 ? Semantic::kPosition : Semantic::kCustom;
      view.format.component_type = kTypes.at(columns[i].component_type);
      view.format.component_count = static_cast<uint8_t>(columns[i].components());
      view.data = columns[i].tight.data();
      view.stride_bytes = columns[i].tightBytes();
      views.push_back(view);
    }
    const Column& index_column = columns_[primitive["indices"].get<size_t>()];
    std::vector<uint32_t> indices;
    for (uint32_t i = 0; i < index_column.count; ++i)
      indices.push_back(static_cast<uint32_t>(index_column.get(i)));
    const PartView part = {indices};
    const PieceView piece = {columns[0].count, views, {&part, 1}};
    foreign::DracoPrimitive coded;
    if (!foreign::emitDracoPrimitive(piece, 0, static_cast<int>(below(11)), coded).ok()) return;
    foreign::DecodedMesh decoded;
    if (!foreign::decodeDraco(coded.bytes, decoded).ok() || decoded.triangle_count == 0) return;
    Json ids = Json::object();
    for (const foreign::DracoPrimitiveAttribute& attribute : coded.attributes) {
      Column column = columns[attribute.piece_attribute];
      const auto* values = decoded.find(attribute.unique_id);
      if (values == nullptr) return;
      column.count = decoded.vertex_count;
      const auto* first = reinterpret_cast<const uint8_t*>(values->values.get());
      column.tight.assign(first, first + values->elementBytes() * decoded.vertex_count);
      const std::string& name = names[attribute.piece_attribute];
      ids[name] = attribute.unique_id;
      primitive["attributes"][name] =
          addAccessor(column, describeColumn(column), name == "POSITION");
    }
    Column column = {"SCALAR", kUnsignedInt, false, 3 * decoded.triangle_count, {}, false};
    for (const uint32_t index : decoded.indexSpan()) column.add(index);
    primitive["indices"] = addAccessor(column, describeColumn(column), false);
    primitive["extensions"][kDraco] = {{"bufferView", addView(coded.bytes, 0, 4)},
                                       {"attributes", ids}};
    used_.insert({kDraco, true});
  }

  void addMesh() {
    const uint32_t primitive_count = chance(70)   ? 1
                                     : chance(95) ? random_.between(2, 5)
                                                  : random_.between(10, 40);
    Json primitives = Json::array();
    size_t target_count = 0;
    for (uint32_t i = 0; i < primitive_count; ++i) {
      TestMesh mesh;
      Json primitive;
      if (!known_.empty() && chance(i == 0 ? 10 : 55)) {
        primitive = sharingPrimitive(mesh);
      } else {
        mesh = primitive_count > 6 ? mcc::test::grid(random_.between(1, 4), random_.between(1, 4))
                                   : randomShape();
        primitive = newPrimitive(mesh);
        if (codes_meshes_ && chance(60)) codeWithDraco(primitive);
      }
      if (!primitive.contains("extensions")) known_.push_back({primitive, mesh});
      if (chance(20)) primitive["material"] = 0;
      if (primitive.contains("targets")) target_count = primitive["targets"].size();
      primitives.push_back(primitive);
    }
    Json mesh = {{"primitives", primitives}};
    if (chance(20)) mesh["name"] = chance(5) ? std::string(70000, 'n') : "mesh \u00e9\n";
    if (target_count != 0 && chance(50)) mesh["weights"] = std::vector<double>(target_count, 0.25);
    if (target_count != 0 && chance(30))
      mesh["extras"]["targetNames"] = std::vector<std::string>(target_count, "smile");
    json_["meshes"].push_back(mesh);
  }

  // ---- what is not geometry ----

  size_t sizeOf(const char* key) const { return json_.contains(key) ? json_[key].size() : 0; }

  void addNodes() {
    for (size_t mesh = 0; mesh < sizeOf("meshes"); ++mesh) {
      for (uint32_t n = chance(75) ? 1 : below(4); n > 0; --n) {
        Json node = {{"mesh", mesh}};
        if (chance(20)) node["translation"] = {real(-9, 9), 1, 2};
        if (chance(5)) node["scale"] = {1, -1, 0.5};
        nodes_.push_back(node);
      }
    }
    if (chance(20)) nodes_.push_back({{"name", "nothing"}});
    if (chance(8) && !nodes_.empty()) {
      Column places = values("VEC3", kFloat, false, random_.between(1, 20), {});
      is_wild_ = false;
      places.is_for_vertices = false;
      nodes_[0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["TRANSLATION"] =
          chance(30) ? anyAccessor("VEC3", place(places)) : place(places);
      used_.insert({"EXT_mesh_gpu_instancing", false});
    }
  }

  /// An accessor of float vectors that something else uses, too.
  uint32_t anyAccessor(const std::string& type, uint32_t otherwise) {
    for (int tries = 0; tries < 8; ++tries) {
      const uint32_t accessor = below(static_cast<uint32_t>(columns_.size()));
      const Column& column = columns_[accessor];
      if (column.type == type && column.component_type == kFloat && column.count != 0)
        return accessor;
    }
    return otherwise;
  }

  void addSkins() {
    if (!has_skin_) return;
    Json joints = Json::array();
    Column matrices = {"MAT4", kFloat, false, kJointCount, {}, false};
    for (uint32_t i = 0; i < kJointCount; ++i) {
      joints.push_back(nodes_.size());
      nodes_.push_back({{"name", "joint"}});
      for (uint32_t k = 0; k < 16; ++k) matrices.add(k % 5 == 0 ? 1 : 0);
    }
    Json skin = {{"joints", joints}};
    if (chance(80)) skin["inverseBindMatrices"] = place(matrices);
    json_["skins"] = Json::array({skin});
    for (Json& node : nodes_) {
      if (!node.contains("mesh")) continue;
      bool is_skinned = true;
      for (const Json& primitive : json_["meshes"][node["mesh"].get<size_t>()]["primitives"]) {
        is_skinned &= primitive["attributes"].contains("JOINTS_0");
      }
      if (is_skinned) node["skin"] = 0;
    }
  }

  void addAnimations() {
    if (!chance(20) || nodes_.empty()) return;
    const uint32_t keys = random_.between(1, 30);
    Column times = {"SCALAR", kFloat, false, keys, {}, false};
    for (uint32_t i = 0; i < keys; ++i) times.add(i * 0.25);
    Column places = {"VEC3", kFloat, false, keys, {}, false};
    for (uint32_t i = 0; i < 3 * keys; ++i) places.add(real(-1, 1));
    uint32_t output = place(places);
    if (chance(25)) output = anyAccessor("VEC3", output);
    Json animation = {
        {"channels",
         {{{"sampler", 0},
           {"target",
            {{"node", below(static_cast<uint32_t>(nodes_.size()))}, {"path", "translation"}}}}}},
        {"samplers", {{{"input", place(times, true)}, {"output", output}}}}};
    if (chance(30)) animation["samplers"][0]["interpolation"] = "STEP";
    json_["animations"] = Json::array({animation});
  }

  void addImages() {
    if (!chance(25)) return;
    const uint32_t count = random_.between(1, 3);
    for (uint32_t i = 0; i < count; ++i) {
      Bytes bytes = {0x89, 'P', 'N', 'G', 0x0d, 0x0a, 0x1a, 0x0a};
      for (uint32_t n = below(200); n > 0; --n) bytes.push_back(static_cast<uint8_t>(below(256)));
      switch (below(3)) {
        case 0:
          json_["images"].push_back({{"uri", "data:image/png;base64," + base64Of(bytes)}});
          break;
        case 1:
          if (chance(50)) {
            document_.files["image " + std::to_string(i) + ".png"] = bytes;
            has_image_files_ = true;
            json_["images"].push_back({{"uri", "image%20" + std::to_string(i) + ".png"}});
            break;
          }
          [[fallthrough]];
        default: {
          const uint32_t view = addView(bytes, 0, 1);
          json_["images"].push_back({{"bufferView", view}, {"mimeType", "image/png"}});
          break;
        }
      }
      json_["textures"].push_back({{"source", i}});
    }
  }

  void addMaterials() {
    json_["materials"] = {{{"name", "m"}}};
    if (json_.contains("textures")) {
      json_["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", 0}};
    }
    if (chance(10) && json_.contains("meshes")) {
      json_["extensions"]["KHR_materials_variants"]["variants"] = {{{"name", "red"}},
                                                                   {{"name", "blue"}}};
      json_["meshes"][0]["primitives"][0]["extensions"]["KHR_materials_variants"]["mappings"] = {
          {{"material", 0}, {"variants", {0, 1}}}};
      used_.insert({"KHR_materials_variants", false});
    }
    if (chance(8) && json_.contains("meshes")) {
      json_["meshes"][0]["primitives"][0]["extensions"]["EXT_mesh_features"]["featureIds"] = {
          {{"featureCount", 3}, {"attribute", 0}}};
      used_.insert({"EXT_mesh_features", false});
    }
  }

  void addLooseAccessors() {
    if (!chance(10)) return;
    Column column = values("VEC2", kUnsignedShort, false, random_.between(1, 9), {});
    column.is_for_vertices = false;
    place(column);
    if (chance(30))
      json_["accessors"].push_back(
          {{"componentType", kFloat}, {"count", random_.between(1, 5)}, {"type", "VEC3"}});
    columns_.resize(json_["accessors"].size());
    if (chance(30)) addView(Bytes(random_.between(1, 40), 3), 0, 4);
  }

  Json strange(uint32_t depth) {
    static const char* const kSpellings[] = {
        "1e0", "-0", "-0.0", "1E+2", "0.1000", "12345678901234567890123", "1e-7", "-5e-324"};
    switch (below(depth == 0 ? 6 : 9)) {
      case 0: return below(1000);
      case 1: return nullptr;
      case 2: return chance(50);
      case 3:
        return std::string("text \" \\ \u0001 \u00fc \U0001f600", chance(30) ? 13 : below(11));
      case 4: {
        const std::string spelling = kSpellings[below(8)];
        return Json::number(spelling);
      }
      case 5: return real(-5, 5);
      case 6: {
        Json list = Json::array();
        for (uint32_t n = below(4); n > 0; --n) list.push_back(strange(depth - 1));
        return list;
      }
      default: {
        Json object = Json::object();
        static const std::string kKeys[] = {
            "a", "b", "", "long key", "drawRange", "name", std::string("n\0l", 3), "\u00e4"};
        for (uint32_t n = below(5); n > 0; --n) {
          const std::string key = kKeys[below(8)];
          const bool is_there = object.contains(key);
          if (is_there && !is_in_extras_) continue;  // refused elsewhere
          if (!is_there || (is_odd_ && chance(50))) object.append(key, strange(depth - 1));
        }
        return object;
      }
    }
  }

  void addExtras(Json& object) {
    if (!object.is_object() || object.contains("extras")) return;
    is_in_extras_ = true;
    object["extras"] = strange(3);
    is_in_extras_ = false;
    if (chance(2)) {
      Json deep = 1;
      for (int i = 0; i < 200; ++i) deep = Json::array({deep});
      object["extras"] = deep;
    }
  }

  void addExtrasAndExtensions() {
    if (chance(40)) return;
    const uint32_t share = chance(50) ? 3 : 15;
    const auto visitArray = [&](const char* key) {
      if (!json_.contains(key)) return;
      for (Json& object : json_[key]) {
        if (chance(share)) addExtras(object);
        if (chance(share / 3)) {
          object["extensions"]["ACME_thing"] = strange(2);
          used_.insert({"ACME_thing", false});
        }
      }
    };
    for (const char* key :
         {"accessors", "bufferViews", "meshes", "materials", "images", "textures", "animations"})
      visitArray(key);
    for (Json& node : nodes_) {
      if (chance(share)) addExtras(node);
    }
    if (chance(share)) addExtras(json_);
    if (chance(share)) addExtras(json_["asset"]);
    if (json_.contains("meshes")) {
      for (Json& mesh : json_["meshes"]) {
        for (Json& primitive : mesh["primitives"]) {
          if (chance(share)) addExtras(primitive);
          if (chance(share / 3)) {
            primitive["extensions"]["ACME_primitive"] = strange(2);
            used_.insert({"ACME_primitive", false});
          }
        }
      }
    }
    if (chance(10) && sizeOf("bufferViews") != 0) {
      const uint32_t view = below(static_cast<uint32_t>(sizeOf("bufferViews")));
      json_["extensions"]["ACME_refers"]["bufferView"] = view;
      document_.kept.views.push_back(view);
      used_.insert({"ACME_refers", false});
    }
    if (chance(10) && !columns_.empty()) {
      const uint32_t accessor = below(static_cast<uint32_t>(columns_.size()));
      json_["extensions"]["ACME_refers"]["someAccessor"] = accessor;
      document_.kept.accessors.push_back(accessor);
      used_.insert({"ACME_refers", false});
    }
  }

  // ---- EXT_meshopt_compression ----

  static uint32_t largestWord(const Bytes& bytes) {
    uint32_t largest = 0;
    for (size_t i = 0; i + 4 <= bytes.size(); i += 4) {
      uint32_t word = 0;
      std::memcpy(&word, &bytes[i], 4);
      largest = std::max(largest, word);
    }
    return largest;
  }

  void codeViews() {
    if (!json_.contains("bufferViews")) return;
    uint64_t placeholder_bytes = 0;
    const uint32_t placeholder = buffer_count_;
    const size_t view_count = json_["bufferViews"].size();
    for (size_t i = 0; i < view_count; ++i) {
      if (!chance(80)) continue;
      Json& view = json_["bufferViews"][i];
      const uint64_t length = view["byteLength"];
      const uint64_t offset = view.contains("byteOffset") ? view["byteOffset"].get<uint64_t>() : 0;
      const Bytes& buffer = buffers_[view["buffer"].get<size_t>()];
      const Bytes bytes(buffer.begin() + static_cast<ptrdiff_t>(offset),
                        buffer.begin() + static_cast<ptrdiff_t>(offset + length));
      std::string mode = "ATTRIBUTES";
      uint32_t stride = view.contains("byteStride") ? view["byteStride"].get<uint32_t>() : 4;
      const bool is_index_view = view.contains("target") && view["target"] == 34963;
      if (is_index_view && length % 4 == 0 && largestWord(bytes) < 1u << 24) mode = "INDICES";
      if (length % stride != 0) continue;
      Bytes coded;
      if (!foreign::encodeMeshoptView(bytes, length / stride, stride, mode, coded).ok()) continue;
      uint32_t target_buffer = below(buffer_count_);
      Bytes& target = buffers_[target_buffer];
      view["extensions"][kMeshopt] = {{"buffer", target_buffer},    {"byteOffset", target.size()},
                                      {"byteLength", coded.size()}, {"byteStride", stride},
                                      {"count", length / stride},   {"mode", mode}};
      target.insert(target.end(), coded.begin(), coded.end());
      view["buffer"] = placeholder;
      view["byteOffset"] = placeholder_bytes;
      placeholder_bytes += (length + 3) / 4 * 4;
    }
    if (placeholder_bytes == 0) return;
    placeholder_bytes_ = placeholder_bytes;
    used_.insert({kMeshopt, true});
  }

  // ---- writing ----

  void finishLists() {
    if (is_quantized_) used_.insert({"KHR_mesh_quantization", true});
    for (const auto& [name, is_required] : used_) {
      json_["extensionsUsed"].push_back(name);
      if (is_required) json_["extensionsRequired"].push_back(name);
    }
    if (!nodes_.empty()) json_["nodes"] = nodes_;
    Json roots = Json::array();
    for (size_t i = 0; i < nodes_.size(); ++i) roots.push_back(i);
    if (!roots.empty()) json_["scenes"] = {{{"nodes", roots}}};
    if (!roots.empty() && chance(70)) json_["scene"] = 0;
  }

  void write() {
    const bool is_glb = chance(60) && !has_image_files_;
    for (uint32_t i = 0; i < buffer_count_; ++i) {
      if (buffers_[i].empty() && buffer_count_ > 1)
        buffers_[i].resize(4);  // glTF has no empty buffers
    }
    Json buffers = Json::array();
    for (uint32_t i = 0; i < buffer_count_; ++i) {
      Json buffer = {{"byteLength", buffers_[i].size()}};
      const bool is_chunk = is_glb && i == 0;
      if (!is_chunk && (is_glb || chance(50))) {
        buffer["uri"] = std::string(chance(50) ? "data:application/octet-stream;base64,"
                                               : "data:application/gltf-buffer;base64,") +
                        base64Of(buffers_[i]);
      } else if (!is_chunk) {
        const std::string name = "data \u00fc" + std::to_string(i) + ".bin";
        buffer["uri"] = "data%20%C3%BC" + std::to_string(i) + ".bin";
        document_.files[name] = buffers_[i];
      }
      if (chance(10)) buffer["name"] = "b";
      buffers.push_back(buffer);
    }
    const bool is_empty = buffer_count_ == 1 && buffers_[0].empty();
    if (placeholder_bytes_ != 0) {
      buffers.push_back(
          {{"byteLength", placeholder_bytes_}, {"extensions", {{kMeshopt, {{"fallback", true}}}}}});
    }
    if (!is_empty) json_["buffers"] = buffers;
    if (is_odd_) shuffleMembers();
    const std::string text = Printer(random_, is_odd_).print(json_);
    document_.main = is_glb ? "in.glb" : "in.gltf";
    Bytes& file = document_.files[document_.main];
    if (is_glb) {
      std::vector<GlbChunk> others;
      const Bytes chunk = {1, 2, 3, 4};
      if (chance(5)) others.push_back({0x12345678, chunk});
      const uint32_t version = chance(25) ? 3 : 2;
      const Result result = writeGlb(text, is_empty ? Bytes{} : buffers_[0], others, file, version);
      if (!result.ok()) file.clear();
    } else {
      if (is_odd_ && chance(10)) file = {0xef, 0xbb, 0xbf};
      file.insert(file.end(), text.begin(), text.end());
    }
  }

  void shuffleMembers() {
    std::vector<size_t> order(json_.size());
    for (size_t i = 0; i < order.size(); ++i) order[i] = i;
    for (size_t i = order.size(); i > 1; --i)
      std::swap(order[i - 1], order[below(static_cast<uint32_t>(i))]);
    Json json = Json::object();
    for (const size_t i : order) json.append(json_.keyAt(i), json_[i]);
    json_ = std::move(json);
  }

  void chooseOptions() {
    ConvertOptions& options = document_.options;
    options.allow_larger = chance(60);
    options.lossless = chance(30);
    if (chance(30)) {
      static const uint8_t kBits[] = {0, 1, 2, 8, 12, 14, 16, 20, 24};
      options.position_bits = kBits[below(9)];
      options.texcoord_bits = kBits[below(9)];
      options.color_bits = kBits[below(9)];
      options.weight_bits = kBits[below(9)];
      static const uint8_t kUnitBits[] = {0, 2, 3, 8, 10, 12, 16};
      options.normal_bits = kUnitBits[below(7)];
      options.tangent_bits = kUnitBits[below(7)];
    }
    if (chance(8)) {
      options.is_error_relative = chance(50);
      options.max_position_error = std::pow(10.0, real(-6, 0));
    } else if (chance(6)) {
      Lattice lattice;
      lattice.step = static_cast<float>(std::pow(10.0, real(-5, 1)));
      for (float& origin : lattice.origin) origin = static_cast<float>(real(-2, 2));
      options.position_lattice = lattice;
    } else if (!options.lossless && chance(6)) {
      options.step = std::ldexp(1.0, static_cast<int>(below(20)) - 16);
    }
    if (options.max_position_error == 0 && !options.position_lattice && options.step == 0 &&
        !options.lossless && chance(8)) {
      options.quality = std::exp2(real(4, 20));
    }
    options.indices_only = chance(10);
    options.grid = static_cast<Grid>(below(3));
    if (chance(50)) options.grid = Grid::kMesh;
    options.keep_vertex_order = chance(20);
    options.keep_triangle_order = chance(20);
    options.prefer = static_cast<Preference>(chance(60) ? 0 : below(3));
    static constexpr GlbVersion kVersions[] = {GlbVersion::kSmallest, GlbVersion::k2,
                                               GlbVersion::k3};
    options.glb_version = kVersions[chance(70) ? 0 : below(3)];
    options.thread_count = chance(90) ? 1 : 2;
    document_.to_memory = document_.files.size() == 1 && chance(60);
    document_.writes_gltf = !document_.to_memory && chance(50);
    options.fallback = !document_.to_memory && chance(8);
  }

  static constexpr uint32_t kJointCount = 7;

  Random random_;
  Json json_;
  Json nodes_ = Json::array();
  std::vector<Bytes> buffers_;
  std::vector<Column> columns_;  ///< of each accessor
  std::vector<Known> known_;
  std::map<std::string, bool> used_;  ///< extensions, and whether they are required
  RandomDocument document_;
  uint32_t buffer_count_ = 1;
  uint32_t shared_view_ = kNone;
  uint64_t placeholder_bytes_ = 0;
  bool is_odd_ = false;
  bool is_wild_ = false;
  bool is_quantized_ = false;
  bool is_plain_ = false;
  bool codes_views_ = false;
  bool codes_meshes_ = false;
  bool has_skin_ = false;
  bool is_in_extras_ = false;
  bool has_image_files_ = false;
};

/// Replaces one number of a JSON text by another one.
void replaceNumber(Random& random, Bytes& bytes) {
  std::vector<std::pair<size_t, size_t>> numbers;
  bool is_text = false;
  for (size_t i = 0; i < bytes.size(); ++i) {
    if (bytes[i] == '"' && (i == 0 || bytes[i - 1] != '\\')) is_text = !is_text;
    if (is_text || bytes[i] < '0' || bytes[i] > '9') continue;
    size_t end = i;
    while (end < bytes.size() && bytes[end] >= '0' && bytes[end] <= '9') ++end;
    numbers.emplace_back(i, end);
    i = end;
  }
  if (numbers.empty()) return;
  static const char* const kOthers[] = {"0",
                                        "1",
                                        "2",
                                        "3",
                                        "4",
                                        "5",
                                        "-1",
                                        "255",
                                        "65535",
                                        "16777215",
                                        "4294967295",
                                        "4294967296",
                                        "1e9",
                                        "null",
                                        "\"a\"",
                                        "0.5",
                                        "1e400",
                                        "[]",
                                        "{}",
                                        "true",
                                        "18446744073709551615",
                                        "9007199254740993",
                                        "5126",
                                        "5125",
                                        "5121"};
  const auto [begin, end] = numbers[random.below(static_cast<uint32_t>(numbers.size()))];
  const std::string other = kOthers[random.below(25)];
  Bytes changed(bytes.begin(), bytes.begin() + static_cast<ptrdiff_t>(begin));
  changed.insert(changed.end(), other.begin(), other.end());
  changed.insert(changed.end(), bytes.begin() + static_cast<ptrdiff_t>(end), bytes.end());
  bytes = std::move(changed);
}

void damageBytes(Random& random, Bytes& bytes) {
  if (bytes.empty()) return;
  const uint32_t at = random.below(static_cast<uint32_t>(bytes.size()));
  switch (random.below(5)) {
    case 0: bytes.resize(at); break;
    case 1: bytes.erase(bytes.begin() + at); break;
    case 2: bytes[at] ^= static_cast<uint8_t>(1u << random.below(8)); break;
    case 3:
      for (uint32_t n = random.below(8); n > 0; --n)
        bytes[random.below(static_cast<uint32_t>(bytes.size()))] =
            static_cast<uint8_t>(random.next());
      break;
    default: bytes[at] = static_cast<uint8_t>(random.next()); break;
  }
}

/// Damages the JSON of a GLB and keeps its length right, so that loaders get to see the damage.
void damageJsonOf(Random& random, Bytes& file) {
  GlbFile glb;
  const bool is_glb = isGlb(file);
  if (is_glb && !readGlb(file, glb).ok()) return;
  Bytes text = is_glb ? Bytes(glb.json.begin(), glb.json.end()) : file;
  for (uint32_t n = random.between(1, 2); n > 0; --n) {
    if (random.chance(75)) {
      replaceNumber(random, text);
    } else {
      damageBytes(random, text);
    }
  }
  if (!is_glb) {
    file = std::move(text);
    return;
  }
  Bytes damaged;
  const std::vector<GlbChunk> others = glb.otherChunks({glb.bin_chunk});
  if (writeGlb({text.begin(), text.end()}, glb.bin, others, damaged, glb.version).ok())
    file = std::move(damaged);
}

}  // namespace

RandomDocument randomDocument(uint64_t seed) {
  return Maker(seed * 0x9e3779b97f4a7c15u + 1).make();
}

void damageGlb(uint64_t seed, Bytes& glb) {
  Random random(seed ^ 0xdeadbeef);
  if (random.chance(60)) {
    damageJsonOf(random, glb);
  } else {
    damageBytes(random, glb);
  }
}

void damage(uint64_t seed, RandomDocument& document) {
  Random random(seed ^ 0xbadc0de);
  Bytes& main = document.files[document.main];
  if (random.chance(10)) {
    auto other = document.files.begin();
    std::advance(other, random.below(static_cast<uint32_t>(document.files.size())));
    if (random.chance(30) && other->first != document.main) {
      document.files.erase(other);
    } else {
      damageBytes(random, other->second);
    }
  } else if (random.chance(70)) {
    damageJsonOf(random, main);
  } else {
    damageBytes(random, main);
  }
}

std::string describe(const ConvertOptions& options) {
  const ConvertOptions standard;
  std::string text;
  const auto add = [&](const std::string& word) { text += (text.empty() ? "" : " ") + word; };
  const QuantizationBits& bits = options;
  if (options.lossless) add("lossless");
  if (bits.position_bits != 14 || bits.normal_bits != 10 || bits.texcoord_bits != 12) {
    add("bits " + std::to_string(bits.position_bits) + "," + std::to_string(bits.normal_bits) +
        "," + std::to_string(bits.texcoord_bits) + "," + std::to_string(bits.color_bits) + "," +
        std::to_string(bits.tangent_bits) + "," + std::to_string(bits.weight_bits));
  }
  if (options.max_position_error != 0)
    add("max-error " + std::to_string(options.max_position_error) +
        (options.is_error_relative ? " relative" : ""));
  if (options.position_lattice)
    add("lattice step " + std::to_string(options.position_lattice->step));
  if (options.step != 0) add("step " + std::to_string(options.step));
  if (options.quality != 0) add("quality " + std::to_string(options.quality));
  if (options.indices_only) add("indices-only");
  if (options.grid != standard.grid)
    add(options.grid == Grid::kScene ? "grid scene" : "grid primitive");
  if (options.keep_vertex_order) add("keep-vertex-order");
  if (options.keep_triangle_order) add("keep-triangle-order");
  if (options.fallback) add("fallback");
  if (options.prefer != Preference::kBalanced)
    add(options.prefer == Preference::kSize ? "prefer size" : "prefer speed");
  if (options.allow_larger) add("allow-larger");
  if (options.glb_version != GlbVersion::kSmallest) {
    add("glb-version " + std::to_string(static_cast<uint32_t>(options.glb_version)));
  }
  return text.empty() ? "defaults" : text;
}

}  // namespace mcc::gltf::test
