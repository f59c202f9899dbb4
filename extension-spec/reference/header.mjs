// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

// The container: A.2 of the specification. Reads and checks everything in front of the streams.

import { checkBlock, readStreamsOfBlocks, readTable } from './blocks.mjs';
import { bitsOfFloat, ByteReader, crc32, fail, floatOfBits } from './bytes.mjs';
import { SingleCoder, ThreeStreams } from './entropy.mjs';
import { methodOf, predictorIsValid } from './methods.mjs';
import { ALIAS, EXACT_FLOAT, FLOAT, GRID, INTEGER, JOINTS, LATTICE, NORMAL, OCTAHEDRAL, POSITION, TANGENT, TANGENT_ANGLE, TEXCOORD,
	WEIGHTS } from './names.mjs';

// [A.2.6] The limits of this decoder: those that decoders SHOULD have at least.
export const LIMITS = { vertices: 2 ** 24, wedges: 2 ** 24, triangles: 2 ** 24, attributes: 1024, pieces: 65536 };

// [A.2.4] Those of accessors: SCALAR to VEC4 and matrices
const COMPONENT_COUNTS = [1, 2, 3, 4, 9, 16];

// [A.2.4] By semantic
const USUAL_COMPONENTS = [3, 3, 4, 2, 4, 4, 4, 1];

// [A.2.1] A flag of the payload
const BLOCKS = 8;

// [A.2.2] Flags of a piece, by bit; bits 7 and 8 are a number
const PIECE_FLAGS = ['SEAMS', 'MANY_PARTS', 'SAME_ATTRIBUTES', 'HOLES', 'HANDLES', 'CREASES', 'ISOLATED', '', '', 'LISTED',
	'TRIANGLE_ORDER', 'VERTEX_ORDER'];

function badHeader(section, message) {
	fail('BadHeader', section, message);
}

// [A.2.1] Payload: returns its header and the decoder of its streams, which with BLOCKS are in header.blocks.
export function readHeader(bytes) {
	const reader = new ByteReader(bytes);
	readMagicVersionChecksum(reader);
	const header = readPayloadFlags(reader);
	header.pieces = readPieces(reader, header);
	checkElements(header, bytes.length);
	if (header.hasBlocks) header.blocks = readBlocks(reader, header);
	const streams = header.hasBlocks ? undefined : readStreams(reader, header);
	return { header, streams };
}

// [A.2.1]
function readMagicVersionChecksum(reader) {
	const { bytes } = reader;
	const start = String.fromCharCode(...bytes.subarray(0, 3));
	if (start === 'MCC') fail('UnsupportedVersion', 'A.2.1', 'a withdrawn draft');
	if (start[0] !== 'K') fail('BadMagic', 'A.2.1', 'no "K"');
	reader.take(1);
	const version = reader.u8();
	if (version >> 4 !== 1) fail('UnsupportedVersion', 'A.2.1', `version ${version >> 4}.${version & 15}`);
	const checksum = reader.u32();
	const end = checksummedBytes(bytes);
	if (crc32(bytes.subarray(0, 2), bytes.subarray(6, end)) !== checksum) fail('BadChecksum', 'A.2.1', 'the checksum does not match');
}

// [A.2.1] Where the bytes end that the checksum covers: with BLOCKS it is that of the header.
function checksummedBytes(bytes) {
	const reader = new ByteReader(bytes.subarray(6));
	if (reader.remaining() === 0 || !(reader.u8() & BLOCKS)) return bytes.length;
	const headerLength = reader.varint();
	if (headerLength > bytes.length) fail('Truncated', 'A.2.1', 'the payload ends inside its header');
	return headerLength;
}

// [A.2.1]
function readPayloadFlags(reader) {
	const flags = reader.u8();
	if (flags >> 5 !== 0) badHeader('A.2.1', 'a reserved flag is set');
	const hasBlocks = (flags & BLOCKS) !== 0;
	if (hasBlocks && (flags & 3) !== 2) badHeader('A.11.1', 'BLOCKS with SINGLE_CODER or without MANY_PIECES');
	const headerLength = hasBlocks ? reader.varint() : undefined;
	const pieceCount = flags & 2 ? reader.varint() : 1;
	if (flags & 2 && pieceCount < 2) badHeader('A.2.1', `a stated count of ${pieceCount} pieces`);
	if (pieceCount > LIMITS.pieces) fail('Limit', 'A.2.1', `${pieceCount} pieces`);
	return { singleCoder: (flags & 1) !== 0, padded: (flags & 4) !== 0, hasBlocks, headerLength, pieceCount };
}

