// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// All attributes of a piece but its positions: what they share, and which coder each
// goes through. [A.10]
#ifndef MCC_READER_ATTRIBUTE_STAGE_H_
#define MCC_READER_ATTRIBUTE_STAGE_H_

#include <cstdint>

#include "base/lazy.h"
#include "exact/normals.h"
#include "exact/tails.h"
#include "exact/tangents.h"
#include "format/decodes.h"
#include "format/predictors.h"
#include "surface/equality.h"
#include "surface/wedges.h"
#include "values/attribute_job.h"
#include "values/skin.h"
#include "values/texcoords.h"
#include "values/value_memory.h"
#include "values/values.h"
#include "vectors/normals.h"
#include "vectors/tangent_points.h"
#include "vectors/tangents.h"

namespace mcc {

/// Adaptive models of all attributes of a payload. The encoder's trials copy it. [A.3.6]
struct AttributeModels {
  Lazy<EqualityModels> equalities[8];  ///< [semantic]
  Lazy<NormalModels> normals;
  Lazy<TexcoordModels> texcoords[2];  ///< [further set]
  Lazy<TangentModels> tangents;
  Lazy<TangentPointModels> tangent_points;
  Lazy<SkinModels> skins[2];          ///< [further set]
  Lazy<ValueModels> values[8][2][2];  ///< [semantic][further set][morph target]
  Lazy<VectorModels> exact_normals;
  Lazy<ExactTangentModels> exact_tangents;
  Lazy<TailModels> tails[8][2];  ///< [semantic][morph target]

  Lazy<EqualityModels>& equalitiesOf(const AttributeInfo& a) {
    return equalities[static_cast<uint32_t>(a.format.semantic)];
  }
  Lazy<TailModels>& tailsOf(const AttributeInfo& a) {
    return tails[static_cast<uint32_t>(a.format.semantic)][a.format.morph_target != 0 ? 1 : 0];
  }
  Lazy<ValueModels>& valuesOf(const AttributeInfo& a) {
    return values[static_cast<uint32_t>(a.format.semantic)][a.format.set_index != 0 ? 1 : 0]
                 [a.format.morph_target != 0 ? 1 : 0];
  }

  /// Becomes what `o` is, in memory of `a`. Returns false when memory ran out.
  [[nodiscard]] bool copyFrom(const AttributeModels& o, const Allocator& a) {
    return copyLazy(equalities, o.equalities, a) && copyLazy(normals, o.normals, a) &&
           copyLazy(texcoords, o.texcoords, a) && copyLazy(tangents, o.tangents, a) &&
           copyLazy(tangent_points, o.tangent_points, a) && copyLazy(skins, o.skins, a) &&
           copyLazy(values, o.values, a) && copyLazy(exact_normals, o.exact_normals, a) &&
           copyLazy(exact_tangents, o.exact_tangents, a) && copyLazy(tails, o.tails, a);
  }
};

/// Integers per wedge that an attribute is coded as; JOINTS_n is coded followed by its WEIGHTS_n.
inline uint32_t codedComponents(AttributeInfos attributes, uint32_t index) {
  switch (methodOf(attributes, index)) {
    case AttributeMethod::kNormal:
    case AttributeMethod::kTangent: return 2;
    case AttributeMethod::kTangentPoint: return kTangentPointWords;
    case AttributeMethod::kSkin: return kSkinWords;
    default: return attributes[index].format.component_count;
  }
}

/// The normals that tangents are angles around, for which there are grid points by wedge.
struct TangentNormals {
  const AttributeInfo* info;  ///< null if no tangents are
  const int32_t* points;
};

template <SymbolIo Io>
class AttributeStage {
 public:
  AttributeStage(Io& io, AttributeModels& models, AttributeInfos attributes,
                 const Allocator& allocator)
      : wedges(allocator),
        positions(allocator),
        exact_positions(allocator),
        normals(allocator),
        io_(io),
        models_(models),
        attributes_(attributes),
        allocator_(allocator),
        exact_(allocator),
        normal_(normalOfTangents(attributes)),
        exact_normal_(exactNormalOf(attributes)),
        chart_(chartOfTangents(attributes)),
        groups_(allocator),
        floats_(allocator),
        doubles_(allocator),
        errors_(allocator),
        chart_coordinates_(allocator),
        exact_normals_(allocator),
        unit_normals_(allocator),
        memory_(allocator),
        mates_(allocator),
        lengths_(allocator) {
    for (uint32_t i = 1; i < attributes.size(); ++i) {
      has_tangents_ |= decodes::kTangents && codingPhase(attributes[i]) == 1;
    }
  }

