// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

// The header of a payload [A.2].

import { PLANES, finishAttributes, readAttributeHeader } from './attributeheader.mjs';
import { checkBlock, checkBlocks, readBlockTable } from './blocktable.mjs';
import { crc32, createReader, remaining, take, u32, u8, varint, zigzag } from './bytes.mjs';
import { fail, failUnless } from './errors.mjs';

// [A.2.6] The limits of this decoder, on the totals of a payload.
const LIMITS = { pieces: 2 ** 16, vertices: 2 ** 24, wedges: 2 ** 24, triangles: 2 ** 24, attributes: 2 ** 16 };
const ELEMENTS_PER_BYTE = 1024;
const valid = (condition, section, message) => failUnless(condition, 'BadHeader', section, message);

// [A.2.1] The header, with the streams of the payload or of each block.
export function readHeader(bytes) {
	const reader = createReader(bytes);
	const minorVersion = readVersion(reader), checksum = u32(reader), flags = u8(reader);
	const [SINGLE_CODER, MANY_PIECES, PADDED, BLOCKS, TRAINED] = [0, 1, 2, 3, 4].map((i) => bit(flags, i));
	const header = { minorVersion, SINGLE_CODER, MANY_PIECES, PADDED, BLOCKS, TRAINED };
	const end = header.BLOCKS ? readHeaderLength(reader) : bytes.length;
	const sum = crc32(bytes.subarray(0, 2), bytes.subarray(6, end));
	failUnless(sum === checksum, 'BadChecksum', 'A.2.1', 'the checksum of the payload does not match');
	valid(flags < (minorVersion === 0 ? 16 : 32), 'A.2.1', 'reserved flags are set');
	valid(!BLOCKS || (MANY_PIECES && !SINGLE_CODER && !TRAINED), 'A.11.1', 'blocks need many pieces, three streams, untrained models');
	header.pieces = readPieces(reader, header, pieceCount(reader, header));
	checkElements(header, bytes.length);
	readStreams(reader, header, end);
	return header;
}
const bit = (flags, i) => ((flags >> i) & 1) === 1;
// The minor version.
function readVersion(reader) {
	const { bytes } = reader;
	const draft = bytes[0] === 0x4d && bytes[1] === 0x43 && bytes[2] === 0x43;
	if (draft) fail('UnsupportedVersion', 'A.2.1', 'the payload is of a withdrawn draft');
	failUnless(bytes[0] === 0x4b, 'BadMagic', 'A.2.1', 'the bytes are not a payload');
	u8(reader);
	const version = u8(reader);
	failUnless(version >> 4 === 1, 'UnsupportedVersion', 'A.2.1', 'the major version is not 1');
	return version & 15;
}

function readHeaderLength(reader) {
	const headerBytes = varint(reader);
	failUnless(headerBytes <= reader.bytes.length, 'Truncated', 'A.2.1', 'the payload ends inside of its header');
	valid(headerBytes >= reader.offset, 'A.11.1', 'the header is longer than it says');
	return headerBytes;
}

function pieceCount(reader, { MANY_PIECES }) {
	if (!MANY_PIECES) return 1;
	const count = varint(reader);
	valid(count >= 2, 'A.2.1', 'MANY_PIECES is not needed');
	failUnless(count <= LIMITS.pieces, 'Limit', 'A.2.1', 'too many pieces');
	return count;
}

function readPieces(reader, header, count) {
	const pieces = [], totals = { vertices: 0, wedges: 0, triangles: 0, attributes: 0 };
	for (let i = 0; i < count; ++i) {
		const piece = readPiece(reader, header, pieces[i - 1], totals);
		if (header.BLOCKS) checkBlock(piece, pieces[0]);
		pieces.push(piece);
	}
	return pieces;
}

// [A.2.2]
function readPiece(reader, header, before, totals) {
	const piece = readPieceFlags(reader);
	valid(!piece.MIRRORS && !piece.ANCHORS || header.minorVersion >= 1, 'A.2.2', 'a flag of 1.1 in a payload of 1.0');
	readCounts(reader, piece);
	checkCounts(reader, piece, totals);
	readParts(reader, piece);
	readAttributes(reader, header, piece, before, totals);
	return piece;
}

