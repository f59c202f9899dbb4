// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

// Adaptive models and the decoders of symbols [A.3].
//
// A model is a plain object, so that blocks can begin with a copy of all models (structuredClone).

import { unzigzag, width } from './bytes.mjs';
import { failUnless } from './errors.mjs';

// [A.3.1] A binary model: the probability of the outcome 0 in units of 2^-22, and the number of outcomes.
export const binaryModel = () => ({ p: 2 ** 21, n: 0 });

// An array of `count` models, or of whatever else `make` makes.
export const arrayOf = (count, make = binaryModel) => Array.from({ length: count }, (_, i) => make(i));

// [A.3.5] LENGTH[0 .. 30] and MANTISSA[1 .. 31][0 .. 2]
export const golombModel = () => ({ LENGTH: arrayOf(31), MANTISSA: arrayOf(32, () => arrayOf(3)) });

// [A.3.5] NODE[1 .. 2^k - 1]
export const treeModel = (k) => ({ k, NODE: arrayOf(2 ** k) });

// [A.3.1] A row of 16 symbols with its cumulative frequencies; without an argument it is uniform.
export const rowModel = (c = arrayOf(17, (i) => 2048 * i)) => ({ c: [...c], uses: 0 });
const RATE = arrayOf(256, (n) => {
	const d = 5 * n + 8;
	return Math.floor((655360 + d) / (2 * d));
});

// [A.3.1] The products have 38 bits, which a Number holds but an i32 does not.
export function update(M, outcome) {
	if (outcome === 1) M.p -= Math.floor((M.p * RATE[M.n]) / 65536);
	else M.p += Math.floor(((2 ** 22 - M.p) * RATE[M.n]) / 65536);
	M.n = Math.min(M.n + 1, 255);
}

// The shifts of a schedule by the number of uses; firsts[i] is the first number of uses that has shift i + least.
const schedule = (least, firsts) => arrayOf(64, (uses) => least - 1 + firsts.filter((first) => first <= uses).length);
export const POSITIONS = schedule(2, [0, 2, 5, 11, 30, 63]);
export const ATTRIBUTES = schedule(1, [0, 1, 3, 7, 15, 31]);
export function adapt(row, s, shifts) {
	const shift = shifts[row.uses];
	row.uses = Math.min(row.uses + 1, 63);
	for (let i = 1; i <= 15; ++i) {
		const target = 4 * i + (i > s ? 2 ** 15 - 64 : 0);
		row.c[i] += (target - row.c[i]) >> shift;
	}
}

function symbolAt(row, slot) {
	let symbol = 15;
	while (row.c[symbol] > slot) --symbol;
	return symbol;
}

// [A.3.2] Range and code are BigInts, because they have 64 bits.
function createRangeDecoder(bytes) {
	const decoder = { bytes, read: 0, range: 2n ** 64n - 1n, code: 0n };
	decoder.code = word32(decoder) << 32n;
	decoder.code += word32(decoder);
	return decoder;
}

// The next word of `codes`. A decoder that reads more than two words past the end stops at once [A.3.8].
function word32(decoder) {
	const { bytes, read } = decoder;
	let word = 0;
	for (let i = 0; i < 4; ++i) word += (bytes[read + i] ?? 0) * 2 ** (8 * i);
	decoder.read = read + 4;
	failUnless(decoder.read <= bytes.length + 8, 'Truncated', 'A.3.8', 'the stream codes ends too early');
	return BigInt(word);
}

const WORD = 2n ** 32n;
function renormalise(decoder) {
	if (decoder.range >= WORD) return;
	decoder.range <<= 32n;
	decoder.code = BigInt.asUintN(64, decoder.code << 32n) + word32(decoder);
}

// [A.3.2] An adaptive binary decision.
export function bit(coder, M) {
	const decoder = coder.codes, split = (decoder.range >> 22n) * BigInt(M.p);
	const outcome = decoder.code >= split ? 1 : 0;
	if (outcome === 1) {
		decoder.code -= split;
		decoder.range -= split;
	} else {
		decoder.range = split;
	}
	update(M, outcome);
	renormalise(decoder);
	return outcome;
}

// [A.10.10, A.10.19, A.10.20] The models of a decision by its last two outcomes, the outcomes before the first decision,
// and the decision.
const RECENT = 4;
export const recentModels = () => arrayOf(RECENT);
export const noOutcomes = () => ({ hits: 0 });
export function recentBit(coder, models, recent) {
	const hit = bit(coder, models[recent.hits]);
	recent.hits = (2 * recent.hits + hit) % RECENT;
	return hit;
}

// [A.3.7]
const peek = (decoder, n) => Math.min(Number(decoder.code / (decoder.range >> BigInt(n))), 2 ** n - 1);
function consume(decoder, start, frequency, n) {
	const unit = decoder.range >> BigInt(n);
	decoder.code -= unit * BigInt(start);
	decoder.range = unit * BigInt(frequency);
	renormalise(decoder);
}

