// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

// The attributes of a piece but the position [A.10], in the order of A.10.1.

import { ALIAS, GRID, TANGENT, TEXCOORD } from './attributeheader.mjs';
import { chartCoordinates, sumsOfFaceTangents } from './directions.mjs';
import { arrayOf } from './entropy.mjs';
import { decodeExactNormals, exactNormalModels } from './exactnormals.mjs';
import { decodeExactTangents, exactTangentModels } from './exacttangents.mjs';
import { gridModels, readTails } from './grids.mjs';
import { decodeNormals, normalModels } from './normals.mjs';
import { exactPositions, seenPositions } from './seenpositions.mjs';
import { decodeSkin, skinModels } from './skins.mjs';
import {
	decodeTangentAngles, decodeTangentPoints, normalPoints, normalsBeside, tangentModels, tangentPointModels, unitNormals,
} from './tangents.mjs';
import { decodeTexcoords, texcoordModels } from './texcoords.mjs';
import { decodeValues, valuesModels } from './values.mjs';
import { createCoding, equalityModels, readEqualities, singleBundles } from './wedges.mjs';

const EQUALITIES = 128;
export const attributeModels = () => ({
	equalities: arrayOf(8, equalityModels), values: arrayOf(8, () => arrayOf(2, () => arrayOf(2, valuesModels))),
	normals: normalModels(), texcoords: arrayOf(2, texcoordModels), tangents: tangentModels(),
	tangentPoints: tangentPointModels(), skins: arrayOf(2, skinModels), exactNormals: exactNormalModels(),
	exactTangents: exactTangentModels(),
});

// [A.10.5] By semantic and by whether it is a morph target; attribute 0 has its own.
export const allGridModels = () => ({ position: gridModels(), others: arrayOf(8, () => arrayOf(2, gridModels)) });

// [A.10] The values of all attributes, by number and wedge; aliases have none. recordOf(w) is the number of the
// position of a wedge among q.
export function decodeAttributes(coder, models, piece, wedges, q, recordOf, crease) {
	const perWedge = (records) => arrayOf(piece.wedge_count, (w) => records[recordOf(w)]);
	const a = {
		coder, models: models.attributes, gridModels: models.grids.others, piece, wedges, crease, values: [perWedge(q)],
		positions: perWedge(seenPositions(piece.attributes[0], q)),
		// Only exact methods need them.
		exactPositions: () => perWedge(exactPositions(piece.attributes[0], q)),
	};
	const isBaseTangent = ({ semantic, target }) => semantic === TANGENT && target === 0;
	const others = piece.attributes.slice(1);
	for (const attribute of others) if (!isBaseTangent(attribute)) decodeAttribute(a, attribute);
	for (const attribute of others) if (isBaseTangent(attribute)) decodeAttribute(a, attribute);
	return a.values;
}

// [A.10.1] The three steps of an attribute. The weights of a skin are read with its joints.
function decodeAttribute(a, attribute) {
	if (attribute.method === 'alias' || attribute.method === 'skin weights') return;
	const equalities = (attribute.predictor & EQUALITIES) !== 0 && a.piece.SEAMS;
	const models = a.models.equalities[attribute.semantic];
	const bundles = equalities ? readEqualities(a.coder, models, a.wedges, a.crease) : singleBundles(a.wedges);
	const coding = createCoding(a.coder, a.wedges, bundles);
	readValues(a, coding, attribute);
	a.values[attribute.number] = coding.values;
	if (attribute.method === 'skin') {
		const weights = a.piece.attributes[attribute.partner];
		a.values[attribute.number] = coding.values.map((tuple) => tuple.slice(0, 4));
		a.values[weights.number] = coding.values.map((tuple) => tuple.slice(4));
		readBelow(a, weights, bundles);
	}
	readBelow(a, attribute, bundles);
}

function readValues(a, coding, attribute) {
	const { models, piece } = a;
	const set = attribute.set === 0 ? 0 : 1, isTarget = attribute.target === 0 ? 0 : 1;
	const valuesOf = ({ number }) => a.values[number];
	const sums = () => sumsOfFaceTangents(a.wedges, a.positions, chartOf(a));
	switch (attribute.method) {
		case 'normal':
			return decodeNormals(coding, models.normals, attribute, a.positions);
		case 'tangent':
			return decodeTangentAngles(
				coding, models.tangents, attribute, sums(), unitNormals(piece, valuesOf), normalPoints(piece, valuesOf),
			);
		case 'tangent point':
			return decodeTangentPoints(
				coding, models.tangentPoints, attribute, sums(), normalsBeside(piece, valuesOf),
				normalPoints(piece, valuesOf), a.positions,
			);
		case 'skin':
			return decodeSkin(coding, models.skins[set], piece.attributes[attribute.partner]);
		case 'texture coordinate':
			return decodeTexcoords(coding, models.texcoords[set], attribute, a.positions);
		case 'exact normal':
			return decodeExactNormals(coding, models.exactNormals, attribute, a.exactPositions());
		case 'exact tangent': {
			const normal = piece.exactNormal === undefined ? undefined : (w) => valuesOf(piece.exactNormal)[w];
			return decodeExactTangents(coding, models.exactTangents, attribute, a.exactPositions(), chartOf(a), normal);
		}
		default:
			return decodeValues(coding, models.values[attribute.semantic][set][isTarget], attribute, a.positions);
	}
}

// [A.10.1] The coordinates of the chart, undefined if there is none.
function chartOf({ piece, values }) {
	const fits = ({ semantic, target, components, coding }) =>
		semantic === TEXCOORD && target === 0 && components === 2 && coding !== ALIAS;
	const chart = piece.attributes.slice(1).find(fits);
	return chart === undefined ? undefined : chartCoordinates(chart, values[chart.number]);
}

// [A.10.5] Wedges that are not the first of their bundle get the floats of the first.
function readBelow(a, attribute, bundles) {
	if (attribute.coding !== GRID) return;
	const values = a.values[attribute.number];
	const models = a.gridModels[attribute.semantic][attribute.target === 0 ? 0 : 1];
	readTails(a.coder, models, attribute, values.map((value, w) => (bundles[w][0] === w ? value : undefined)));
	bundles.forEach((members, w) => { values[w] = values[members[0]]; });
}