function readPieceFlags(reader) {
	const flags = varint(reader);
	valid(flags < 2 ** 14, 'A.2.2', 'reserved flags are set');
	const surface = (flags >> 7) & 3;
	const piece = {
		SEAMS: bit(flags, 0), MANY_PARTS: bit(flags, 1), SAME_ATTRIBUTES: bit(flags, 2), HOLES: bit(flags, 3),
		HANDLES: bit(flags, 4), CREASES: bit(flags, 5), ISOLATED: bit(flags, 6), LISTED: bit(flags, 9),
		TRIANGLE_ORDER: bit(flags, 10), VERTEX_ORDER: bit(flags, 11), MIRRORS: bit(flags, 12),
		ANCHORS: bit(flags, 13),
		COPIES: surface === 1 || surface === 2, INTERIOR_COPIES: surface === 2, PIVOTS: surface === 3,
	};
	valid(piece.SEAMS || !piece.CREASES, 'A.2.2', 'CREASES without SEAMS');
	valid(!piece.PIVOTS || !(piece.HOLES || piece.HANDLES), 'A.2.2', 'PIVOTS with HOLES or HANDLES');
	return piece;
}
const sumOf = (numbers) => numbers.reduce((a, b) => a + b, 0);
const modulo32 = (x) => ((x % 2 ** 32) + 2 ** 32) % 2 ** 32;
function readCounts(reader, piece) {
	const optional = (flag) => {
		if (!flag) return 0;
		const count = varint(reader);
		valid(count !== 0, 'A.2.2', 'a count is stated although it is 0');
		return count;
	};
	piece.vertex_count = varint(reader);
	piece.face_count = varint(reader);
	piece.operation_count = piece.PIVOTS ? 0 : modulo32(piece.vertex_count + zigzag(reader));
	piece.wedge_count = modulo32(piece.vertex_count + zigzag(reader));
	piece.dummy_count = optional(piece.HOLES);
	piece.isolated_count = optional(piece.ISOLATED);
	piece.listed_count = optional(piece.LISTED);
	piece.triangle_count = piece.face_count + piece.listed_count;
	piece.part_count = piece.MANY_PARTS ? varint(reader) : 1;
	valid(!piece.MANY_PARTS || piece.part_count >= 2, 'A.2.2', 'MANY_PARTS is not needed');
	// The wedges on the surface.
	piece.surface_wedges = piece.wedge_count - piece.isolated_count;
}

function checkCounts(reader, piece, totals) {
	const { vertex_count, face_count, wedge_count, triangle_count, isolated_count } = piece;
	const within = (condition, message) => failUnless(condition, 'Limit', 'A.2.2', message);
	totals.vertices += vertex_count;
	totals.wedges += wedge_count;
	within(totals.vertices <= LIMITS.vertices && totals.wedges <= LIMITS.wedges, 'too many vertices or wedges');
	within(vertex_count < 2 ** 28 && wedge_count < 2 ** 28, 'too many vertices or wedges');
	totals.triangles += triangle_count;
	within(totals.triangles <= LIMITS.triangles && triangle_count < 2 ** 28, 'too many triangles');
	const wedgesFit = isolated_count <= wedge_count && piece.surface_wedges <= 3 * face_count;
	valid(wedgesFit, 'A.2.2', 'the number of wedges contradicts others');
	const verticesFit = vertex_count <= 3 * face_count && piece.dummy_count <= 3 * face_count;
	valid(verticesFit, 'A.2.2', 'more vertices or dummies than corners');
	valid((vertex_count === 0) === (face_count === 0), 'A.2.2', 'vertices without faces or faces without vertices');
	valid(piece.operation_count <= vertex_count + 4 * face_count, 'A.2.2', 'too many operations');
	failUnless(piece.part_count <= remaining(reader) + 1, 'Truncated', 'A.2.2', 'there are more parts than bytes');
}

function readParts(reader, piece) {
	piece.partTriangles = [piece.triangle_count];
	if (!piece.MANY_PARTS) return;
	piece.partTriangles = Array.from({ length: piece.part_count }, () => varint(reader));
	valid(sumOf(piece.partTriangles) === piece.triangle_count, 'A.2.2', 'the parts do not sum to the piece');
}

