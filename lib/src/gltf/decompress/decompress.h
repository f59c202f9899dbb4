// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Decodes the payloads of a document: what they hold gets its place in a buffer first, and is then
// decoded there.
#ifndef MCC_GLTF_DECOMPRESS_DECOMPRESS_H_
#define MCC_GLTF_DECOMPRESS_DECOMPRESS_H_

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <span>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "gltf/decompress/integers.h"
#include "gltf/document/extension_uses.h"
#include "gltf/document/layout.h"
#include "host/parallel.h"
#include "json/json.h"
#include "mcc/glb.h"
#include "mcc/reader.h"

namespace mcc::gltf {

struct DecodedPiece {
  std::vector<std::vector<uint8_t>> attributes;  ///< packed elements in decoded order
  std::vector<std::vector<uint32_t>> parts;      ///< three wedges per triangle
};

/// A payload and everything decoded from it.
struct DecodedPayload {
  Payload payload;
  std::vector<DecodedPiece> pieces;
};

/// Returns the bytes of all attributes of an opened payload, and of all its indices with 32 bits
/// each.
uint64_t outputBytes(const PayloadInfo& info);

/// Decodes all pieces of an opened payload.
Status decodePieces(DecodedPayload& decoded, const mcc::DecodeOptions& options = {});

/// Opens a payload and decodes all of it. `bytes` must outlive `decoded`.
Result decodePayload(std::span<const uint8_t> bytes, const std::string& where,
                     DecodedPayload& decoded, const RunJobs& run_jobs = {});

/// All payloads of a document, and the buffer views that their elements become. Previews are
/// decoded like the rest, since one that is damaged is an error, but fill no view.
class PayloadDecoder {
 public:
  /// An accessor that a payload fills.
  struct Filled {
    uint32_t accessor = 0;
    size_t view = 0;  ///< index into views()
  };
  /// Whether accessors of the same elements share a view.
  enum class Views : uint8_t { kShared, kOfEachAccessor };

  /// The document must outlive the object.
  PayloadDecoder(const Document& document, Views views)
      : document_(document), are_shared_(views == Views::kShared) {}

  /// Opens the payloads and checks their headers, how accessors use them, and how much they decode
  /// to, before memory is taken for that. Errors carry JSON paths. Safe for untrusted documents.
  Result open();

  /// Decodes all payloads, several at a time; the result does not depend on it.
  /// place  returns where a view goes, or null where it is not wanted. Called on any thread.
  using Place = std::function<uint8_t*(size_t view)>;
  Result decode(uint32_t thread_count, const Place& place) const;

  // What open() found, apart from previews, of which only the bytes count.
  struct Counts {
    uint64_t payloads = 0;  ///< distinct ones
    uint64_t triangles = 0;
    uint64_t wedges = 0;
    uint64_t bytes = 0;  ///< see outputBytes()
  };
  const Counts& counts() const { return counts_; }
  const std::vector<ExtensionUse>& uses() const { return uses_; }
  const std::vector<Filled>& filled() const { return filled_; }
  /// Sizes, strides and targets of the views. They hold nothing.
  std::vector<NewView> takeViews() { return std::move(views_); }
  /// How the attributes are coded, by accessor.
  const CodedAttributes& codings() const { return codings_; }

 private:
  struct OpenPayload {
    Payload payload;
    std::string where;
  };
  /// Where elements come from: payload, piece, whether it is a part, its number.
  using Origin = std::tuple<size_t, uint64_t, bool, uint64_t>;
  class Run;

  Result openPayload(const PayloadUse& use);
  void addAttribute(size_t payload, const ExtensionUse& use,
                    const ExtensionUse::AttributeUse& attribute);
  void addTarget(const Origin& origin, uint32_t accessor);

  const Document& document_;
  const bool are_shared_;
  std::vector<ExtensionUse> uses_;
  std::vector<OpenPayload> payloads_;
  std::vector<Filled> filled_;
  std::vector<NewView> views_;
  CodedAttributes codings_;
  std::set<uint32_t> known_;  ///< accessors that are in `filled_`
  /// The views that get the elements, each with an accessor that reads it.
  std::map<Origin, std::vector<Filled>> targets_;
  /// The first view that has them in a component type and a number of columns.
  std::map<std::tuple<Origin, ComponentType, uint32_t>, size_t> view_of_;
  uint64_t copied_bytes_ = 0;  ///< of views that repeat others
  Counts counts_;
};

/// A document without payloads. Its buffer is laid out but not filled.
struct Decompressed {
  Json json;
  Layout layout;
  std::vector<NewView> views;
  std::unique_ptr<PayloadDecoder> decoder;  ///< without payloads, only this is set
  bool are_filled = false;                  ///< the views hold their elements already
  std::vector<std::string> notes;

  /// Stores all bytes of the buffer, which has zeros. The document must still exist.
  Result fill(uint32_t thread_count, std::span<uint8_t> buffer) const;
};

/// Replaces all payloads by ordinary accessors and removes the extension from the document.
/// Attributes become integers if options.decode_to says so; `notes` names what stays float. Errors
/// carry JSON paths. It is an error when document.decoded is above its limit, which is checked
/// before memory is taken. Safe for untrusted documents.
Result decompressDocument(const Document& document, const DecodeOptions& options,
                          Decompressed& decompressed);

/// Adds another buffer, the last one, to a compressed document. The extension is no longer
/// required. The caller names the buffer.
/// bin       the bytes of the first buffer.
/// fallback  receives the bytes of the new one, made from the decoded payloads.
Result addFallback(const std::vector<uint8_t>& bin, Json& json, std::vector<uint8_t>& fallback);

}  // namespace mcc::gltf

#endif  // MCC_GLTF_DECOMPRESS_DECOMPRESS_H_