function readPieces(reader, { pieceCount, hasBlocks }) {
	const pieces = [];
	const totals = { vertices: 0, wedges: 0, triangles: 0, attributes: 0 };
	for (let i = 0; i < pieceCount; ++i) {
		const piece = readPiece(reader, pieces[i - 1], totals);
		if (hasBlocks) checkBlock(piece, pieces[0]);
		if (!hasBlocks || i === 0) countAttributes(piece, totals);
		pieces.push(piece);
	}
	return pieces;
}

// [A.2.3]
function countAttributes(piece, totals) {
	totals.attributes += piece.attributes.length;
	if (totals.attributes > LIMITS.attributes) fail('Limit', 'A.2.3', 'too many attributes');
}

// ---- [A.2.2] Piece

function readPiece(reader, before, totals) {
	const flags = readPieceFlags(reader);
	const counts = readCounts(reader, flags);
	checkCounts(counts, totals, reader.remaining());
	const piece = { flags, ...counts };
	piece.partSizes = readPartSizes(reader, piece);
	piece.attributes = readAttributes(reader, piece, before);
	return piece;
}

// [A.2.2]
function readPieceFlags(reader) {
	const bits = reader.varint();
	if (bits >>> PIECE_FLAGS.length !== 0) badHeader('A.2.2', 'a reserved flag of a piece is set');
	const flags = {};
	PIECE_FLAGS.forEach((name, i) => { flags[name] = ((bits >>> i) & 1) === 1; });
	const surface = (bits >>> 7) & 3;
	flags.COPIES = surface === 1 || surface === 2;
	flags.INTERIOR_COPIES = surface === 2;
	flags.PIVOTS = surface === 3;
	if (flags.CREASES && !flags.SEAMS) badHeader('A.2.2', 'CREASES without SEAMS');
	if (flags.PIVOTS && (flags.HOLES || flags.HANDLES)) badHeader('A.2.2', 'PIVOTS with HOLES or HANDLES');
	return flags;
}

// [A.2.2]
function readCounts(reader, flags) {
	const vertexCount = reader.varint();
	const faceCount = reader.varint();
	const operationCount = flags.PIVOTS ? 0 : (vertexCount + reader.zigzag()) >>> 0;
	const wedgeCount = (vertexCount + reader.zigzag()) >>> 0;
	const dummyCount = flags.HOLES ? readAtLeast(reader, 1) : 0;
	const isolatedCount = flags.ISOLATED ? readAtLeast(reader, 1) : 0;
	const listedCount = flags.LISTED ? readAtLeast(reader, 1) : 0;
	const partCount = flags.MANY_PARTS ? readAtLeast(reader, 2) : 1;
	const triangleCount = faceCount + listedCount;
	return { vertexCount, faceCount, operationCount, wedgeCount, dummyCount, isolatedCount, listedCount, partCount, triangleCount };
}

// [A.2.2] A count that is not what it is without its flag
function readAtLeast(reader, least) {
	const count = reader.varint();
	if (count < least) badHeader('A.2.2', `a stated count of ${count}`);
	return count;
}

// [A.2.2] The table of conditions, in its order.
function checkCounts(counts, totals, remaining) {
	const { vertexCount, wedgeCount, faceCount, triangleCount } = counts;
	totals.vertices += vertexCount;
	totals.wedges += wedgeCount;
	if (totals.vertices > LIMITS.vertices || totals.wedges > LIMITS.wedges) fail('Limit', 'A.2.2', 'too many vertices or wedges');
	if (vertexCount >= 2 ** 28 || wedgeCount >= 2 ** 28) fail('Limit', 'A.2.2', 'too many vertices or wedges');
	totals.triangles += triangleCount;
	if (totals.triangles > LIMITS.triangles || triangleCount >= 2 ** 28) fail('Limit', 'A.2.2', 'too many triangles');
	if (counts.isolatedCount > wedgeCount) badHeader('A.2.2', 'more isolated wedges than wedges');
	if (wedgeCount - counts.isolatedCount > 3 * faceCount) badHeader('A.2.2', 'more wedges than corners');
	if (vertexCount > 3 * faceCount || counts.dummyCount > 3 * faceCount) badHeader('A.2.2', 'too few faces');
	if ((vertexCount === 0) !== (faceCount === 0)) badHeader('A.2.2', 'vertices without faces or faces without vertices');
	if (counts.operationCount > vertexCount + 4 * faceCount) badHeader('A.2.2', 'too many operations');
	if (counts.partCount > remaining + 1) fail('Truncated', 'A.2.2', 'more parts than bytes');
}

