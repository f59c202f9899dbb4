// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

// Attribute names and types [README, Attribute names and types].

import { crc32 } from './bytes.mjs';

export const EXTENSION = 'KHR_mesh_collapse_compression';
const FLOAT = 5126;
const ANY = () => true;

// The rows of the table; `numbered` names end in _n.
const ROWS = [
	{ name: 'POSITION', numbered: false, types: ['VEC3'], fits: ANY },
	{ name: 'NORMAL', numbered: false, types: ['VEC3'], fits: ANY },
	{ name: 'TANGENT', numbered: false, types: ['VEC3', 'VEC4'], fits: ANY },
	{ name: 'TEXCOORD', numbered: true, types: ['VEC2'], fits: ANY },
	{ name: 'COLOR', numbered: true, types: ['VEC3', 'VEC4'], fits: ANY },
	{ name: 'JOINTS', numbered: true, types: ['VEC4'], fits: (componentType) => componentType !== FLOAT },
	{ name: 'WEIGHTS', numbered: true, types: ['VEC4'], fits: ANY },
];
const CUSTOM = 7;

// The number n of a name, 0 for names without one, or undefined if the name is not that of the row.
function setOf(row, name) {
	if (!row.numbered) return name === row.name ? 0 : undefined;
	const match = new RegExp(`^${row.name}_(0|[1-9][0-9]{0,2})$`).exec(name);
	return match !== null && Number(match[1]) <= 255 ? Number(match[1]) : undefined;
}

export function semanticOf(name, { type, componentType }) {
	for (const [semantic, row] of ROWS.entries()) {
		const set = setOf(row, name);
		if (set !== undefined && row.types.includes(type) && row.fits(componentType)) return { semantic, set };
	}
	return { semantic: CUSTOM, set: crc32(new TextEncoder().encode(name)) % 256 };
}
