// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Finds everything that is wrong with the compressed parts of a file.
#include <algorithm>
#include <limits>
#include <map>
#include <set>

#include "container/payload_header.h"
#include "gltf/decompress/decompress.h"
#include "gltf/document/accessors.h"
#include "gltf/document/package.h"
#include "gltf/document/references.h"
#include "gltf/files/file_io.h"
#include "host/parallel.h"
#include "host/text.h"
#include "mcc/files.h"

namespace mcc::gltf {
namespace {

bool hasElements(const Json& accessor) {
  return accessor.contains("bufferView") || accessor.contains("byteOffset") ||
         accessor.contains("sparse");
}

bool isListed(const Json& json, const char* list) {
  const Json& names = arrayOf(json, list);
  return std::find(names.begin(), names.end(), kExtensionName) != names.end();
}

class Validator {
 public:
  /// `json` is the document as it is in the file; loading removes a fallback that does not exist.
  Validator(const Json& json, const Document& document, const ValidateOptions& options,
            Issues& issues, ValidationReport& report)
      : json_(json),
        meshes_(arrayOf(json, "meshes")),
        accessors_(arrayOf(json, "accessors")),
        document_(document),
        limits_(options.limits),
        decoded_bytes_(options.max_decoded_bytes, document.source_bytes),
        issues_(issues),
        report_(report) {}

  void run() {
    checkFaults();
    findExtensionUses(document_, issues_, uses_);
    report_.compressed_primitive_count = static_cast<uint32_t>(uses_.size());
    checkLists();
    std::map<uint32_t, size_t> uses_of_view;
    const auto addView = [&](uint32_t view) {
      if (view == kNone) return;
      ++uses_of_view[view];
      payload_buffers_.insert(document_.views[view].buffer);
    };
    for (const ExtensionUse& use : uses_) {
      checkObject(use);
      addView(use.view);
      if (use.preview) addView(use.preview->view);
    }
    const Json& views = arrayOf(document_.json, "bufferViews");
    for (const auto& [view, ignored] : uses_of_view) checkView(views, view);
    checkOtherViewUses(uses_of_view);
    const std::vector<PayloadUse> payloads = payloadUses(document_, uses_);
    report_.payload_count = static_cast<uint32_t>(payloads.size());
    if (issues_.passes(rule::kPayloadView, checkPayloadLengths(document_, payloads))) {
      for (const PayloadUse& payload : payloads) checkPayload(payload);
    }
    // Reported once; payloads below the limit were checked.
    issues_.passes(rule::kDecodedBytes, decoded_bytes_.check());
  }

 private:
  // ---- The document

  /// Reports what keeps single views and accessors from being read. A buffer of a .gltf may have
  /// no bytes, because an extension may provide them; that of a GLB has no other place for them.
  void checkFaults() {
    const auto isMissing = [&](uint32_t view) {
      return view != kNone && document_.isMissing(document_.views[view].buffer);
    };
    if (document_.is_glb && document_.isMissing(0)) {
      issues_.add(rule::kDocument, "/buffers/0", "the buffer has neither a URI nor a BIN chunk");
    }
    for (uint32_t view = 0; view < document_.views.size(); ++view) {
      if (!isMissing(view)) issues_.passes(rule::kDocument, document_.views[view].fault);
    }
    for (const Accessor& accessor : document_.accessors) {
      if (!isMissing(accessor.view)) issues_.passes(rule::kDocument, accessor.fault);
    }
  }

  /// Checks properties by the JSON Schema that decoding does not look at.
  void checkObject(const ExtensionUse& use) {
    const Json& extension = (*use.json)["extensions"][kExtensionName];
    const Json* nested = findMember(extension, "extensions");
    if (nested == nullptr) return;
    const std::string path = use.path + "/extensions";
    if (!nested->is_object()) return issues_.add(rule::kSchema, path, "must be an object");
    for (const auto& [name, value] : nested->items()) {
      if (!value.is_object()) issues_.add(rule::kSchema, at(path, name), "must be an object");
    }
  }

