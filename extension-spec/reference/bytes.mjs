// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

// Bytes, integers and errors: A.1 of the specification.

// [A.1.4] Errors
export const KINDS = ['', 'Truncated', 'BadMagic', 'UnsupportedVersion', 'BadChecksum', 'BadHeader',
	'BadConnectivity', 'BadStitch', 'BadAttribute', 'TrailingBytes', 'Limit'];

export class PayloadError extends Error {
	constructor(kind, section, message) {
		super(`${kind} [${section}]: ${message}`);
		this.name = 'PayloadError';
		this.kind = kind;
		this.number = KINDS.indexOf(kind);
		this.section = section;
	}
}

export function fail(kind, section, message) {
	throw new PayloadError(kind, section, message);
}

// [A.1.2] The smallest w with x < 2^w, of a Number or of a BigInt x >= 0.
export function width(x) {
	return x <= 0 ? 0 : x.toString(2).length;
}

// [A.1.1]
export function unzigzag(u) {
	return u % 2 === 0 ? u / 2 : -(u + 1) / 2;
}

// [A.1.1] Reads fields one after another.
export class ByteReader {
	constructor(bytes) {
		this.bytes = bytes;
		this.offset = 0;
	}

	remaining() {
		return this.bytes.length - this.offset;
	}

	u8() {
		if (this.remaining() < 1) fail('Truncated', 'A.2.1', 'the payload ends inside a field');
		return this.bytes[this.offset++];
	}

	u32() {
		return this.highBytes(4);
	}

	// The highest bytes of a u32, whose other bytes are 0
	highBytes(count) {
		let value = 0;
		for (let i = 4 - count; i < 4; ++i) value += this.u8() * 2 ** (8 * i);
		return value;
	}

	varint() {
		let value = 0;
		for (let i = 0; ; ++i) {
			const byte = this.u8();
			if (i === 4 && byte > 15) fail('BadHeader', 'A.1.1', 'a varint exceeds 32 bits');
			value += (byte % 128) * 2 ** (7 * i);
			if (byte < 128) {
				if (byte === 0 && i !== 0) fail('BadHeader', 'A.1.1', 'a varint has a superfluous byte');
				return value;
			}
		}
	}

	zigzag() {
		return unzigzag(this.varint());
	}

	// The next `length` bytes.
	take(length) {
		if (length > this.remaining()) fail('Truncated', 'A.2.5', 'fewer bytes remain than a length says');
		this.offset += length;
		return this.bytes.subarray(this.offset - length, this.offset);
	}
}

const converter = new DataView(new ArrayBuffer(4));

export function floatOfBits(bits) {
	converter.setUint32(0, bits);
	return converter.getFloat32(0);
}

// The bits of a number that binary32 holds. Not for NaN, whose bits a Number does not keep.
export function bitsOfFloat(x) {
	converter.setFloat32(0, x);
	return converter.getUint32(0);
}

// [A.1.3] CRC-32 of several byte arrays, one after the other.
export function crc32(...arrays) {
	let crc = 0xffffffff;
	for (const bytes of arrays) {
		for (const byte of bytes) {
			crc ^= byte;
			for (let k = 0; k < 8; ++k) crc = crc & 1 ? (crc >>> 1) ^ 0xedb88320 : crc >>> 1;
		}
	}
	return (crc ^ 0xffffffff) >>> 0;
}
