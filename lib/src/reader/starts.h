// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Models that begin as if they had seen outcomes already: those that most assets have.     [A.3.9]
#ifndef MCC_READER_STARTS_H_
#define MCC_READER_STARTS_H_

#include <cstdint>

#include "base/host.h"
#include "reader/piece.h"

namespace mcc {

/// What binary models have seen, in the order of their arrays: '.' stands for nothing, a letter for
/// one of these, with and without their bits inverted: 0, 000, 0000000, 10, 1000.
inline constexpr char kRunStarts[] =
    "..e.chibgdbdjdb...................e.c.ijgjjbjfb.d.................e.e.a.i.g.j.d.b........."
    "........e.e.i.h.g.gf";
inline constexpr char kGapStarts[] = "fffddjjjjhi.c";
inline constexpr char kHasSeamStarts[] = "..bdce.ddbffdffffffff.ffffff";
inline constexpr char kSeamEdgeStarts[] =
    "a.dfa.dfagbfa....hbf....eec.e...eee.e...eee.....dfffffffddffb.ffbbff";
inline constexpr char kEqualityStarts[] = ".b.a...ab..ab...........fffdbddbf.ddaeeeaeeeabee";

/// What rows have seen: each token is a letter, "a" stands for 0, and commas stand between rows.
inline constexpr char kTexcoordStarts[] =
    "a,ab,a,a,a,a,ae,agfdheab,aigdhfae,ahifg,ai,a,aa,aba,aaa,aa,a,aiagkj,ai,ajikhga,aiaghjak,aj"
    ",aa,j";
inline constexpr char kNormalStarts[] =
    "aaaaaaaa,abacaaa,abhgecad,hiadbc,haicjb,ihakj,a,,,,a,aaabcaaa,aaaaaaab,acaabaaa,abhgdecf,a"
    "ihfecab,hjibdahk,ahij,i";

MCC_ONCE inline void showOutcomes(const char* seen, BitModel* model) {
  for (; *seen != 0; ++seen, ++model) {
    if (*seen == '.') continue;
    const uint32_t letter = static_cast<uint32_t>(*seen - 'a');
    const bool outcome = (letter & 1) != 0;
    const uint32_t which = letter >> 1;
    if (which >= 3) model->update(!outcome);
    for (uint32_t n = (2u << which % 3) - 1; n != 0; --n) model->update(outcome);
  }
}

MCC_ONCE inline void showTokens(const char* seen, TokenRow* row) {
  for (; *seen != 0; ++seen) {
    if (*seen == ',') {
      ++row;
    } else {
      row->adapt(static_cast<uint32_t>(*seen - 'a'), kAttributeSchedule);
    }
  }
}

/// Prepares new models for the first symbol of a payload whose models start trained. Returns false
/// when memory ran out.
[[nodiscard]] MCC_ONCE inline bool startTrained(PayloadModels& models, bool has_attributes,
                                                const Allocator& allocator) {
  showOutcomes(kRunStarts, models.mc.run);
  showOutcomes(kGapStarts, models.positions.tables.palettes.gap.length);
  showOutcomes(kHasSeamStarts, models.seams.has_seam[0][0]);
  showOutcomes(kSeamEdgeStarts, models.seams.edge[0][0][0]);
  if (!has_attributes) return true;
  AttributeModels& of = models.attributes;
  for (const Semantic semantic : {Semantic::kNormal, Semantic::kTexcoord}) {
    EqualityModels* const equal = of.equalities[static_cast<uint32_t>(semantic)].get(allocator);
    if (equal == nullptr) return false;
    showOutcomes(kEqualityStarts, equal->previous[0][0]);
  }
  NormalModels* const normals = of.normals.get(allocator);
  TexcoordModels* const texcoords = of.texcoords[0].get(allocator);
  if (normals == nullptr || texcoords == nullptr) return false;
  showTokens(kNormalStarts, normals->row[0]);
  showTokens(kTexcoordStarts, texcoords->row[0]);
  return true;
}

}  // namespace mcc

#endif  // MCC_READER_STARTS_H_