// [A.3.3] The states are Numbers below 2^32.
function createTokenDecoder(bytes) {
	const decoder = { bytes, read: 0, x: [0, 0, 0] };
	for (let s = 0; s < 3; ++s) {
		const low = word16(decoder);
		decoder.x[s] = low + 65536 * word16(decoder);
		failUnless(decoder.x[s] >= 65536, 'Truncated', 'A.3.3', 'a state of the tokens is too small');
	}
	return decoder;
}

function word16(decoder) {
	const { bytes, read } = decoder;
	failUnless(read + 2 <= bytes.length, 'Truncated', 'A.3.3', 'the stream tokens ends too early');
	decoder.read = read + 2;
	return bytes[read] + 256 * bytes[read + 1];
}

// [A.3.3], with one coder [A.3.7]
export function token(coder, s, row, shifts) {
	const single = coder.tokens === undefined;
	const slot = single ? peek(coder.codes, 15) : coder.tokens.x[s] & 0x7fff;
	const symbol = symbolAt(row, slot), start = row.c[symbol], frequency = row.c[symbol + 1] - start;
	if (single) consume(coder.codes, start, frequency, 15);
	else advance(coder.tokens, s, frequency, slot - start);
	adapt(row, symbol, shifts);
	return symbol;
}

function advance(decoder, s, frequency, rest) {
	const { x } = decoder;
	x[s] = frequency * (x[s] >>> 15) + rest;
	if (x[s] < 65536) x[s] = x[s] * 65536 + word16(decoder);
}

// [A.3.4], with one coder [A.3.7]
export const raw = (coder, n) =>
	(coder.rawBits === undefined ? rawOfSingleCoder(coder.codes, n) : rawOfStream(coder.rawBits, n));

function rawOfSingleCoder(decoder, n) {
	let value = 0;
	for (let done = 0; done < n; done += 16) {
		const count = Math.min(n - done, 16), part = peek(decoder, count);
		consume(decoder, part, 1, count);
		value += part * 2 ** done;
	}
	return value;
}

function rawOfStream(stream, n) {
	failUnless(stream.read + n <= 8 * stream.bytes.length, 'Truncated', 'A.3.8', 'the stream raw ends too early');
	let value = 0;
	for (let i = 0; i < n; ++i) {
		const at = stream.read + i;
		value += ((stream.bytes[Math.floor(at / 8)] >> (at % 8)) & 1) * 2 ** i;
	}
	stream.read += n;
	return value;
}

// [A.3.5] Integers made of these. All are Numbers from 0 to 2^32 - 1.
export function golomb(coder, M) {
	let length = 0;
	while (length < 31 && bit(coder, M.LENGTH[length])) ++length;
	let value = 1, node = 0;
	for (let i = 0; i < Math.min(length, 2); ++i) {
		const b = bit(coder, M.MANTISSA[length][node]);
		value = 2 * value + b;
		node = 1 + b;
	}
	if (length > 2) value = value * 2 ** (length - 2) + raw(coder, length - 2);
	return value - 1;
}
export const signedGolomb = (coder, M) => unzigzag(golomb(coder, M));
export function tree(coder, M) {
	let node = 1;
	for (let i = 0; i < M.k; ++i) node = 2 * node + bit(coder, M.NODE[node]);
	return node - 2 ** M.k;
}

export function uniform(coder, n) {
	const bits = width(n) - 1, shorts = 2 ** (bits + 1) - n, value = raw(coder, bits);
	if (value < shorts) return value;
	return 2 * value + raw(coder, 1) - shorts;
}

// [A.3] The decoder of one stream, or of three: `streams` has codes and, unless SINGLE_CODER, tokens and raw.
export function createCoder(streams) {
	const codes = createRangeDecoder(streams.codes);
	if (streams.tokens === undefined) return { codes };
	return { codes, tokens: createTokenDecoder(streams.tokens), rawBits: { bytes: streams.raw, read: 0 } };
}

// [A.3.8] That the streams hold too little has been noticed before; here they must not hold too much.
export function checkEnds({ codes, tokens, rawBits }) {
	const used = (condition, name) => failUnless(condition, 'TrailingBytes', 'A.3.8', `bytes are left over in ${name}`);
	used(codes.read >= codes.bytes.length, 'codes');
	if (tokens === undefined) return;
	used(tokens.read === tokens.bytes.length && tokens.x.every((x) => x === 65536), 'tokens');
	used(Math.ceil(rawBits.read / 8) === rawBits.bytes.length, 'raw');
	const unread = 8 * rawBits.bytes.length - rawBits.read;
	used(unread === 0 || rawBits.bytes[rawBits.bytes.length - 1] >> (8 - unread) === 0, 'raw');
}
