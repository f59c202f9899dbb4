// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "gltf/check/compare.h"

#include <algorithm>
#include <initializer_list>
#include <tuple>
#include <unordered_set>

#include "gltf/document/accessors.h"
#include "gltf/document/references.h"

namespace mcc::gltf {

void SameBytes::add(const ByteRange& in_source, const ByteRange& in_result, size_t number) {
  if (in_source.end - in_source.begin != in_result.end - in_result.begin) {
    first_ = std::min(first_, number);
  } else if (in_source.begin != in_source.end) {
    pairs_.push_back({in_source, in_result.buffer, in_result.begin, number});
  }
}

size_t SameBytes::firstDifference() {
  const auto motion = [](const Pair& pair) {
    return std::tuple(pair.in_source.buffer, pair.result_buffer,
                      pair.result_begin - pair.in_source.begin);
  };
  std::sort(pairs_.begin(), pairs_.end(), [&](const Pair& a, const Pair& b) {
    return std::tuple(motion(a), a.in_source.begin) < std::tuple(motion(b), b.in_source.begin);
  });
  uint64_t compared = 0;  // bytes before it that belong to an earlier pair, moved alike, were
  uint64_t difference = kNothing;  // the last of them that differs
  for (size_t i = 0; i < pairs_.size(); ++i) {
    const auto& [in_source, result_buffer, result_begin, number] = pairs_[i];
    if (i != 0 && motion(pairs_[i - 1]) != motion(pairs_[i])) {
      compared = 0;
      difference = kNothing;
    }
    const uint64_t from = std::max(in_source.begin, compared);
    const bool is_known = in_source.begin <= difference && difference < in_source.end;
    if (!is_known && from < in_source.end) {
      const uint64_t count = in_source.end - from;
      const auto a = source_.buffers[in_source.buffer].subspan(from, count);
      const auto b =
          result_.buffers[result_buffer].subspan(result_begin + (from - in_source.begin), count);
      const auto same = std::mismatch(a.begin(), a.end(), b.begin()).first - a.begin();
      compared = from + static_cast<uint64_t>(same);
      if (compared != in_source.end) difference = compared++;
    }
    if (in_source.begin <= difference && difference < in_source.end) {
      first_ = std::min(first_, number);
    }
  }
  return first_;
}

namespace {

/// What does not count when the JSON of a document is compared.
struct Exceptions {
  std::unordered_set<const Json*> hidden;  ///< is as if it was not there
  std::unordered_set<const Json*> alike;   ///< is equal to anything that is alike as well

  bool isVisible(const Json& value) const { return !hidden.contains(&value); }
  bool hasVisible(const Json& json) const {
    return std::any_of(json.begin(), json.end(), [&](const Json& v) { return isVisible(v); });
  }
  void hide(const Json& object, std::initializer_list<const char*> keys) {
    for (const char* key : keys) {
      if (const Json* member = findMember(object, key)) hidden.insert(member);
    }
  }
  /// Hides a member that has nothing visible in it.
  void hideEmpty(const Json& object, const char* key) {
    const Json* const member = findMember(object, key);
    if (member != nullptr && member->is_structured() && !hasVisible(*member)) {
      hidden.insert(member);
    }
  }
};

/// Compares two values, each with its exceptions.
class Comparison {
 public:
  Comparison(const Exceptions& in_a, const Exceptions& in_b) : in_a_(in_a), in_b_(in_b) {}

  /// Whether two values differ. `path` is extended to the place of the difference.
  bool differs(const Json& a, const Json& b, std::string& path) const {
    if (in_a_.alike.contains(&a)) return !in_b_.alike.contains(&b);
    if (!a.is_structured() || a.kind() != b.kind()) return !(a == b);
    const std::vector<size_t> of_a = visibleOf(a, in_a_);
    const std::vector<size_t> of_b = visibleOf(b, in_b_);
    if (of_a.size() != of_b.size()) return true;
    const size_t length = path.size();
    for (size_t i = 0; i < of_a.size(); ++i) {
      path = a.is_array() ? at(path, of_a[i]) : at(path, a.keyAt(of_a[i]));
      const bool has_key = a.is_array() || a.keyAt(of_a[i]) == b.keyAt(of_b[i]);
      if (!has_key || differs(a[of_a[i]], b[of_b[i]], path)) return true;
      path.resize(length);
    }
    return false;
  }

 private:
  /// Returns the numbers of what is visible in an array or object, members sorted by key; those
  /// with the same key stay in the order of the object.
  static std::vector<size_t> visibleOf(const Json& json, const Exceptions& exceptions) {
    std::vector<size_t> numbers;
    for (size_t i = 0; i < json.size(); ++i) {
      if (exceptions.isVisible(json[i])) numbers.push_back(i);
    }
    if (json.is_array()) return numbers;
    std::stable_sort(numbers.begin(), numbers.end(),
                     [&](size_t a, size_t b) { return json.keyAt(a) < json.keyAt(b); });
    return numbers;
  }