  /// Codes attribute `index` into `values`, codedComponents() per wedge; the encoder gives them.
  Status code(uint32_t index, Array<int32_t>& values);

  /// Keeps what tangents will be predicted from.
  Status keepForOthers(uint32_t index, const Array<int32_t>& values) {
    if (!decodes::kTangents || !has_tangents_) return {};
    if (index == normal_) {
      if (!normals.resize(values.size())) return noMemory();
      std::copy(values.data(), values.data() + values.size(), normals.data());
    }
    if (decodes::kExactFloats && index == exact_normal_) {
      if (!exact_normals_.resize(values.size())) return noMemory();
      std::copy(values.data(), values.data() + values.size(), exact_normals_.data());
    }
    if (index == chart_) {
      if (!chart_coordinates_.resize(values.size())) return noMemory();
      chartCoordinates(attributes_[index], values.data(), values.size(), chart_coordinates_.data());
    }
    return {};
  }

  /// Whether an attribute is predicted from positions that are not rounded.
  bool needsExactPositions() const {
    if (!decodes::kExactFloats) return false;
    for (uint32_t i = 1; i < attributes_.size(); ++i) {
      const AttributeMethod method = methodOf(attributes_, i);
      if (isExactVector(method)) return true;
      if (Io::kEncoding && attributes_[i].coding == AttributeCoding::kGrid) return true;  // perhaps
    }
    return false;
  }

  /// Lists the wedges at the mates of each vertex, unless no attribute asks for them. Borrows
  /// `mates`, of vertices.
  Status findWedgeMates(VertexMates& mates, uint32_t vertex_count) {
    bool asks = Io::kEncoding;  // perhaps
    for (uint32_t i = 1; i < attributes_.size() && !asks; ++i)
      asks = asksMates(methodOf(attributes_, i), attributes_[i].predictor);
    if (asks) return mates_.build(wedges, mates, vertex_count);
    mates.states.reset();
    return {};
  }

  TangentNormals tangentNormals() const {
    return {normal_ == kNone ? nullptr : &normalInfo(), normals.data()};
  }

  WedgeMesh wedges;
  Array<float>
      positions;  ///< 4 per wedge, see wedges.h; only when an attribute is predicted from them
  Array<float> exact_positions;  ///< 3 per wedge, finite; only if needsExactPositions()
  Array<int32_t> normals;        ///< 2 per wedge, only if others are predicted from them

 private:
  using Job = AttributeJob<Io>;

  static Status noMemory() { return fail(Error::kOutOfMemory, "no memory for attributes"); }
  const AttributeInfo& normalInfo() const { return attributes_[normal_]; }

  /// Which of the coded values are on an exact grid; `info` null: none.
  struct GridPart {
    const AttributeInfo* info = nullptr;
    uint32_t first = 0;
    uint32_t count = 0;
    uint32_t stride = 0;
  };
  GridPart gridPart(uint32_t index, AttributeMethod method, uint32_t components) const {
    const bool is_skin = method == AttributeMethod::kSkin;
    const AttributeInfo& info = attributes_[is_skin ? skinPartner(attributes_, index) : index];
    if (!decodes::kExactFloats || info.coding != AttributeCoding::kGrid) return {};
    return {&info, is_skin ? kSkinSlots : 0, info.format.component_count, components};
  }

  /// Encoder: from ordered floats to the integers of their grid.
  Status enterGrid(const GridPart& part, int32_t* values) {
    if constexpr (Io::kEncoding) {
      if (!exact_.resize(size_t{wedges.count} * part.count)) return noMemory();
      for (uint32_t w = 0; w < wedges.count; ++w) {
        int32_t* value = values + size_t{w} * part.stride + part.first;
        for (uint32_t c = 0; c < part.count; ++c) {
          exact_[size_t{w} * part.count + c] = value[c];
          value[c] = gridInteger(*part.info, value[c]);
        }
      }
    }
    return {};
  }

