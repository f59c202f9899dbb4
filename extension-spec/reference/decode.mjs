// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

// Writes a GLB without KHR_mesh_collapse_compression: node decode.mjs IN.glb OUT.glb
// The accessors are the same, in the same order; those that were compressed get buffer views of their own.

import { readFileSync, writeFileSync } from 'node:fs';
import { argv, exit } from 'node:process';
import { bytesOfView, concatenate, layout, readGlb, writeGlb } from './glb.mjs';
import { isMain } from './main.mjs';
import { Payload } from './payload.mjs';
import { checkAccessors, checkFallback, checkManifolds, checkPiece, checkPrimitive, compressedPrimitives, EXTENSION,
	sourcesOf } from './restrictions.mjs';

const ARRAY_BUFFER = 34962, ELEMENT_ARRAY_BUFFER = 34963;

class Loader {
	constructor(gltf) {
		this.gltf = gltf;
		this.json = structuredClone(gltf.json);
		this.bin = [gltf.bin ?? new Uint8Array(0)];
		this.payloads = new Map(); // by buffer view
	}

	// The JSON and the BIN chunk without the extension. Everything that can be checked is, before a payload is decoded.
	decode() {
		const primitives = compressedPrimitives(this.json);
		for (const primitive of primitives) this.open(primitive);
		checkAccessors(this.json);
		checkFallback(this.json);
		checkManifolds(this.json, (primitive) => this.pieceHeader(primitive));
		const decoded = new Map([...this.payloads].map(([view, payload]) => [view, payload.decode()]));
		this.filled = new Set(); // accessors
		for (const primitive of primitives) this.fillPrimitive(primitive, decoded);
		this.removeExtension(primitives);
		if (this.json.buffers?.[0] !== undefined) this.json.buffers[0].byteLength = this.length();
		return { json: this.json, bin: concatenate(this.bin) };
	}

	open(primitive) {
		checkPrimitive(this.json, primitive);
		const { bufferView: view } = primitive.extensions[EXTENSION];
		if (!this.payloads.has(view)) this.payloads.set(view, new Payload(bytesOfView(this.gltf, view)));
		checkPiece(this.json, primitive, this.pieceHeader(primitive));
	}

	pieceHeader(primitive) {
		const { bufferView: view, piece = 0 } = primitive.extensions[EXTENSION];
		return this.payloads.get(view).pieces[piece];
	}

	// ---- Accessors

	fillPrimitive(primitive, decoded) {
		const { bufferView: view, piece: pieceNumber = 0, part = 0 } = primitive.extensions[EXTENSION];
		const piece = decoded.get(view)[pieceNumber];
		this.fill(primitive.indices, (accessor) => indexView(accessor, piece.parts[part]));
		for (const { accessor: number, attribute } of sourcesOf(primitive)) {
			this.fill(number, (accessor) => elementView(accessor, piece.elements[attribute]));
		}
	}

	// Primitives may share accessors.
	fill(number, makeView) {
		if (this.filled.has(number)) return;
		this.filled.add(number);
		const accessor = this.json.accessors[number];
		const { bytes, ...properties } = makeView(accessor);
		this.bin.push(new Uint8Array((4 - (this.length() % 4)) % 4));
		accessor.bufferView = this.json.bufferViews.length;
		delete accessor.byteOffset;
		delete accessor.sparse;
		this.json.bufferViews.push({ buffer: 0, byteOffset: this.length(), byteLength: bytes.length, ...properties });
		this.bin.push(bytes);
	}

	length() {
		return this.bin.reduce((sum, bytes) => sum + bytes.length, 0);
	}

	// ---- The JSON without the extension

	removeExtension(primitives) {
		for (const primitive of primitives) {
			delete primitive.extensions[EXTENSION];
			if (Object.keys(primitive.extensions).length === 0) delete primitive.extensions;
		}
		for (const name of ['extensionsUsed', 'extensionsRequired']) {
			const list = this.json[name]?.filter((extension) => extension !== EXTENSION);
			if (list?.length > 0) this.json[name] = list;
			else delete this.json[name];
		}
	}
}

function indexView(accessor, triangles) {
	const { size } = layout(accessor);
	const bytes = new Uint8Array(accessor.count * size);
	triangles.flat().forEach((place, i) => {
		for (let k = 0; k < size; ++k) bytes[i * size + k] = place >>> (8 * k);
	});
	return { bytes, target: ELEMENT_ARRAY_BUFFER };
}

// [A.9.4] Elements begin at multiples of four bytes, and so do the columns of matrices.
function elementView(accessor, elements) {
	const { size, offsets, elementBytes } = layout(accessor);
	const byteStride = Math.ceil(elementBytes / 4) * 4;
	const bytes = new Uint8Array(elements.length * byteStride);
	elements.forEach((element, i) => offsets.forEach((offset, c) => {
		bytes.set(element.subarray(c * size, (c + 1) * size), i * byteStride + offset);
	}));
	return { bytes, byteStride, target: ARRAY_BUFFER };
}

export function decodeGlb(bytes) {
	const { json, bin } = new Loader(readGlb(bytes)).decode();
	return writeGlb(json, bin);
}

if (isMain(import.meta)) {
	if (argv.length !== 4) {
		console.error('usage: node decode.mjs IN.glb OUT.glb');
		exit(2);
	}
	try {
		writeFileSync(argv[3], decodeGlb(readFileSync(argv[2])));
	} catch (error) {
		console.error(`${argv[2]}: ${error.message}`);
		exit(1);
	}
}