  std::set<uint32_t> filledAccessors() const {
    std::set<uint32_t> filled;
    for (const ExtensionUse& use : uses_) {
      if (use.indices_accessor != kNone) filled.insert(use.indices_accessor);
      for (const auto& attribute : use.attributes) filled.insert(attribute.accessor);
    }
    return filled;
  }

  void checkLists() {
    const bool is_used = isListed(json_, "extensionsUsed");
    const bool is_required = isListed(json_, "extensionsRequired");
    if (uses_.empty()) {
      if (is_used || is_required) {
        issues_.add(rule::kUnusedExtension, is_used ? "/extensionsUsed" : "/extensionsRequired",
                    kExtensionName, " is listed, but no primitive has it");
      }
      return;
    }
    if (!is_used) {
      issues_.add(rule::kListedAsUsed, "/extensionsUsed", kExtensionName, " is not listed");
    }
    const std::set<uint32_t> filled = filledAccessors();
    std::vector<uint32_t> bare;
    for (const uint32_t accessor : filled) {
      if (!hasElements(accessors_[accessor])) bare.push_back(accessor);
    }
    if (bare.size() == filled.size()) {
      if (!is_required) {
        issues_.add(rule::kListedAsRequired, "/extensionsRequired", kExtensionName,
                    " is not listed, though there is no fallback for loaders without it");
      }
      return;
    }
    for (const uint32_t accessor : bare) {
      issues_.add(rule::kFallbackForAll, at("/accessors", accessor),
                  "is filled from a payload and has no fallback, as others of the file do");
    }
    if (is_required && bare.empty()) {
      issues_.add(rule::kListedAsRequired, "/extensionsRequired", kExtensionName,
                  " is listed, though everything has a fallback");
    }
  }

  void checkView(const Json& views, uint32_t view) {
    const Json& json = views[view];
    for (const char* key : {"byteStride", "target"}) {
      if (json.contains(key))
        issues_.add(rule::kPayloadView, at(at("/bufferViews", view), key),
                    "must not be defined: the buffer view holds a payload");
    }
  }

  /// Checks that images, accessors and other primitives do not use the view of a payload.
  void checkOtherViewUses(const std::map<uint32_t, size_t>& uses_of_view) {
    std::map<uint32_t, size_t> counts;
    visitViewReferences(document_.json, [&](const Json& reference, uint32_t) {
      ++counts[indexOf(&reference, document_.views.size())];
    });
    for (const auto& [view, count] : uses_of_view) {
      if (counts[view] <= count) continue;
      issues_.add(rule::kSharedPayloadView, at("/bufferViews", view),
                  "holds a payload, but something else refers to it, too");
    }
  }

  // ---- Payloads

  void checkPayload(const PayloadUse& payload) {
    const std::string where = payload.where();
    DecodedPayload decoded;
    const Status opened = decoded.payload.open(payloadBytes(document_, payload.view), limits_);
    if (!opened.ok()) return issues_.addPayloadError(opened, where);
    const PayloadInfo& info = decoded.payload.info();
    if (info.version_minor > kVersionMinor) {
      issues_.add(rule::kMinorVersion, where, "the payload has version ", info.version_major, ".",
                  info.version_minor, "; what is new in it is not checked");
    }
    const std::vector<const ExtensionUse*> sound = checkUsers(payload, info);
    if (!issues_.hasErrors()) checkUse(payload, info, where);
    decoded_bytes_.add(outputBytes(info));
    if (!decoded_bytes_.check().ok()) return;
    const Status status = decodePieces(decoded);
    if (!status.ok()) return issues_.addPayloadError(status, where);
    for (size_t i = 0; i < info.pieces.size() && !payload.users.empty(); ++i) {
      report_.wedge_count += info.pieces[i].wedge_count;
      for (const PartInfo& part : info.pieces[i].parts)
        report_.triangle_count += part.triangle_count;
    }
    for (const ExtensionUse* use : sound) checkElements(*use, decoded.pieces[use->piece]);
  }

