// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

// Numbers that have names in the specification.

// [A.2.4] Component types
export const COMPONENT_TYPES = [5120, 5121, 5122, 5123, 5125, 5126]; // as glTF numbers them
export const FLOAT = 5;

export const BYTES_OF_TYPE = [1, 1, 2, 2, 4, 4];

// [A.2.4] Codings
export const LATTICE = 0, INTEGER = 1, EXACT_FLOAT = 2, OCTAHEDRAL = 3, TANGENT_ANGLE = 4, ALIAS = 5, GRID = 6;

// Semantics ("Attribute names and types")
export const POSITION = 0, NORMAL = 1, TANGENT = 2, TEXCOORD = 3, COLOR = 4, JOINTS = 5, WEIGHTS = 6, CUSTOM = 7;