// [A.2.2]
function readPartSizes(reader, piece) {
	if (!piece.flags.MANY_PARTS) return [piece.triangleCount];
	const sizes = [];
	for (let i = 0; i < piece.partCount; ++i) sizes.push(reader.varint());
	const sum = sizes.reduce((a, b) => a + b, 0);
	if (sum !== piece.triangleCount) badHeader('A.2.2', 'the triangles of the parts do not sum to those of the piece');
	return sizes;
}

// ---- [A.2.3] Attributes of a piece

function readAttributes(reader, piece, before) {
	if (piece.flags.SAME_ATTRIBUTES) {
		if (before === undefined) badHeader('A.2.3', 'SAME_ATTRIBUTES in the first piece');
		checkCreases(piece, before.attributes);
		return before.attributes;
	}
	const count = reader.varint();
	if (count > LIMITS.attributes) fail('Limit', 'A.2.3', `${count} attributes`);
	const attributes = [];
	for (let i = 0; i < count; ++i) attributes.push({ number: i, ...readAttribute(reader, attributes) });
	checkCreases(piece, attributes);
	if (count > 0) checkPosition(attributes[0]);
	findRelations(attributes);
	attributes.slice(1).forEach((attribute) => checkAttribute(attribute, attributes));
	return attributes;
}

// [A.2.3]
function checkCreases(piece, attributes) {
	if (attributes.length === 0 && piece.flags.CREASES) badHeader('A.2.3', 'CREASES without attributes');
}

// [A.2.3]
function checkPosition(position) {
	if (position.semantic !== POSITION || position.set !== 0 || position.target !== 0 || position.components !== 3) {
		badHeader('A.2.3', 'attribute 0 is no position of the base mesh');
	}
	if (![LATTICE, INTEGER, EXACT_FLOAT, GRID].includes(position.coding)) badHeader('A.2.3', 'coding of attribute 0');
	checkPositionPredictor(position);
}

// [A.6.2] Predictor byte of positions
function checkPositionPredictor(position) {
	const byte = position.predictor;
	const kind = byte & 28;
	if ((kind & (kind - 1)) !== 0) badHeader('A.6.2', 'more than one of shear, palette and planes');
	if ((byte & 3) === 2) badHeader('A.6.2', 'tip selection without weights');
	if (kind !== 16) return;
	if (byte >> 5 !== 0 || position.coding !== LATTICE || position.bits > 17) badHeader('A.6.2', 'planes are not allowed here');
}

// ---- [A.2.4] Header of an attribute

function readAttribute(reader, before) {
	const kind = reader.u8();
	const semantic = kind & 7;
	const usual = { type: FLOAT, components: USUAL_COMPONENTS[semantic], normalized: false };
	const more = kind >> 7 === 1;
	const attribute = {
		semantic,
		coding: (kind >> 3) & 7,
		...((kind >> 6) & 1 ? readType(reader, usual) : usual),
		set: more ? reader.u8() : 0,
		target: more ? reader.varint() : 0,
		predictor: reader.u8(),
	};
	if (more && attribute.set === 0 && attribute.target === 0) badHeader('A.2.4', 'MORE without need');
	checkTypes(attribute);
	readParameters(reader, attribute, before);
	return attribute;
}

function readType(reader, usual) {
	const byte = reader.u8();
	const type = { type: byte & 7, components: ((byte >> 3) & 15) + 1, normalized: byte >> 7 === 1 };
	if (Object.keys(usual).every((key) => type[key] === usual[key])) badHeader('A.2.4', 'TYPE without need');
	return type;
}

