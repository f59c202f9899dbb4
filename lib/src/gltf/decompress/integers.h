// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Stores the quantised attributes of decoded documents as integers, with KHR_mesh_quantization.
#ifndef MCC_GLTF_DECOMPRESS_INTEGERS_H_
#define MCC_GLTF_DECOMPRESS_INTEGERS_H_

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "gltf/document/layout.h"
#include "mcc/reader.h"

namespace mcc::gltf {

/// How each decoded accessor was coded, by accessor number. Contains no aliases.
using CodedAttributes = std::map<uint32_t, AttributeInfo>;

/// Turns decoded float accessors into integers where every value keeps its place, up to the
/// rounding of the coded grid. Positions become lattice points. The lattice goes into new nodes
/// that take over the meshes of their parents, or into the inverse bind matrices of skins. What
/// cannot become integer stays float, with a note.
/// json and views are those of layOut().
void storeIntegers(const Document& source, const CodedAttributes& coded, Json& json,
                   std::vector<NewView>& views, std::vector<std::string>& notes);

}  // namespace mcc::gltf

#endif  // MCC_GLTF_DECOMPRESS_INTEGERS_H_
