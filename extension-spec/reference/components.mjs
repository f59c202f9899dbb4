// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

// From integers to components [A.10.18].

import { ALIAS, INTEGER, LATTICE, OCTAHEDRAL, TANGENT_ANGLE, bytesOfComponent } from './attributeheader.mjs';
import { vectorOfAngle } from './directions.mjs';
import { bitsOfFloat, bitsOfOrdered } from './floats.mjs';
import { centreOf, unitVector } from './octahedral.mjs';
import { latticeCoordinate } from './seenpositions.mjs';

// [A.10.18] The function that yields the bits of the components of a wedge; values[i] are those of attribute i.
function componentsOf(piece, attribute, values) {
	const own = values[attribute.number];
	switch (attribute.coding) {
		case LATTICE:
			return (w) => own[w].map((q, c) => bitsOfFloat(latticeCoordinate(attribute, q, c)));
		case INTEGER:
			return (w) => own[w];
		case OCTAHEDRAL:
			return (w) => withSign(unitVector(centreOf(attribute.bits), own[w]), own[w][2]).map(bitsOfFloat);
		case TANGENT_ANGLE:
			return (w) => {
				const vector = vectorOfAngle(own[w][0], attribute.bits, normalOf(piece, values, w));
				return withSign(vector, own[w][1]).map(bitsOfFloat);
			};
		case ALIAS:
			return componentsOf(piece, piece.attributes[attribute.alias], values);
		default:
			return (w) => own[w].map(bitsOfOrdered);
	}
}

// Normals have no sign.
const withSign = (vector, sign) => (sign === undefined ? vector : [...vector, sign]);
const normalOf = ({ octahedralNormal }, values, w) =>
	unitVector(centreOf(octahedralNormal.bits), values[octahedralNormal.number][w]);

// [A.9.4] The elements of an attribute without gaps, little-endian; the i-th is that of the wedge wedgeOrder[i].
export function elementsOf(piece, attribute, values, wedgeOrder) {
	const size = bytesOfComponent(attribute), components = componentsOf(piece, attribute, values);
	const bytes = new Uint8Array(wedgeOrder.length * attribute.components * size);
	let offset = 0;
	for (const w of wedgeOrder) {
		for (const bits of components(w)) for (let k = 0; k < size; ++k) bytes[offset++] = bits >>> (8 * k);
	}
	return bytes;
}