// [A.2.4]
function checkTypes({ type, components, target, coding }) {
	if (type > FLOAT) badHeader('A.2.4', `component type ${type}`);
	if (!COMPONENT_COUNTS.includes(components)) badHeader('A.2.4', `${components} components`);
	if (target > 65535) badHeader('A.2.4', `morph target ${target}`);
	if (coding > GRID) badHeader('A.2.4', `coding ${coding}`);
	const fits = coding === ALIAS || (coding === INTEGER) === (type !== FLOAT);
	if (!fits) badHeader('A.2.4', 'the coding does not fit the component type');
}

// [A.2.4] The table of codings
function readParameters(reader, attribute, before) {
	switch (attribute.coding) {
	case LATTICE: return readLattice(reader, attribute, before);
	case OCTAHEDRAL: return readOctahedral(reader, attribute);
	case TANGENT_ANGLE: return readTangentAngle(reader, attribute);
	case ALIAS: attribute.alias = reader.varint(); return undefined;
	case GRID: return readGrid(reader, attribute);
	default: return undefined;
	}
}

function setBits(attribute, bits, least, most) {
	if (bits < least || bits > most) badHeader('A.2.4', `${bits} bits`);
	attribute.bits = bits;
}

function readLattice(reader, attribute, before) {
	if (attribute.components > 4) badHeader('A.2.4', 'a lattice of more than 4 components');
	const word = reader.varint();
	const origins = attribute.target === 0 ? attribute.components : 0;
	const form = (i) => (word >>> (5 + 2 * i)) & 3;
	setBits(attribute, word & 31, 1, 24);
	if (word >>> (7 + 2 * origins) !== 0) badHeader('A.2.4', 'a reserved bit of a lattice is set');
	attribute.step = readFloat(reader, form(0), usualStep(attribute, before));
	if (!(attribute.step > 0 && attribute.step < Infinity)) badHeader('A.2.4', 'step of a lattice');
	attribute.origin = new Float32Array(attribute.components);
	for (let c = 0; c < origins; ++c) attribute.origin[c] = readFloat(reader, form(1 + c), 0);
	if (!attribute.origin.every(Number.isFinite)) badHeader('A.2.4', 'origin of a lattice');
}

// [A.2.4] Forms of floats
function readFloat(reader, form, usual) {
	if (form === 3) return usual;
	const value = reader.highBytes(4 - form);
	const isLarger = (larger) => value % 2 ** (8 * larger) === 0;
	if (value === bitsOfFloat(usual) || (form < 2 && isLarger(form + 1))) badHeader('A.2.4', 'a float has a larger form');
	return floatOfBits(value);
}

// [A.2.4]
function usualStep({ semantic, bits }, before) {
	const lattice = before.findLast((a) => a.semantic === semantic && a.coding === LATTICE);
	return lattice === undefined ? Math.fround(1 / (2 ** bits - 1)) : lattice.step;
}

function readOctahedral(reader, attribute) {
	setBits(attribute, reader.u8(), 2, 16);
	const isTangent = attribute.semantic === TANGENT;
	if (attribute.components !== (isTangent ? 4 : 3)) badHeader('A.2.4', 'components of coding octahedral');
	if (isTangent && attribute.target !== 0) badHeader('A.2.4', 'an octahedral tangent of a morph target');
}

function readTangentAngle(reader, attribute) {
	setBits(attribute, reader.u8(), 2, 16);
	if (attribute.semantic !== TANGENT || attribute.components !== 4 || attribute.target !== 0) {
		badHeader('A.2.4', 'coding tangent angle of another attribute');
	}
}

function readGrid(reader, attribute) {
	if (attribute.components > 4) badHeader('A.2.4', 'a grid of more than 4 components');
	const byte = reader.u8();
	attribute.bits = byte & 31;
	attribute.tails = byte >> 5;
	attribute.grid = reader.u8();
	const { bits, tails, grid } = attribute;
	if (bits < 1 || bits > 27 || tails > 2) badHeader('A.2.4', 'bits or tails of a grid');
	if (tails !== 0 && grid < 10) badHeader('A.2.4', 'tails of a decimal grid');
}

// ---- [A.2.4] Relations between the attributes of a piece

