// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

// What the header says of blocks [A.11.1].

import { crc32, remaining, take, u32, varint, zigzag } from './bytes.mjs';
import { failUnless } from './errors.mjs';

const valid = (condition, message) => failUnless(condition, 'BadHeader', 'A.11.1', message);

// [A.11.1] A piece that is a block; `first` is the first block, undefined for itself.
export function checkBlock(piece, first) {
	valid(first === undefined || piece.SAME_ATTRIBUTES, 'a block states attributes of its own');
	valid(piece.attributes.length !== 0, 'a block has no attributes');
	valid(piece.part_count === (first ?? piece).part_count, 'a block has another number of parts');
	valid(piece.face_count !== 0, 'a block has no faces');
	const { PIVOTS, TRIANGLE_ORDER, VERTEX_ORDER, MIRRORS, ANCHORS } = piece;
	valid(!PIVOTS && !TRIANGLE_ORDER && !VERTEX_ORDER && !MIRRORS && !ANCHORS, 'a block has a flag that blocks do not have');
}

// [A.11.1] The table of blocks. `first` is the number of wedges of the glued piece before a block.
export function readBlockTable(reader, pieces) {
	const blocks = [];
	let first = 0;
	for (const piece of pieces) {
		blocks.push(readBlock(reader, piece, first, blocks.length === 0));
		first += piece.wedge_count - blocks[blocks.length - 1].repeated_count;
	}
	return blocks;
}

function readBlock(reader, piece, first, isFirst) {
	const block = { first, repeated_count: isFirst ? 0 : varint(reader) };
	valid(block.repeated_count <= piece.surface_wedges, 'more wedges are repeated than there are');
	block.exceptions = readExceptions(reader, piece, first, isFirst ? 0 : varint(reader));
	block.lengths = [varint(reader), varint(reader), varint(reader)];
	block.checksum = u32(reader);
	block.low = [];
	block.high = [];
	for (let s = 0; s < 3; ++s) {
		block.low.push(zigzag(reader));
		block.high.push(block.low[s] + varint(reader));
		valid(block.high[s] < 2 ** 31, 'a box is too large');
	}
	return block;
}

// Wedges of the block, each with the wedge of the glued piece that it is, undefined if it is new.
function readExceptions(reader, piece, first, count) {
	const exceptions = new Map();
	let wedge = -1;
	for (let i = 0; i < count; ++i) {
		wedge += varint(reader) + 1;
		const back = varint(reader);
		valid(wedge < piece.surface_wedges && back <= first, 'an exception names what does not exist');
		exceptions.set(wedge, back === 0 ? undefined : first - back);
	}
	return exceptions;
}

// [A.11.1] What can be checked once the header ends; sets the streams of each block.
export function checkBlocks(reader, { pieces, blocks }) {
	const sum = blocks.reduce((total, { lengths }) => total + lengths[0] + lengths[1] + lengths[2], 0);
	failUnless(sum <= remaining(reader), 'Truncated', 'A.11.1', 'the streams end too early');
	failUnless(sum === remaining(reader), 'TrailingBytes', 'A.11.1', 'bytes are left over after the last block');
	for (const block of blocks) {
		const [codes, tokens, raw] = block.lengths.map((length) => take(reader, length));
		block.streams = { codes, tokens, raw };
		const matches = crc32(codes, tokens, raw) === block.checksum;
		failUnless(matches, 'BadChecksum', 'A.11.1', 'the checksum of a block does not match');
	}
	const below = (total) => failUnless(total < 2 ** 28, 'Limit', 'A.11.4', 'the glued piece is too large');
	below(pieces.reduce((total, piece) => total + piece.vertex_count, 0));
	below(pieces.reduce((total, piece) => total + piece.triangle_count, 0));
	below(gluedWedgeCount({ pieces, blocks }));
}

export const gluedWedgeCount = ({ pieces, blocks }) =>
	pieces.reduce((total, piece, i) => total + piece.wedge_count - blocks[i].repeated_count, 0);