  const Exceptions& in_a_;
  const Exceptions& in_b_;
};

/// The accessors that something compressed uses, before or after.
using Touched = std::set<uint32_t>;

void exceptLists(const Json& root, Exceptions& exceptions) {
  const auto isOfCodec = [](const Json& name) {
    return name == kExtensionName || name == kMeshExtension ||
           std::find(std::begin(kViewExtensions), std::end(kViewExtensions), name.text()) !=
               std::end(kViewExtensions);
  };
  for (const char* list : {"extensionsUsed", "extensionsRequired"}) {
    for (const Json& name : arrayOf(root, list)) {
      if (name.is_string() && isOfCodec(name)) exceptions.hidden.insert(&name);
    }
    exceptions.hideEmpty(root, list);
  }
}

void exceptGeometry(const Json& primitive, Exceptions& exceptions) {
  exceptions.hide(primitive, {"attributes", "indices", "mode", "targets"});
  const Json* const extensions = findMember(primitive, "extensions");
  if (extensions == nullptr) return;
  exceptions.hide(*extensions, {kExtensionName, kMeshExtension});
  exceptions.hideEmpty(primitive, "extensions");
}

void exceptAccessors(const Json& root, const Touched& touched, size_t accessor_count,
                     Exceptions& exceptions) {
  const Json& accessors = arrayOf(root, "accessors");
  for (size_t i = 0; i < accessors.size(); ++i) {
    const Json& accessor = accessors[i];
    if (i >= accessor_count) exceptions.hidden.insert(&accessor);
    exceptions.hide(accessor, {"byteOffset"});
    if (const Json* sparse = findMember(accessor, "sparse")) {
      for (const char* part : {"indices", "values"}) {
        if (const Json* place = findMember(*sparse, part)) exceptions.hide(*place, {"byteOffset"});
      }
    }
    if (!touched.contains(static_cast<uint32_t>(i))) continue;
    exceptions.hide(accessor, {"bufferView", "sparse", "min", "max", "count", "componentType"});
  }
  exceptions.hideEmpty(root, "accessors");
}

/// Returns what a conversion may change: numbers and places of buffer views, and the compressed
/// geometry itself. Accessors from `accessor_count` on are ours.
Exceptions exceptionsOf(const Document& document, const std::vector<PrimitiveRef>& compressed,
                        const Touched& touched, size_t accessor_count) {
  Exceptions exceptions;
  const Json& root = document.json;
  exceptions.hide(root, {"buffers", "bufferViews"});
  exceptLists(root, exceptions);
  const auto exceptNumber = [&](const Json& number) { exceptions.alike.insert(&number); };
  visitViewReferences(root, [&](const Json& number, uint32_t) { exceptNumber(number); });
  visitAccessorReferences(root, [&](const Json& number) {
    if (isMissing(number, document.accessors.size())) exceptNumber(number);
  });
  for (const PrimitiveRef& ref : compressed)
    exceptGeometry(*document.primitive(ref).json, exceptions);
  exceptAccessors(root, touched, accessor_count, exceptions);
  return exceptions;
}

/// Compares the bytes of everything that a conversion must not change.
class BytesChecker {
 public:
  BytesChecker(const Document& source, const Document& written)
      : source_(source), written_(written), bytes_(source, written) {}

  void addAccessor(uint32_t index) {
    const Accessor& a = source_.accessors[index];
    if (a.view == kNone && a.sparse.count == 0) return;
    const Accessor& b = written_.accessors[index];
    const bool is_same = a.fault.ok() == b.fault.ok() && a.count == b.count &&
                         a.elementBytes() == b.elementBytes() &&
                         strideOf(source_, a) == strideOf(written_, b);
    const std::vector<ByteRange> in_source = accessorRanges(source_, index, false);
    const std::vector<ByteRange> in_written = accessorRanges(written_, index, false);
    if (!is_same || in_source.size() != in_written.size()) {
      return addDifference("/accessors", index, "has another size");
    }
    if (!sameCodings(a, b)) return addDifference("/accessors", index, "the coded bytes changed");
    for (size_t i = 0; i < in_source.size(); ++i) {
      add(in_source[i], in_written[i], "/accessors", index, "its elements changed");
    }
  }

  void addImages() {
    const Json& images = arrayOf(source_.json, "images");
    const Json& in_written = arrayOf(written_.json, "images");
    for (size_t i = 0; i < images.size(); ++i) {
      addViews(findMember(images[i], "bufferView"), findMember(in_written[i], "bufferView"),
               "/images", i);
    }
  }

  /// Adds the property tables, of which the JSON has the same. Their views have names of their own.
  void addTables() {
    for (const std::string_view path : kTableViews) {
      std::vector<const Json*> in_written;
      visitPath(&written_.json, path, [&](const Json& number) { in_written.push_back(&number); });
      size_t i = 0;
      visitPath(&source_.json, path, [&](const Json& number) {
        const Json* const now = i < in_written.size() ? in_written[i++] : nullptr;
        addViews(&number, now, "/bufferViews", number.get<uint64_t>());
      });
    }
  }