  /// Checks the primitives that use a payload, and those whose preview it holds. Returns the users
  /// without an error.
  std::vector<const ExtensionUse*> checkUsers(const PayloadUse& payload, const PayloadInfo& info) {
    std::vector<const ExtensionUse*> sound;
    for (const ExtensionUse* use : payload.users) {
      if (!use->has_numbers) continue;
      Issues own(std::numeric_limits<size_t>::max());
      checkAgainstPayload(document_, *use, info, own);
      if (!own.hasErrors()) sound.push_back(use);
      issues_.append(own);
      checkManifold(*use, info);
    }
    for (const ExtensionUse* use : payload.previewed) {
      if (use->preview->has_numbers) checkPreview(document_, *use, info, issues_);
    }
    return sound;
  }

  void checkManifold(const ExtensionUse& use, const PayloadInfo& info) {
    if (extensionOf(meshes_[use.mesh], kManifoldExtension) == nullptr) return;
    if (use.piece >= info.pieces.size()) return;
    const PieceInfo& piece = info.pieces[use.piece];
    if (piece.keeps_vertex_order && piece.keeps_triangle_order) return;
    issues_.add(rule::kManifold, at("/meshes", use.mesh) + "/extensions/EXT_mesh_manifold",
                "refers to vertices and triangles by number, whose order piece ", use.piece,
                " of the payload does not keep");
  }

  /// Reports parts and attributes that no primitive names.
  void checkUse(const PayloadUse& payload, const PayloadInfo& info, const std::string& where) {
    struct Used {
      std::set<uint64_t> parts, attributes;
    };
    std::vector<Used> used(info.pieces.size());
    const auto add = [&](const PartUse& part, const ExtensionUse& use) {
      if (part.piece >= used.size()) return;
      used[part.piece].parts.insert(part.part);
      for (const auto& attribute : use.attributes) {
        used[part.piece].attributes.insert(attribute.id);
      }
    };
    for (const ExtensionUse* use : payload.users) add(*use, *use);
    for (const ExtensionUse* use : payload.previewed) add(*use->preview, *use);
    for (uint32_t p = 0; p < info.pieces.size(); ++p) {
      const std::string piece = "piece " + std::to_string(p) + " of the payload";
      const auto& [parts, attributes] = used[p];
      for (uint32_t k = 0; k < info.pieces[p].parts.size(); ++k) {
        if (parts.contains(k) || info.pieces[p].parts[k].triangle_count == 0) continue;
        issues_.add(rule::kUnusedPart, where, "no primitive draws part ", k, " of ", piece);
      }
      for (uint32_t k = 0; k < info.pieces[p].attributes.size() && !parts.empty(); ++k) {
        if (attributes.contains(k)) continue;
        issues_.add(rule::kUnusedAttribute, where, "no primitive names attribute ", k, " of ",
                    piece);
      }
    }
  }

  // ---- Decoded elements

  void checkElements(const ExtensionUse& use, const DecodedPiece& piece) {
    for (const ExtensionUse::AttributeUse& attribute : use.attributes) {
      if (!checked_.insert(attribute.accessor).second) continue;
      checkAccessor(attribute.accessor, piece.attributes[attribute.id],
                    attribute.name == "POSITION");
    }
    if (use.indices_accessor == kNone || !checked_.insert(use.indices_accessor).second) return;
    const uint32_t bytes = componentBytes(document_.accessors[use.indices_accessor].component_type);
    checkAccessor(use.indices_accessor, narrowIndices(piece.parts[use.part], bytes), false);
  }

  /// Checks an accessor; `tight` has the decoded elements.
  void checkAccessor(uint32_t number, std::span<const uint8_t> tight, bool needs_bounds) {
    const Accessor& accessor = document_.accessors[number];
    const Json& json = accessors_[number];
    const std::string path = at("/accessors", number);
    const Json* min = findMember(json, "min");
    const Json* max = findMember(json, "max");
    if (needs_bounds && (min == nullptr || max == nullptr)) {
      issues_.add(rule::kBounds, path, "POSITION needs min and max");
    }
    if (min != nullptr || max != nullptr) {
      const Bounds bounds = boundsOf(tight, accessor.component_type, accessor.componentCount());
      const ComponentType type = accessor.component_type;
      issues_.passes(rule::kBounds, checkBound(json, "min", bounds.min, type, path));
      issues_.passes(rule::kBounds, checkBound(json, "max", bounds.max, type, path));
    }
    if (hasElements(json)) checkFallback(number, tight);
  }