  /// Turns the integers of a grid back into floats, with the bits below the grid's step.
  Status leaveGrid(const GridPart& part, int32_t* values) {
    TailModels* const models = models_.tailsOf(*part.info).get(allocator_);
    if (models == nullptr) return noMemory();
    TailCoder<Io> tails(io_, *models, *part.info, allocator_);
    MCC_TRY(tails.prepare());
    for (uint32_t w = 0; w < wedges.count; ++w) {
      int32_t* value = values + size_t{w} * part.stride + part.first;
      const uint32_t first = groups_.firstOf(w);
      if (first != w) {
        std::copy_n(values + size_t{first} * part.stride + part.first, part.count, value);
        continue;
      }
      for (uint32_t c = 0; c < part.count; ++c) {
        value[c] = tails.code(c, value[c], Io::kEncoding ? exact_[size_t{w} * part.count + c] : 0);
      }
    }
    return {};
  }

  static bool isExactVector(AttributeMethod method) {
    return method == AttributeMethod::kExactNormal || method == AttributeMethod::kExactTangent;
  }

  /// Runs the coder that is made of the job, its models and what else it asks for.
  template <template <class> class Coder, class Models, class... Others>
  Status run(const Job& job, Lazy<Models>& lazy, const Others&... others) {
    Models* const models = lazy.get(allocator_);
    if (models == nullptr) return noMemory();
    Coder<Io>(job, *models, others...).run();
    return {};
  }

  /// Runs the coders that the core of the web decoder lacks.
  Status codeRare(AttributeMethod method, const Job& job) {
    switch (method) {
      case AttributeMethod::kExactNormal: return codeExactNormals(job);
      case AttributeMethod::kExactTangent: return codeExactTangents(job);
      case AttributeMethod::kTangent: return codeTangents(job);
      case AttributeMethod::kTangentPoint: return codeTangentPoints(job);
      default: return {};
    }
  }

  Status codeNormals(const Job& job) {
    if (!floats_.resize(4 * size_t{wedges.count})) return noMemory();
    return run<NormalCoder>(job, models_.normals, matesFor(job), floats_.data());
  }

  Status codeExactNormals(const Job& job) {
    if (!doubles_.resize(3 * size_t{wedges.count}) || !errors_.resize(wedges.count))
      return noMemory();
    const bool remembers = (job.info.predictor & exact_normal_method::kRemembers) != 0;
    ExactNormalMemory memory(memory_);
    if (remembers && !memory.start(wedges.face_count, job.values)) return noMemory();
    return run<ExactNormalCoder>(job, models_.exact_normals, exact_positions.data(),
                                 VectorWork{doubles_.data(), errors_.data()},
                                 remembers ? &memory : nullptr);
  }

  Status codeExactTangents(const Job& job) {
    if (!doubles_.resize(4 * size_t{wedges.count}) || !errors_.resize(wedges.count))
      return noMemory();
    TangentSources from;
    from.positions = exact_positions.data();
    if (chart_ != kNone) from.chart = chart_coordinates_.data();
    if (exact_normal_ != kNone) from.normals = exact_normals_.data();
    return run<ExactTangentCoder>(job, models_.exact_tangents, from,
                                  VectorWork{doubles_.data(), errors_.data()});
  }

  Status codeTexcoords(const Job& job) {
    const bool remembers = (job.info.predictor & texcoord_method::kRemembers) != 0;
    TexcoordMemory memory(memory_);
    if (remembers && !memory.start(wedges.face_count, job.values)) return noMemory();
    return run<TexcoordCoder>(job, models_.texcoords[job.info.format.set_index != 0 ? 1 : 0],
                              matesFor(job), remembers ? &memory : nullptr);
  }

  /// The mates of wedges, null if an attribute does not ask for them or there are none.
  const WedgeMates* matesFor(const Job& job) const {
    return !mates_.empty() && (job.info.predictor & kHasMates) != 0 ? &mates_ : nullptr;
  }

  /// What the chart says about tangents, into floats_: 4 per wedge.
  Status sumFaceTangents() {
    if (!floats_.assign(4 * size_t{wedges.count}, 0.0f)) return noMemory();
    if (chart_ != kNone) {
      addFaceTangents(wedges, positions.data(), chart_coordinates_.data(), floats_.data());
    }
    return {};
  }

  Status codeTangents(const Job& job) {
    MCC_TRY(sumFaceTangents());
    return run<TangentCoder>(job, models_.tangents, normalInfo(), normals.data(), floats_.data());
  }

