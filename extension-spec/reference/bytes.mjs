// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

// Fields of a header, integers and checksums [A.1.1, A.1.2, A.1.3].

import { fail, failUnless } from './errors.mjs';

// [A.1.1] A place in the bytes of a payload.
export const createReader = (bytes) => ({ bytes, offset: 0 });
export const remaining = (reader) => reader.bytes.length - reader.offset;
export function u8(reader) {
	failUnless(remaining(reader) > 0, 'Truncated', 'A.2.1', 'the payload ends inside a field');
	return reader.bytes[reader.offset++];
}

// An unsigned integer of `count` bytes, at most four.
export function unsigned(reader, count) {
	let value = 0;
	for (let i = 0; i < count; ++i) value += u8(reader) * 2 ** (8 * i);
	return value;
}
export const u32 = (reader) => unsigned(reader, 4);
export function varint(reader) {
	let value = 0;
	for (let i = 0; ; ++i) {
		const byte = u8(reader);
		if (i === 4 && byte > 15) fail('BadHeader', 'A.1.1', 'a varint exceeds 32 bits');
		value += (byte % 128) * 2 ** (7 * i);
		if (byte < 128) {
			if (byte === 0 && i !== 0) fail('BadHeader', 'A.1.1', 'a varint is longer than needed');
			return value;
		}
	}
}

// [A.1.1] u is below 2^32, so that the result is an i32.
export const unzigzag = (u) => (u % 2 === 0 ? u / 2 : -(u + 1) / 2);
export const zigzag = (reader) => unzigzag(varint(reader));
export function take(reader, count) {
	failUnless(count <= remaining(reader), 'Truncated', 'A.2.5', 'fewer bytes remain than a length says');
	reader.offset += count;
	return reader.bytes.subarray(reader.offset - count, reader.offset);
}

// [A.1.2] The number of binary digits of an integer from 0 to 2^32 - 1.
export const width = (x) => 32 - Math.clz32(x);
const CRC_TABLE = Uint32Array.from({ length: 256 }, (_, byte) => {
	let crc = byte;
	for (let i = 0; i < 8; ++i) crc = crc & 1 ? (crc >>> 1) ^ 0xedb88320 : crc >>> 1;
	return crc;
});

// [A.1.3] The CRC-32 of several runs of bytes, one after the other.
export function crc32(...runs) {
	let crc = 0xffffffff;
	for (const bytes of runs) for (const byte of bytes) crc = (crc >>> 8) ^ CRC_TABLE[(crc ^ byte) & 255];
	return ~crc >>> 0;
}
