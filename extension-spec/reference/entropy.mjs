// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

// Entropy coding: A.3 of the specification.

import { fail, unzigzag, width } from './bytes.mjs';

const MASK_64 = (1n << 64n) - 1n;

// ---- [A.3.1] Adaptive models

class BinaryModel {
	constructor() {
		this.p = 2 ** 21; // probability of the outcome 0 in units of 2^-22
		this.n = 0;
	}
}

function rate(n) {
	const d = 5 * n + 8;
	return Math.floor((655360 + d) / (2 * d));
}

function update(model, outcome) {
	if (outcome === 1) model.p -= Math.floor(model.p * rate(model.n) / 65536);
	else model.p += Math.floor((2 ** 22 - model.p) * rate(model.n) / 65536);
	model.n = Math.min(model.n + 1, 255);
}

export class Row {
	constructor() {
		this.c = new Int32Array(17);
		for (let i = 0; i <= 16; ++i) this.c[i] = 2048 * i;
		this.uses = 0;
	}
}

// A schedule gives the shift by the number of uses, 0 .. 63. `last[i]` is the last number of uses with the i-th shift.
function makeSchedule(firstShift, last) {
	const schedule = [];
	for (let uses = 0, i = 0; uses <= 63; ++uses) {
		if (uses > last[i]) ++i;
		schedule.push(firstShift + i);
	}
	return schedule;
}

export const POSITIONS = makeSchedule(2, [1, 4, 10, 29, 62, 63]);
export const ATTRIBUTES = makeSchedule(1, [0, 2, 6, 14, 30, 63]);

function adapt(row, symbol, schedule) {
	const shift = schedule[row.uses];
	row.uses = Math.min(row.uses + 1, 63);
	for (let i = 1; i <= 15; ++i) {
		const target = 4 * i + (i > symbol ? 2 ** 15 - 64 : 0);
		row.c[i] += (target - row.c[i]) >> shift;
	}
}

function symbolOf(row, slot) {
	let symbol = 15;
	while (row.c[symbol] > slot) --symbol;
	return symbol;
}

// Arrays of models with any number of dimensions: models([3, 4], make) is indexed [i][j].
export function models(dimensions, make = () => new BinaryModel()) {
	let level = make;
	for (const size of [...dimensions].reverse()) {
		const inner = level;
		level = () => Array.from({ length: size }, () => inner());
	}
	return level();
}

export const rows = (dimensions) => models(dimensions, () => new Row());

// ---- [A.3.2] Range decoder

class RangeDecoder {
	constructor(bytes) {
		this.bytes = bytes;
		this.read = 0; // bytes, those after the end included
		this.range = MASK_64;
		this.code = this.word() << 32n;
		this.code += this.word();
	}

	// Zero after the end, of which [A.3.8] allows 8 bytes.
	word() {
		let value = 0;
		for (let i = 0; i < 4; ++i) value += (this.bytes[this.read + i] ?? 0) * 2 ** (8 * i);
		this.read += 4;
		if (this.read > this.bytes.length + 8) fail('Truncated', 'A.3.8', 'the stream codes ends early');
		return BigInt(value);
	}

	bit(model) {
		const split = (this.range >> 22n) * BigInt(model.p);
		let outcome = 0;
		if (this.code >= split) {
			outcome = 1;
			this.code -= split;
			this.range -= split;
		} else {
			this.range = split;
		}
		update(model, outcome);
		this.renormalise();
		return outcome;
	}

	renormalise() {
		if (this.range < 1n << 32n) {
			this.range <<= 32n;
			this.code = ((this.code << 32n) & MASK_64) + this.word();
		}
	}

	// [A.3.7]
	peek(n) {
		const value = Number(this.code / (this.range >> BigInt(n)));
		return Math.min(value, 2 ** n - 1);
	}

	// [A.3.7]
	consume(start, frequency, n) {
		const unit = this.range >> BigInt(n);
		this.code -= unit * BigInt(start);
		this.range = unit * BigInt(frequency);
		this.renormalise();
	}

	// [A.3.8]
	finish() {
		if (this.read < this.bytes.length) fail('TrailingBytes', 'A.3.8', 'the stream codes was not used up');
	}
}

// ---- [A.3.3] Tokens

class TokenDecoder {
	constructor(bytes) {
		this.bytes = bytes;
		this.offset = 0;
		this.x = [0, 0, 0];
		for (let s = 0; s < 3; ++s) {
			const low = this.word();
			this.x[s] = low + 2 ** 16 * this.word();
			if (this.x[s] < 2 ** 16) fail('Truncated', 'A.3.3', 'a state of the stream tokens is too small');
		}
	}

	word() {
		if (this.offset + 2 > this.bytes.length) fail('Truncated', 'A.3.3', 'the stream tokens ends early');
		this.offset += 2;
		return this.bytes[this.offset - 2] + 256 * this.bytes[this.offset - 1];
	}