  Status codeTangentPoints(const Job& job) {
    MCC_TRY(sumFaceTangents());
    const bool projects = hasNormals(attributes_);
    if (projects) MCC_TRY(listNormals());
    return run<TangentPointCoder>(job, models_.tangent_points,
                                  projects ? unit_normals_.data() : nullptr,
                                  normal_ != kNone ? normals.data() : nullptr, floats_.data());
  }

  /// Normals as vectors: what tangents on a grid are perpendicular to.
  Status listNormals() {
    if (!unit_normals_.empty()) return {};
    if (!unit_normals_.resize(3 * size_t{wedges.count})) return noMemory();
    for (size_t w = 0; w < wedges.count; ++w) {
      float* normal = &unit_normals_[3 * w];
      if (exact_normal_ != kNone) {
        for (size_t s = 0; s < 3; ++s)
          normal[s] = static_cast<float>(finiteValue(exact_normals_[3 * w + s]));
      } else {
        octahedralToUnit(normals[2 * w], normals[2 * w + 1], octahedralCentre(normalInfo().bits),
                         normal);
      }
    }
    return {};
  }

  Status codeSkin(const Job& job, uint32_t index) {
    const AttributeInfo& weights = attributes_[skinPartner(attributes_, index)];
    const SkinSums sums = static_cast<SkinSums>(weights.predictor);
    const int32_t sum = sums != SkinSums::kUnknown ? unitSum(weights) : 0;
    return run<SkinCoder>(job, models_.skins[job.info.format.set_index != 0 ? 1 : 0], sum,
                          sums == SkinSums::kUsual);
  }

  Io& io_;
  AttributeModels& models_;
  const AttributeInfos attributes_;
  const Allocator allocator_;
  Array<int32_t> exact_;  ///< encoder: ordered floats of what is on a grid
  const uint32_t normal_;
  const uint32_t exact_normal_;
  const uint32_t chart_;
  bool has_tangents_ = false;
  EqualGroups groups_;
  Array<float> floats_;
  Array<double> doubles_;
  Array<VectorError> errors_;
  Array<float> chart_coordinates_;  ///< 2 per wedge, only with tangents
  Array<int32_t> exact_normals_;    ///< 3 ordered floats per wedge, only with tangents
  Array<float> unit_normals_;       ///< 3 per wedge, see listNormals()
  Array<MemoryEntry> memory_;
  WedgeMates mates_;
  Array<uint8_t> lengths_;
};

template <SymbolIo Io>
Status AttributeStage<Io>::code(uint32_t index, Array<int32_t>& values) {
  const AttributeInfo& info = attributes_[index];
  const AttributeMethod method = methodOf(attributes_, index);
  if (isWithAnother(method)) return {};
  const uint32_t components = codedComponents(attributes_, index);
  if (!values.resize(size_t{wedges.count} * components) || !lengths_.resize(wedges.count)) {
    return noMemory();
  }
  groups_.clear();
  if ((info.predictor & kHasEqualities) != 0 && wedges.hasSeams()) {
    EqualityModels* const models = models_.equalitiesOf(info).get(allocator_);
    if (models == nullptr) return noMemory();
    MCC_TRY(EqualityCoder<Io>(io_, *models, wedges, values.data(), components).run(groups_));
  }
  const GridPart grid = gridPart(index, method, components);
  if (decodes::kExactFloats && grid.info != nullptr) MCC_TRY(enterGrid(grid, values.data()));
  // Exact vectors are coded for all wedges even in trials.
  const uint32_t end = isExactVector(method) ? wedges.count : wedges.coded_count;
  const Job job{io_, info, wedges, groups_, positions.data(), values.data(), lengths_.data(), end};
  switch (method) {
    case AttributeMethod::kNormal: MCC_TRY(codeNormals(job)); break;
    case AttributeMethod::kTexcoord: MCC_TRY(codeTexcoords(job)); break;
    case AttributeMethod::kSkin: MCC_TRY(codeSkin(job, index)); break;
    case AttributeMethod::kValues: MCC_TRY(run<ValueCoder>(job, models_.valuesOf(info))); break;
    default:
      if (decodes::kExactFloats || decodes::kTangents) MCC_TRY(codeRare(method, job));
      break;
  }
  if (decodes::kExactFloats && grid.info != nullptr) MCC_TRY(leaveGrid(grid, values.data()));
  if (io_.overrun()) return fail(Error::kTruncated, "the token stream ends inside an attribute");
  return keepForOthers(index, values);
}

}  // namespace mcc

#endif  // MCC_READER_ATTRIBUTE_STAGE_H_