  void addView(uint32_t view) {
    if (view >= written_.views.size()) {
      return addDifference("/bufferViews", view, "the bytes changed");
    }
    add(viewRange(source_, view), viewRange(written_, view), "/bufferViews", view,
        "the bytes changed");
  }

  Result run() {
    const size_t first = std::min(bytes_.firstDifference(), first_);
    if (first == SameBytes::kNothing) return {};
    return error(at(places_[first].array, places_[first].index), places_[first].what);
  }

 private:
  struct Place {
    const char* array;
    uint64_t index;
    const char* what;
  };

  static uint64_t strideOf(const Document& document, const Accessor& accessor) {
    return accessor.view == kNone ? 0 : document.views[accessor.view].stride;
  }

  void add(const ByteRange& in_source, const ByteRange& in_written, const char* array,
           uint64_t index, const char* what) {
    bytes_.add(in_source, in_written, places_.size());
    places_.push_back({array, index, what});
  }

  void addDifference(const char* array, uint64_t index, const char* what) {
    first_ = std::min(first_, places_.size());
    places_.push_back({array, index, what});
  }

  /// Adds the views that two members name. A view that does not exist was wrong in the source, too.
  void addViews(const Json* number, const Json* new_number, const char* array, uint64_t index) {
    const uint32_t old_view = indexOf(number, source_.views.size());
    if (old_view == kNone) return;
    const uint32_t new_view = indexOf(new_number, written_.views.size());
    if (new_view == kNone) return addDifference(array, index, "is lost");
    add(viewRange(source_, old_view), viewRange(written_, new_view), array, index,
        "the bytes changed");
  }

  /// Whether views that another codec compressed are described as they were.
  bool sameCodings(const Accessor& a, const Accessor& b) const {
    const std::vector<uint32_t> in_source = a.views();
    const std::vector<uint32_t> in_written = b.views();
    const auto isSame = [&](uint32_t source_view, uint32_t written_view) {
      const ViewCoding& x = source_.views[source_view].coding;
      const ViewCoding& y = written_.views[written_view].coding;
      return std::tie(x.extension, x.mode, x.filter, x.count, x.stride) ==
             std::tie(y.extension, y.mode, y.filter, y.count, y.stride);
    };
    return std::equal(in_source.begin(), in_source.end(), in_written.begin(), in_written.end(),
                      isSame);
  }

  const Document& source_;
  const Document& written_;
  SameBytes bytes_;
  std::vector<Place> places_;  ///< of the pairs, by number
  size_t first_ = SameBytes::kNothing;
};

/// Where views keep their numbers, adds every view, except those that only compressed accessors
/// used.
void addViews(const Document& source, const Touched& touched, BytesChecker& checker) {
  if (!source.foreign.keep_numbers) return;
  std::vector<bool> is_freed;
  for (const BufferView& view : source.views) is_freed.push_back(view.use == ViewUse::kFree);
  for (const uint32_t index : touched) {
    if (index >= source.accessors.size()) continue;
    const Accessor& accessor = source.accessors[index];
    for (const uint32_t view : accessor.views()) is_freed[view] = true;
    if (accessor.decoded_from != kNone) is_freed[accessor.decoded_from] = true;
  }
  for (uint32_t view = 0; view < source.views.size(); ++view) {
    if (!is_freed[view]) checker.addView(view);
  }
}

}  // namespace

std::string firstDifference(const Json& a, const Json& b) {
  std::string path;
  if (!Comparison({}, {}).differs(a, b, path)) return "";
  return path.empty() ? "/" : path;
}

Result compareRest(const Document& source, const Document& written,
                   const std::vector<ExtensionUse>& uses, const std::set<uint32_t>& reordered) {
  Touched touched = reordered;
  std::vector<PrimitiveRef> compressed;
  for (const ExtensionUse& use : uses) {
    const PrimitiveRef ref = {use.mesh, use.primitive};
    const bool is_old = extensionOf(*source.primitive(ref).json, kExtensionName) != nullptr;
    if (!is_old) compressed.push_back(ref);
    touched.insert(use.indices_accessor);
    for (const auto& attribute : use.attributes) touched.insert(attribute.accessor);
  }
  const size_t count = source.accessors.size();
  const Exceptions in_source = exceptionsOf(source, compressed, touched, count);
  const Exceptions in_written = exceptionsOf(written, compressed, touched, count);
  std::string path;
  if (Comparison(in_source, in_written).differs(source.json, written.json, path)) {
    return error(path.empty() ? "/" : path, "the JSON changed");
  }
  BytesChecker checker(source, written);
  for (uint32_t i = 0; i < count; ++i) {
    if (!touched.contains(i)) checker.addAccessor(i);
  }
  checker.addImages();
  checker.addTables();
  addViews(source, touched, checker);
  return checker.run();
}

}  // namespace mcc::gltf