// [A.2.3]
function readAttributes(reader, header, piece, before, totals) {
	const within = (count) => failUnless(count <= LIMITS.attributes, 'Limit', 'A.2.3', 'too many attributes');
	if (piece.SAME_ATTRIBUTES) {
		valid(before !== undefined, 'A.2.3', 'the first piece has SAME_ATTRIBUTES');
		if (!header.BLOCKS) within(totals.attributes += before.attributes.length);
		const { attributes, octahedralNormal, exactNormal } = before;
		Object.assign(piece, { attributes, octahedralNormal, exactNormal });
	} else {
		const count = varint(reader);
		within(totals.attributes += count);
		piece.attributes = [];
		for (let i = 0; i < count; ++i) piece.attributes.push(readAttributeHeader(reader, piece.attributes));
		checkPosition(piece.attributes[0]);
		Object.assign(piece, finishAttributes(piece.attributes, header.minorVersion));
	}
	const { SAME_ATTRIBUTES, attributes } = piece;
	piece.component_sum = SAME_ATTRIBUTES ? before.component_sum : sumOf(attributes.map((a) => a.components));
	const needsAttributes = piece.CREASES || piece.MIRRORS || piece.ANCHORS;
	valid(piece.attributes.length !== 0 || !needsAttributes, 'A.2.3', 'CREASES, MIRRORS or ANCHORS without attributes');
	const planes = piece.attributes.length !== 0 && (piece.attributes[0].predictor & PLANES) !== 0;
	valid(!planes || !piece.MIRRORS && !piece.ANCHORS, 'A.6.2', 'planes is set in a piece with MIRRORS or ANCHORS');
}

const POSITION_CODINGS = [0, 1, 2, 6];
function checkPosition(a) {
	if (a === undefined) return;
	const isBase = a.semantic === 0 && a.set === 0 && a.target === 0 && a.components === 3;
	valid(isBase && POSITION_CODINGS.includes(a.coding), 'A.2.3', 'attribute 0 is not a position');
}

// [A.2.6]
function checkElements(header, byteLength) {
	header.elements = sumOf(header.pieces.map((piece) => elementsOf(piece, header.BLOCKS)));
	failUnless(header.elements <= ELEMENTS_PER_BYTE * byteLength, 'Limit', 'A.2.6', 'there are too many elements');
}

function elementsOf(piece, isBlock) {
	const { vertex_count, wedge_count, triangle_count, attributes } = piece;
	let elements = piece.operation_count + vertex_count + wedge_count + triangle_count + 8 * piece.isolated_count;
	if (piece.COPIES) elements += 8 * vertex_count;
	if (piece.PIVOTS) elements += 8 * piece.face_count;
	if (piece.TRIANGLE_ORDER) elements += 8 * triangle_count;
	if (piece.VERTEX_ORDER) elements += 8 * (triangle_count + wedge_count);
	elements += attributes.length * (triangle_count + 1024) + piece.component_sum * wedge_count;
	return elements + (isBlock ? 16384 : 0);
}

// [A.2.5] The streams of the payload, or the blocks with the streams of each.
function readStreams(reader, header, end) {
	const lengths = header.SINGLE_CODER || header.BLOCKS ? [] : [varint(reader), varint(reader)];
	if (header.BLOCKS) header.blocks = readBlockTable(reader, header.pieces);
	if (header.PADDED) readPadding(reader);
	if (header.BLOCKS) {
		valid(reader.offset === end, 'A.11.1', 'the header has another length than it says');
		checkBlocks(reader, header);
	} else if (header.SINGLE_CODER) {
		header.streams = { codes: take(reader, remaining(reader)) };
	} else {
		const codes = take(reader, lengths[0]), tokens = take(reader, lengths[1]);
		header.streams = { codes, tokens, raw: take(reader, remaining(reader)) };
	}
}

function readPadding(reader) {
	const length = varint(reader);
	valid(length !== 0, 'A.2.5', 'PADDED is not needed');
	valid(take(reader, length).every((byte) => byte === 0), 'A.2.5', 'the padding is not zero');
}