  void checkFallback(uint32_t number, std::span<const uint8_t> tight) {
    const Accessor& accessor = document_.accessors[number];
    const std::string path = at("/accessors", number);
    AccessorData elements;
    if (accessor.view == kNone && findMember(accessors_[number], "sparse") == nullptr) {
      return issues_.add(rule::kFallbackLoaded, path, "its fallback could not be loaded");
    }
    if (!issues_.passes(rule::kFallbackLoaded, readAccessor(document_, number, elements))) return;
    const uint64_t i =
        elements.firstDifference(AccessorData::packed(tight, elements.element_bytes));
    if (i != elements.count) {
      issues_.add(rule::kFallbackElements, path, "element ", i,
                  " of the fallback differs from the decoded one");
    }
    if (accessor.view == kNone) return;
    if (!payload_buffers_.contains(document_.views[accessor.view].buffer)) return;
    issues_.add(rule::kFallbackBuffer, at("/bufferViews", accessor.view) + "/buffer",
                "holds a fallback in the same buffer as a payload; if it had its own, loaders that "
                "know the extension would not have to load it");
  }

  const Json& json_;
  const Json& meshes_;
  const Json& accessors_;
  const Document& document_;
  const Limits& limits_;
  DecodedBytes decoded_bytes_;
  Issues& issues_;
  ValidationReport& report_;
  std::vector<ExtensionUse> uses_;
  std::set<uint32_t> checked_;
  std::set<uint32_t> payload_buffers_;  ///< buffers that hold payloads
};

void describe(const Json& json, ValidationReport& report) {
  const Json& asset = json["asset"];
  report.version = asset.value("version", "");
  report.generator = asset.value("generator", "");
  report.extensions_used = extensionNames(json, "extensionsUsed");
  report.extensions_required = extensionNames(json, "extensionsRequired");
  visitPrimitives(json, [&](const PrimitiveRef&, const Json&) { ++report.primitive_count; });
}

void validateInput(const Input& input, const ValidateOptions& options, Issues& issues,
                   ValidationReport& report) {
  report.input_bytes = input.bytes.size();
  report.is_glb = isGlb(input.bytes);
  Json json;
  if (readJson(input.bytes, json).ok()) describe(json, report);
  Document document;
  const Result loaded = loadDocument(input.bytes, input.read_file, document);
  if (!issues.passes(rule::kDocument, loaded)) return;
  report.input_bytes = document.source_bytes;
  Validator(json, document, options, issues, report).run();
}

/// Returns an issue with its place as a pointer, if that is a place in the JSON; otherwise the
/// message includes it.
ValidationIssue publicIssue(const Issue& issue) {
  const bool has_pointer = issue.what.where.starts_with('/');
  const std::string message = has_pointer ? issue.what.what : issue.what.message();
  return {issue.severity, issue.code, printable(message), has_pointer ? issue.what.where : ""};
}

}  // namespace

Result validate(const Source& source, const ValidateOptions& options, ValidationReport& report) {
  return guarded([&]() -> Result {
    report = {};
    Input input;
    MCC_GLTF_TRY(input.open(source));
    Issues issues(options.max_issues == 0 ? std::numeric_limits<size_t>::max()
                                          : options.max_issues);
    validateInput(input, options, issues, report);
    for (const Issue& issue : issues.kept()) report.issues.push_back(publicIssue(issue));
    uint64_t total = 0;
    for (size_t i = 0; i < 4; ++i) {
      report.issue_counts[i] = issues.count(static_cast<Severity>(i));
      total += report.issue_counts[i];
    }
    report.is_truncated = total > report.issues.size();
    return {};
  });
}

Result validateGlb(std::span<const uint8_t> source, const ValidateOptions& options,
                   ValidationReport& report) {
  return validate({{}, source}, options, report);
}

}  // namespace mcc::gltf