	token(s, row, schedule) {
		const slot = this.x[s] % 2 ** 15;
		const symbol = symbolOf(row, slot);
		const start = row.c[symbol];
		const frequency = row.c[symbol + 1] - start;
		this.x[s] = frequency * Math.floor(this.x[s] / 2 ** 15) + slot - start;
		if (this.x[s] < 2 ** 16) this.x[s] = this.x[s] * 2 ** 16 + this.word();
		adapt(row, symbol, schedule);
		return symbol;
	}

	// [A.3.8]
	finish() {
		if (this.offset !== this.bytes.length) fail('TrailingBytes', 'A.3.8', 'the stream tokens was not used up');
		if (this.x.some((x) => x !== 2 ** 16)) fail('TrailingBytes', 'A.3.8', 'a state of the stream tokens is not 2^16');
	}
}

// ---- [A.3.4] Raw bits

class RawDecoder {
	constructor(bytes) {
		this.bytes = bytes;
		this.bits = 0;
	}

	raw(n) {
		let value = 0;
		for (let i = 0; i < n; ++i) value += this.nextBit() * 2 ** i;
		return value;
	}

	nextBit() {
		const byte = this.bits >>> 3;
		if (byte >= this.bytes.length) fail('Truncated', 'A.3.8', 'the stream raw ends early');
		return (this.bytes[byte] >> (this.bits++ & 7)) & 1;
	}

	// [A.3.8]
	finish() {
		if (Math.ceil(this.bits / 8) < this.bytes.length) fail('TrailingBytes', 'A.3.8', 'the stream raw was not used up');
		while (this.bits % 8 !== 0) {
			if (this.nextBit()) fail('TrailingBytes', 'A.3.8', 'an unread bit of the stream raw is not zero');
		}
	}
}

// ---- What the stages read from

class Decoder {
	bit(model) {
		return this.range.bit(model);
	}

	// [A.3.5]
	golomb(model) {
		let length = 0;
		while (length < 31 && this.bit(model.LENGTH[length])) ++length;
		let value = 1;
		let node = 0;
		for (let i = 0; i < Math.min(length, 2); ++i) {
			const b = this.bit(model.MANTISSA[length][node]);
			value = 2 * value + b;
			node = 1 + b;
		}
		if (length > 2) value = value * 2 ** (length - 2) + this.raw(length - 2);
		return value - 1;
	}

	// [A.3.5]
	signedGolomb(model) {
		return unzigzag(this.golomb(model));
	}

	// [A.3.5]
	tree(model) {
		let node = 1;
		for (let i = 0; i < model.bits; ++i) node = 2 * node + this.bit(model.NODE[node]);
		return node - 2 ** model.bits;
	}
}

class GolombModel {
	constructor() {
		this.LENGTH = models([31]);
		this.MANTISSA = models([32, 3]);
	}
}

class TreeModel {
	constructor(bits) {
		this.bits = bits;
		this.NODE = models([2 ** bits]);
	}
}

export const golombs = (dimensions) => models(dimensions, () => new GolombModel());
export const trees = (bits, dimensions) => models(dimensions, () => new TreeModel(bits));

// [A.3.5]
export function uniform(streams, n) {
	const bits = width(n) - 1;
	const shorts = 2 ** (bits + 1) - n;
	const value = streams.raw(bits);
	if (value < shorts) return value;
	return 2 * value + streams.raw(1) - shorts;
}

export class ThreeStreams extends Decoder {
	constructor(codes, tokens, rawBytes) {
		super();
		this.range = new RangeDecoder(codes);
		this.tokens = new TokenDecoder(tokens);
		this.rawBits = new RawDecoder(rawBytes);
	}

	token(s, row, schedule) {
		return this.tokens.token(s, row, schedule);
	}

	raw(n) {
		return this.rawBits.raw(n);
	}

	finish() {
		this.range.finish();
		this.tokens.finish();
		this.rawBits.finish();
	}
}

// [A.3.7] One coder for small payloads
export class SingleCoder extends Decoder {
	constructor(codes) {
		super();
		this.range = new RangeDecoder(codes);
	}

	token(s, row, schedule) {
		const slot = this.range.peek(15);
		const symbol = symbolOf(row, slot);
		const start = row.c[symbol];
		this.range.consume(start, row.c[symbol + 1] - start, 15);
		adapt(row, symbol, schedule);
		return symbol;
	}

	raw(n) {
		let value = 0;
		for (let done = 0; done < n; done += 16) {
			const count = Math.min(n - done, 16);
			const part = this.range.peek(count);
			this.range.consume(part, 1, count);
			value += part * 2 ** done;
		}
		return value;
	}

	finish() {
		this.range.finish();
	}
}
