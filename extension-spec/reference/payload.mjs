// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

// A payload and its stages: A.2.7 of the specification.

import { AttributeModels, decodeAttributes } from './attributes.mjs';
import { copyOf, Glue, gluedHeader } from './blocks.mjs';
import { fail } from './bytes.mjs';
import { ConnectivityModels, decodeConnectivity } from './connectivity.mjs';
import { predictionPositions } from './faces.mjs';
import { readHeader } from './header.mjs';
import { checkParts, decodeTriangleOrder, decodeWedgeOrder, OrderModels, trianglesOfParts } from './orders.mjs';
import { decodePivots, PivotModels } from './pivots.mjs';
import { decodePositions, PositionModels } from './positions.mjs';
import { orderOfFirstCorners } from './region.mjs';
import { decodeSeams, findCreases, SeamModels } from './seams.mjs';
import { stitch, StitchModels } from './stitch.mjs';
import { decodeTriangles, TriangleModels } from './triangles.mjs';

// [A.3.6] All models exist once per payload.
class Models {
	constructor() {
		this.connectivity = new ConnectivityModels();
		this.pivots = new PivotModels();
		this.stitching = new StitchModels();
		this.positions = new PositionModels();
		this.seams = new SeamModels();
		this.triangles = new TriangleModels();
		this.orders = new OrderModels();
		this.attributes = new AttributeModels();
	}
}

// A payload whose header was read and checked: pieces, the headers of its pieces; decode() decodes them.
export class Payload {
	constructor(bytes) {
		const { header, streams } = readHeader(bytes);
		this.blocks = header.blocks;
		this.pieces = header.hasBlocks ? [gluedHeader(header.blocks)] : header.pieces;
		this.streams = streams;
	}

	// The pieces, each with: parts, lists of triangles, which are three places of wedges; elements, a list for each attribute of
	// the bytes of the components of each element.
	decode() {
		const models = new Models();
		if (this.blocks !== undefined) return [this.decodeBlocks(models)];
		const pieces = this.pieces.map((piece) => {
			const { parts, elements } = decodePiece(this.streams, models, piece);
			return { parts, elements };
		});
		this.streams.finish();
		return pieces;
	}

	// [A.11.2] All blocks but the first begin with the models that the first leaves.
	decodeBlocks(models) {
		const glue = new Glue(this.pieces[0]);
		for (const block of this.blocks) {
			const decoded = decodePiece(block.streams, block === this.blocks[0] ? models : copyOf(models), block.piece);
			block.streams.finish();
			glue.add(block, decoded);
		}
		return { parts: glue.parts, elements: glue.elements };
	}
}

// [A.2.7] The stages of a piece; besides parts and elements what blocks need: the surface and the integers of its wedges
function decodePiece(streams, models, piece) {
	const groups = surfaceStages(streams, models, piece);
	const groupCount = groups.umbrellas?.length ?? piece.vertexCount;
	const positions = positionStage(streams, models, piece, groups, groupCount);
	const wedges = piece.flags.SEAMS
		? seamStage(streams, models, piece, groups, positions)
		: groupsAsWedges(piece, groups.surface, positions.sequence, groupCount);
	const triangles = decodeTriangles(streams, models.triangles, piece, wedges.surface);
	const { parts, order } = orderStage(streams, models.orders, piece, wedges.surface, triangles);
	const { elements, integersOf } = decodeAttributes(streams, models.attributes, { piece, groupCount, wedges, positions });
	return {
		parts: placed(parts, order),
		elements: elements.map((list) => reordered(list, order)),
		surface: wedges.surface,
		integersOf,
	};
}

// [A.4], [A.5]: the surface with groups at its corners; with pivots all half-edges that leave each, with copies the umbrellas.
function surfaceStages(streams, models, piece) {
	if (piece.flags.PIVOTS) return decodePivots(streams, models.pivots, piece);
	const surface = decodeConnectivity(streams, models.connectivity, piece);
	return piece.flags.COPIES ? stitch(streams, models.stitching, piece, surface) : { surface };
}

// [A.6]
function positionStage(streams, models, piece, groups, groupCount) {
	const { surface } = groups;
	if (piece.attributes.length === 0) return { sequence: orderOfFirstCorners(surface, groupCount) };
	const result = decodePositions(streams, models.positions, piece, groups, groupCount);
	return { ...result, seen: predictionPositions(piece.attributes[0], result.positions) };
}

// [A.7]
function seamStage(streams, models, piece, { surface, umbrellas, corners }, { sequence, seen }) {
	const crease = piece.flags.CREASES ? findCreases(surface, seen) : new Uint8Array(surface.halfEdgeCount);
	const result = decodeSeams(streams, models.seams, piece, surface, umbrellas ?? corners, sequence, crease);
	return { ...result, crease };
}

// [A.2.7] Without seams wedge g is group g.
function groupsAsWedges(piece, surface, sequence, groupCount) {
	if (groupCount !== piece.wedgeCount - piece.isolatedCount) fail('BadAttribute', 'A.2.7', 'groups and wedges differ in number');
	const starts = new Int32Array(groupCount);
	for (const h of sequence) starts[surface.tail(h)] = h;
	return { surface, starts, groupOf: Int32Array.from({ length: groupCount }, (_, g) => g) };
}

// [A.9]
function orderStage(streams, models, piece, surface, triangles) {
	const { TRIANGLE_ORDER, VERTEX_ORDER } = piece.flags;
	const parts = trianglesOfParts(piece, triangles);
	checkParts(piece, parts);
	const ordered = TRIANGLE_ORDER ? decodeTriangleOrder(streams, models, piece, surface, triangles) : undefined;
	const order = VERTEX_ORDER ? decodeWedgeOrder(streams, models, piece, triangles, ordered) : undefined;
	return { parts: ordered ?? parts, order };
}

// [A.9.4] Triangles with the places of their wedges
function placed(parts, order) {
	if (order === undefined) return parts;
	const place = new Uint32Array(order.length);
	order.forEach((w, i) => { place[w] = i; });
	return parts.map((triangles) => triangles.map((wedges) => wedges.map((w) => place[w])));
}

// [A.9.4] Elements, an array of bytes for each wedge, in their order
function reordered(elements, order) {
	return order === undefined ? elements : order.map((w) => elements[w]);
}
