// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

// GLB files and the layout of accessors, as glTF 2.0 says; of the draft of 2.1, GLB version 3 with one BIN chunk, and int32.

// What is wrong with a file, but not with a payload.
export class DocumentError extends Error {
	constructor(message) {
		super(message);
		this.name = 'DocumentError';
		this.kind = 'document';
	}
}

const MAGIC = 0x46546c67, JSON_CHUNK = 0x4e4f534a, BIN_CHUNK = 0x004e4942;

export const COMPONENTS = { SCALAR: 1, VEC2: 2, VEC3: 3, VEC4: 4, MAT2: 4, MAT3: 9, MAT4: 16 };
const ROWS_OF_MATRIX = { MAT2: 2, MAT3: 3, MAT4: 4 };
export const BYTES = { 5120: 1, 5121: 1, 5122: 2, 5123: 2, 5124: 4, 5125: 4, 5126: 4 };

const aligned = (n, to) => Math.ceil(n / to) * to;

export function readGlb(bytes) {
	const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
	if (bytes.length < 20 || view.getUint32(0, true) !== MAGIC) throw new DocumentError('not a GLB file');
	const chunks = readChunks(bytes, view);
	const dataOf = (type) => chunks.find((chunk) => chunk.type === type)?.data;
	const text = dataOf(JSON_CHUNK);
	if (text === undefined) throw new DocumentError('no JSON chunk');
	const json = JSON.parse(new TextDecoder().decode(text));
	const [first, ...others] = json.buffers ?? [];
	if (others.some(({ chunk }) => chunk !== undefined)) throw new DocumentError('only one BIN chunk can be read');
	const bin = first?.chunk === undefined ? dataOf(BIN_CHUNK) : chunks[first.chunk]?.data;
	delete first?.chunk; // what is written is of version 2, where the first buffer has the only one
	return { json, bin };
}

// Version 3 has longer headers, lengths of 64 bits, and chunks at multiples of 8.
function readChunks(bytes, view) {
	const isVersion3 = view.getUint32(4, true) === 3;
	const headerBytes = isVersion3 ? 16 : 8;
	const chunks = [];
	for (let offset = isVersion3 ? 16 : 12; offset + headerBytes <= bytes.length;) {
		const { type, encoding, length } = isVersion3
			? { type: view.getUint32(offset, true), encoding: view.getUint32(offset + 4, true), length: Number(view.getBigUint64(offset + 8, true)) }
			: { type: view.getUint32(offset + 4, true), encoding: 0, length: view.getUint32(offset, true) };
		const begin = offset + headerBytes;
		if (encoding !== 0) throw new DocumentError('a chunk is encoded');
		if (begin + length > bytes.length) throw new DocumentError('a chunk exceeds the file');
		chunks.push({ type, data: bytes.subarray(begin, begin + length) });
		offset = begin + aligned(length, isVersion3 ? 8 : 4);
	}
	return chunks;
}

export function writeGlb(json, bin) {
	const text = new TextEncoder().encode(JSON.stringify(json));
	const chunks = [chunk(JSON_CHUNK, text, 0x20)];
	if (bin.length !== 0) chunks.push(chunk(BIN_CHUNK, bin, 0));
	const header = new DataView(new ArrayBuffer(12));
	header.setUint32(0, MAGIC, true);
	header.setUint32(4, 2, true);
	header.setUint32(8, 12 + chunks.reduce((sum, c) => sum + c.length, 0), true);
	return concatenate([new Uint8Array(header.buffer), ...chunks]);
}

function chunk(type, data, padding) {
	const bytes = new Uint8Array(8 + aligned(data.length, 4)).fill(padding);
	const view = new DataView(bytes.buffer);
	view.setUint32(0, bytes.length - 8, true);
	view.setUint32(4, type, true);
	bytes.set(data, 8);
	return bytes;
}

export function concatenate(arrays) {
	const result = new Uint8Array(arrays.reduce((sum, a) => sum + a.length, 0));
	let offset = 0;
	for (const a of arrays) {
		result.set(a, offset);
		offset += a.length;
	}
	return result;
}

export function bytesOfView(gltf, number) {
	const view = gltf.json.bufferViews?.[number];
	if (view === undefined) throw new DocumentError(`buffer view ${number} does not exist`);
	const buffer = gltf.json.buffers[view.buffer];
	if (view.buffer !== 0 || buffer.uri !== undefined || gltf.bin === undefined) throw new DocumentError('only the BIN chunk can be read');
	const begin = view.byteOffset ?? 0;
	if (begin + view.byteLength > gltf.bin.length) throw new DocumentError(`buffer view ${number} exceeds its buffer`);
	return gltf.bin.subarray(begin, begin + view.byteLength);
}

// Where the components of an element are, in bytes, and its size; matrices have columns that begin at multiples of four.
export function layout(accessor) {
	const size = BYTES[accessor.componentType];
	const count = COMPONENTS[accessor.type];
	const rows = ROWS_OF_MATRIX[accessor.type] ?? count;
	const column = ROWS_OF_MATRIX[accessor.type] === undefined ? rows * size : aligned(rows * size, 4);
	const offsets = Array.from({ length: count }, (_, c) => Math.floor(c / rows) * column + (c % rows) * size);
	return { size, offsets, elementBytes: column * (count / rows) };
}

// The components of an accessor, one after another without gaps, as bytes.
export function readAccessor(gltf, number) {
	const accessor = gltf.json.accessors[number];
	const { size, offsets } = layout(accessor);
	const result = new Uint8Array(accessor.count * offsets.length * size);
	if (accessor.bufferView !== undefined) readElements(gltf, accessor, accessor.bufferView, accessor.byteOffset ?? 0, result);
	if (accessor.sparse !== undefined) readSparse(gltf, accessor, result);
	return result;
}

function readElements(gltf, accessor, viewNumber, offset, result) {
	const { size, offsets, elementBytes } = layout(accessor);
	const source = bytesOfView(gltf, viewNumber);
	const stride = gltf.json.bufferViews[viewNumber].byteStride ?? elementBytes;
	let to = 0;
	for (let i = 0; i < result.length / (offsets.length * size); ++i) {
		for (const at of offsets) {
			const from = offset + i * stride + at;
			if (from + size > source.length) throw new DocumentError('an accessor exceeds its buffer view');
			for (let k = 0; k < size; ++k) result[to++] = source[from + k];
		}
	}
}

function readSparse(gltf, accessor, result) {
	const { count, indices, values } = accessor.sparse;
	const elementSize = result.length / accessor.count;
	const places = new Uint8Array(count * BYTES[indices.componentType]);
	const scalar = { type: 'SCALAR', componentType: indices.componentType };
	readElements(gltf, scalar, indices.bufferView, indices.byteOffset ?? 0, places);
	const elements = new Uint8Array(count * elementSize);
	readElements(gltf, accessor, values.bufferView, values.byteOffset ?? 0, elements);
	for (let i = 0; i < count; ++i) {
		const place = unsignedAt(places, i, BYTES[indices.componentType]);
		result.set(elements.subarray(i * elementSize, (i + 1) * elementSize), place * elementSize);
	}
}

function unsignedAt(bytes, i, size) {
	let value = 0;
	for (let k = 0; k < size; ++k) value += bytes[i * size + k] * 2 ** (8 * k);
	return value;
}
