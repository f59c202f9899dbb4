// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

// From integers to components: A.10.18 of the specification.

import { bitsOfFloat } from './bytes.mjs';
import { latticeFloat } from './faces.mjs';
import { bitsOfOrdered } from './floats.mjs';
import { BYTES_OF_TYPE, INTEGER, LATTICE, OCTAHEDRAL, TANGENT, TANGENT_ANGLE } from './names.mjs';
import { centreOf, unitVector } from './octahedral.mjs';
import { vectorOfAngle } from './tangents.mjs';

// The elements of an attribute by wedge, each the bytes of its components. normals: the unit vectors of the octahedral normal.
export function elementsOf(state, normals) {
	const size = BYTES_OF_TYPE[state.attribute.type];
	return Array.from({ length: state.wedges.count }, (_, w) => bytesOf(componentBits(state, w, normals), size));
}

function bytesOf(bits, size) {
	return Uint8Array.from({ length: bits.length * size }, (_, i) => (bits[Math.floor(i / size)] >>> (8 * (i % size))) & 255);
}

// The bits of the components at a wedge.
function componentBits(state, w, normals) {
	const { attribute } = state;
	const value = [...state.value(w)];
	switch (attribute.coding) {
	case INTEGER: return value;
	case LATTICE:
	case OCTAHEDRAL:
	case TANGENT_ANGLE: return vectorOf(state, w, normals).map(bitsOfFloat);
	default: return value.map(bitsOfOrdered);
	}
}

// The floats at a wedge, of the codings that compute them.
export function vectorOf(state, w, normals) {
	const { attribute } = state;
	const value = state.value(w);
	if (attribute.coding === LATTICE) return [...value].map((q, c) => latticeFloat(attribute, q, c));
	const sign = attribute.semantic === TANGENT ? [state.negative[w] ? -1 : 1] : [];
	if (attribute.coding === OCTAHEDRAL) return [...unitVector(centreOf(attribute.bits), value), ...sign];
	return [...vectorOfAngle(attribute.bits, value[0], normals[w]), ...sign];
}