// Sets octahedralNormal, exactNormal and chart (A.10.1) of the list; partner of attributes.
function findRelations(attributes) {
	const base = (a) => a.target === 0;
	attributes.octahedralNormal = attributes.find((a) => base(a) && a.coding === OCTAHEDRAL && a.semantic !== TANGENT);
	attributes.exactNormal = attributes.find((a) => base(a) && a.semantic === NORMAL && a.components === 3
		&& (a.coding === EXACT_FLOAT || a.coding === GRID));
	attributes.chart = attributes.find((a) => base(a) && a.semantic === TEXCOORD && a.components === 2 && a.coding !== ALIAS);
	findPartners(attributes);
}

function findPartners(attributes) {
	const candidate = (a, semantic, codings) => a.number >= 1 && a.semantic === semantic && a.components === 4 && a.target === 0
		&& codings.includes(a.coding);
	const isJoints = (a) => candidate(a, JOINTS, [INTEGER]);
	const isWeights = (a) => candidate(a, WEIGHTS, [LATTICE, INTEGER, EXACT_FLOAT, GRID]);
	for (const joints of attributes.filter(isJoints)) {
		if (attributes.find((a) => isJoints(a) && a.set === joints.set) !== joints) continue;
		const weights = attributes.find((a) => isWeights(a) && a.set === joints.set);
		if (weights === undefined) continue;
		joints.partner = weights;
		weights.partner = joints;
	}
}

// [A.2.4] The checks of each attribute i >= 1 after all headers of the piece.
function checkAttribute(attribute, attributes) {
	if (attribute.coding === ALIAS) checkAlias(attribute, attributes);
	if (attribute.coding === TANGENT_ANGLE && attributes.octahedralNormal === undefined) {
		badHeader('A.2.4', 'a tangent angle without an octahedral normal');
	}
	attribute.method = methodOf(attribute);
	if (!predictorIsValid(attribute)) badHeader('A.2.4', `predictor byte of attribute ${attribute.number}`);
}

function checkAlias(attribute, attributes) {
	const source = attributes[attribute.alias];
	if (attribute.alias < 1 || attribute.alias >= attribute.number || source.coding === ALIAS
		|| source.type !== attribute.type || source.components !== attribute.components) {
		badHeader('A.2.4', 'an alias of an attribute that cannot be its source');
	}
}

// ---- [A.2.5] Streams

function readStreams(reader, header) {
	const codesLength = header.singleCoder ? 0 : reader.varint();
	const tokensLength = header.singleCoder ? 0 : reader.varint();
	readPadding(reader, header);
	if (header.singleCoder) return new SingleCoder(reader.take(reader.remaining()));
	const codes = reader.take(codesLength);
	const tokens = reader.take(tokensLength);
	return new ThreeStreams(codes, tokens, reader.take(reader.remaining()));
}

function readPadding(reader, { padded }) {
	const length = padded ? reader.varint() : 0;
	if (padded && length === 0) badHeader('A.2.5', 'padding of no bytes');
	if (reader.take(length).some((byte) => byte !== 0)) badHeader('A.2.5', 'padding other than zero');
}

// [A.11.1]
function readBlocks(reader, header) {
	const blocks = readTable(reader, header.pieces);
	readPadding(reader, header);
	if (reader.offset !== header.headerLength) badHeader('A.11.1', 'the header has another length than it says');
	readStreamsOfBlocks(reader, blocks);
	return blocks;
}

// ---- [A.2.6] Limits

function checkElements({ pieces, hasBlocks }, byteLength) {
	const copying = hasBlocks ? 16384 : 0;
	const elements = pieces.reduce((sum, piece) => sum + elementsOf(piece) + copying, 0);
	if (elements > 1024 * byteLength) fail('Limit', 'A.2.6', 'too many elements for so few bytes');
}

// Exact: every count is below 2^32.
function elementsOf(piece) {
	const { operationCount, vertexCount, faceCount, wedgeCount, isolatedCount, triangleCount, attributes, flags } = piece;
	const components = attributes.reduce((sum, a) => sum + a.components, 0);
	const searches = (flags.COPIES ? vertexCount : 0) + (flags.PIVOTS ? faceCount : 0) + isolatedCount
		+ (flags.TRIANGLE_ORDER ? triangleCount : 0) + (flags.VERTEX_ORDER ? wedgeCount + triangleCount : 0);
	return operationCount + vertexCount + wedgeCount + triangleCount + 8 * searches + triangleCount * attributes.length
		+ wedgeCount * components + 1024 * attributes.length;
}
