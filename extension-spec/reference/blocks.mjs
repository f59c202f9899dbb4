// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

// Blocks: A.11 of the specification. A large mesh is cut into pieces with streams of their own, which are glued here.

import { crc32, fail } from './bytes.mjs';
import { ThreeStreams } from './entropy.mjs';
import { next, NONE } from './mesh.mjs';

const NEW = -1; // instead of the number of an earlier wedge

function badHeader(message) {
	fail('BadHeader', 'A.11.1', message);
}

// ---- [A.11.1] Pieces that are blocks, and their table

// piece: its header; first: that of block 0, or undefined if this is it
export function checkBlock(piece, first) {
	const { flags, attributes, faceCount, partCount } = piece;
	if (first !== undefined && !flags.SAME_ATTRIBUTES) badHeader('a block with attributes of its own');
	if (attributes.length === 0) badHeader('a block without attributes');
	if (first !== undefined && partCount !== first.partCount) badHeader('blocks with different numbers of parts');
	if (faceCount === 0) badHeader('a block without faces');
	if (flags.TRIANGLE_ORDER || flags.VERTEX_ORDER) badHeader('a block with an order');
	if (flags.PIVOTS) badHeader('a block with PIVOTS');
}

// The blocks, without streams: piece, first, repeatedCount, exceptions, lengths, checksum, low and high.
export function readTable(reader, pieces) {
	const blocks = [];
	let first = 0;
	for (const piece of pieces) {
		const block = { piece, first, ...readRepeated(reader, piece, first, blocks.length === 0), ...readStreamsAndBox(reader) };
		blocks.push(block);
		first += piece.wedgeCount - block.repeatedCount;
	}
	return blocks;
}

function readRepeated(reader, piece, first, isFirst) {
	const exceptions = new Map(); // wedge of the glued piece, or NEW, by wedge of the block
	if (isFirst) return { repeatedCount: 0, exceptions };
	const surfaceCount = piece.wedgeCount - piece.isolatedCount;
	const repeatedCount = reader.varint();
	if (repeatedCount > surfaceCount) badHeader('more repeated wedges than wedges');
	const exceptionCount = reader.varint();
	let wedge = -1;
	for (let i = 0; i < exceptionCount; ++i) {
		wedge += 1 + reader.varint();
		if (wedge >= surfaceCount) badHeader('an exception of a wedge that does not exist');
		const back = reader.varint();
		if (back > first) badHeader('an exception with a wedge that does not exist');
		exceptions.set(wedge, back === 0 ? NEW : first - back);
	}
	return { repeatedCount, exceptions };
}

function readStreamsAndBox(reader) {
	const lengths = [reader.varint(), reader.varint(), reader.varint()];
	const checksum = reader.u32();
	const low = [];
	const high = [];
	for (let s = 0; s < 3; ++s) {
		low.push(reader.zigzag());
		high.push(low[s] + reader.varint());
		if (high[s] > 2 ** 31 - 1) badHeader('a box that is too large');
	}
	return { lengths, checksum, low, high };
}

// Adds the streams of the blocks, which are all that remains.
export function readStreamsOfBlocks(reader, blocks) {
	const sum = blocks.flatMap(({ lengths }) => lengths).reduce((a, b) => a + b, 0);
	if (sum > reader.remaining()) fail('Truncated', 'A.11.1', 'the payload ends inside a block');
	if (sum < reader.remaining()) fail('TrailingBytes', 'A.11.1', 'bytes follow the last block');
	for (const block of blocks) {
		const streams = block.lengths.map((length) => reader.take(length));
		if (crc32(...streams) !== block.checksum) fail('BadChecksum', 'A.11.1', 'the checksum of a block does not match');
		block.streams = new ThreeStreams(...streams);
	}
}

// ---- [A.11.2] Models

// A copy of models; nothing in them is referred to twice.
export function copyOf(value) {
	if (ArrayBuffer.isView(value)) return value.slice();
	if (Array.isArray(value)) return value.map(copyOf);
	if (typeof value !== 'object') return value;
	const copy = Object.assign(Object.create(Object.getPrototypeOf(value)), value);
	for (const key of Object.keys(copy)) copy[key] = copyOf(copy[key]);
	return copy;
}

// ---- [A.11.3], [A.11.4] The glued piece

// What a header says of a piece. The limits of this decoder on totals (A.2.6) are below those of a glued piece.
export function gluedHeader(blocks) {
	const [{ piece }] = blocks;
	const last = blocks.at(-1);
	return {
		flags: { TRIANGLE_ORDER: false, VERTEX_ORDER: false },
		wedgeCount: last.first + last.piece.wedgeCount - last.repeatedCount,
		partSizes: piece.partSizes.map((_, part) => blocks.reduce((sum, block) => sum + block.piece.partSizes[part], 0)),
		attributes: piece.attributes,
	};
}

export class Glue {
	constructor({ partSizes, attributes }) {
		this.parts = partSizes.map(() => []);
		this.elements = attributes.map(() => []);
		this.rim = new Map(); // wedges of the glued piece, by the tuples of earlier blocks
	}

	// decoded: parts, elements, surface and integersOf of the block
	add(block, { parts, elements, surface, integersOf }) {
		checkBox(block, integersOf);
		const tuples = tuplesOfRim(surface, integersOf);
		const numbers = this.numbersOf(block, tuples);
		for (const [w, tuple] of tuples) {
			const isNew = numbers[w] >= block.first && !block.exceptions.has(w);
			if (isNew && !this.rim.has(tuple)) this.rim.set(tuple, numbers[w]);
		}
		parts.forEach((triangles, part) => {
			for (const wedges of triangles) this.parts[part].push(wedges.map((w) => numbers[w]));
		});
		elements.forEach((list, i) => list.forEach((element, w) => {
			if (numbers[w] >= block.first) this.elements[i].push(element);
		}));
	}

	// [A.11.3] The wedges of the glued piece that the wedges of the block are
	numbersOf(block, tuples) {
		const { piece, first, exceptions, repeatedCount } = block;
		let unused = first;
		const numbers = Array.from({ length: piece.wedgeCount }, (_, w) => {
			const earlier = exceptions.get(w) ?? this.rim.get(tuples.get(w)) ?? NEW;
			return earlier === NEW ? unused++ : earlier;
		});
		if (first + piece.wedgeCount - unused !== repeatedCount) fail('BadAttribute', 'A.11.3', 'another number of repeated wedges');
		return numbers;
	}
}

// [A.11.3] The tuples of the wedges at boundaries, by wedge, ascending
function tuplesOfRim(surface, integersOf) {
	const wedges = new Set();
	for (let h = 0; h < surface.halfEdgeCount; ++h) {
		if (surface.twin(h) === NONE) wedges.add(surface.tail(h)).add(surface.tail(next(h)));
	}
	return new Map([...wedges].sort((a, b) => a - b).map((w) => [w, integersOf(w).join()]));
}

// [A.11.4]
function checkBox({ piece, low, high }, integersOf) {
	const least = [Infinity, Infinity, Infinity];
	const most = [-Infinity, -Infinity, -Infinity];
	for (let w = 0; w < piece.wedgeCount; ++w) {
		const position = integersOf(w);
		for (let s = 0; s < 3; ++s) {
			least[s] = Math.min(least[s], position[s]);
			most[s] = Math.max(most[s], position[s]);
		}
	}
	const isExact = [0, 1, 2].every((s) => least[s] === low[s] && most[s] === high[s]);
	if (!isExact) fail('BadAttribute', 'A.11.4', 'the box of a block is not that of its positions');
}
