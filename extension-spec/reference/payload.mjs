// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

// A payload from its first byte to its last, in the order of decoding [A.2.7].

import { allGridModels, attributeModels, decodeAttributes } from './attributes.mjs';
import { gluePieces } from './blocks.mjs';
import { elementsOf } from './components.mjs';
import { connectivityModels, decodeConnectivity } from './connectivity.mjs';
import { arrayOf, checkEnds, createCoder } from './entropy.mjs';
import { failUnless } from './errors.mjs';
import { sequenceWithoutPositions, umbrellasOfPivots } from './order.mjs';
import { decodeTriangleOrder, decodeWedgeOrder, orderModels, partsOfTable } from './orders.mjs';
import { decodePivots, pivotModels } from './pivots.mjs';
import { decodePositions, positionModels } from './positions.mjs';
import { creasesOf, decodeSeams, seamModels } from './seams.mjs';
import { seenPositions } from './seenpositions.mjs';
import { startTrained } from './starts.mjs';
import { decodeStitching, stitchModels } from './stitch.mjs';
import { decodeTriangles, indicesOf, triangleModels } from './triangles.mjs';
import { createWedges } from './wedges.mjs';

// [A.3.6] All models of a payload, and what else it has one of.
const createModels = () => ({
	connectivity: connectivityModels(), pivots: pivotModels(), stitch: stitchModels(), positions: positionModels(),
	grids: allGridModels(), seams: seamModels(), triangles: triangleModels(), orders: orderModels(),
	attributes: attributeModels(),
});

// The pieces of a payload with this header; one with blocks has one piece. A piece has a list of indices for each part,
// and the function elements(i), which yields the bytes of attribute i.
export const decodePayload = (header) => (header.BLOCKS ? [decodeBlocks(header)] : decodePieces(header));
function decodePieces(header) {
	const coder = createCoder(header.streams), models = createModels();
	if (header.TRAINED) startTrained(models);
	const decoded = header.pieces.map((piece) => decodePiece(coder, models, piece));
	checkEnds(coder);
	return decoded.map(resultOf);
}

// [A.11.2] All blocks but the first begin with a copy of the models that the first has left.
function decodeBlocks({ pieces, blocks }) {
	const learnt = createModels();
	const decoded = pieces.map((piece, i) => {
		const coder = createCoder(blocks[i].streams);
		const block = decodePiece(coder, i === 0 ? learnt : structuredClone(learnt), piece);
		checkEnds(coder);
		return block;
	});
	return gluePieces(decoded, blocks);
}

// [A.2.7] The stages of a piece.
function decodePiece(coder, models, piece) {
	const surface = piece.PIVOTS
		? decodePivots(coder, models.pivots, piece) : decodeConnectivity(coder, models.connectivity, piece);
	const groups = groupsOf(coder, models, piece, surface);
	const { q, sequence, mates } = positionsOf(coder, models, piece, surface, groups);
	const crease = creasesOf(piece, surface, piece.CREASES ? seenPositions(piece.attributes[0], q) : []);
	const { starts, groupOf } = seamsOf(coder, models, piece, surface, groups, sequence, crease);
	const table = decodeTriangles(coder, models.triangles, piece, surface);
	const { parts, wedgeOrder } = ordersOf(coder, models.orders, piece, surface, table);
	let values = [];
	if (piece.attributes.length !== 0) {
		const wedges = createWedges(piece, surface, starts, groupOf, mates);
		const recordOf = (w) => (w < piece.surface_wedges ? groupOf[w] : groups.count + w - piece.surface_wedges);
		values = decodeAttributes(coder, models, piece, wedges, q, recordOf, crease);
	}
	return { piece, surface, table, parts, wedgeOrder, values };
}

// The number of groups, and the umbrellas of each if it may have several.
function groupsOf(coder, models, piece, surface) {
	if (piece.COPIES) return decodeStitching(coder, models.stitch, piece, surface);
	return piece.PIVOTS ? umbrellasOfPivots(surface, piece.vertex_count) : { count: piece.vertex_count };
}

// Without attributes there are no positions, and without seams nobody needs the sequence then.
function positionsOf(coder, models, piece, surface, groups) {
	if (piece.attributes.length !== 0) {
		return decodePositions(coder, models.positions, models.grids.position, piece, surface, groups);
	}
	return { q: [], sequence: piece.SEAMS ? sequenceWithoutPositions(surface, groups.count) : [] };
}

// The start and the group of each wedge. Corners hold wedges afterwards.
function seamsOf(coder, models, piece, surface, groups, sequence, crease) {
	if (!piece.SEAMS) {
		const alike = groups.count === piece.surface_wedges;
		failUnless(alike, 'BadAttribute', 'A.2.7', 'without seams there are as many wedges as groups');
		return { starts: sequence, groupOf: arrayOf(groups.count, (g) => g) };
	}
	const { wedgeOf, starts, groupOf } = decodeSeams(coder, models.seams, piece, surface, groups, sequence, crease);
	surface.tail = wedgeOf;
	return { starts, groupOf };
}

// [A.9]
function ordersOf(coder, models, piece, surface, table) {
	let parts = partsOfTable(piece, table);
	if (piece.TRIANGLE_ORDER) parts = decodeTriangleOrder(coder, models.triangles, piece, surface, parts);
	const wedgeOrder = piece.VERTEX_ORDER
		? decodeWedgeOrder(coder, models.wedges, piece, table, parts) : arrayOf(piece.wedge_count, (w) => w);
	return { parts, wedgeOrder };
}

// [A.9.4] What a loader gets.
function resultOf({ piece, table, parts, wedgeOrder, values }) {
	const placeOf = new Uint32Array(piece.wedge_count);
	wedgeOrder.forEach((w, i) => { placeOf[w] = i; });
	return {
		indices: (part) => indicesOf(table, parts[part]).map((w) => placeOf[w]),
		elements: (i) => elementsOf(piece, piece.attributes[i], values, wedgeOrder),
	};
}
