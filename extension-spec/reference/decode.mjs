// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

// Writes a GLB without KHR_mesh_collapse_compression: node decode.mjs IN.glb OUT.glb

import { readFileSync, writeFileSync } from 'node:fs';
import { argv, exit } from 'node:process';
import { concatenate, layout, readGlb, writeGlb } from './glb.mjs';
import { isMain } from './main.mjs';
import { decodePayload } from './payload.mjs';
import { EXTENSION, checkDocument, extensionOf, primitivesOf } from './restrictions.mjs';

// The bytes of the decoded file. All checks of the document come before anything is decoded.
export function decodeGlb(bytes) {
	const gltf = readGlb(bytes);
	const { headers, sources } = checkDocument(gltf);
	const payloads = new Map([...headers].map(([view, header]) => [view, decodePayload(header)]));
	const output = createOutput(gltf);
	for (const [number, source] of sources) {
		const accessor = gltf.json.accessors[number];
		accessor.bufferView = viewOf(output, payloads.get(source.view)[source.piece], source, accessor);
		delete accessor.byteOffset;
		delete accessor.sparse;
	}
	removeExtension(gltf);
	return finishOutput(output);
}

// What is appended to the buffer: `views` are the numbers of the new buffer views by what they hold.
function createOutput(gltf) {
	const bin = gltf.bin ?? new Uint8Array();
	return { gltf, chunks: [bin], length: bin.length, views: new Map() };
}

function finishOutput({ gltf, chunks, length }) {
	if (gltf.json.buffers?.[0] !== undefined && gltf.bin !== undefined) gltf.json.buffers[0].byteLength = length;
	return writeGlb(gltf.json, concatenate(chunks));
}

// The buffer view that holds the elements of a source. Accessors with the same elements share it.
function viewOf(output, piece, source, accessor) {
	const { view, piece: number, part, attribute } = source;
	const key = [view, number, part, attribute, accessor.componentType].join();
	if (!output.views.has(key)) {
		const isPart = part !== undefined;
		const elements = isPart ? indexBytes(piece.indices(part), accessor) : piece.elements(attribute);
		output.views.set(key, append(output, isPart ? { bytes: elements } : padded(elements, accessor)));
	}
	return output.views.get(key);
}

function indexBytes(indices, accessor) {
	const { size } = layout(accessor);
	const bytes = new Uint8Array(indices.length * size);
	indices.forEach((index, i) => { for (let k = 0; k < size; ++k) bytes[i * size + k] = index >>> (8 * k); });
	return bytes;
}

// glTF aligns the elements of vertex attributes, and the columns of matrices, to multiples of four bytes.
function padded(elements, accessor) {
	const { size, offsets, elementBytes } = layout(accessor);
	const byteStride = Math.ceil(elementBytes / 4) * 4;
	const bytes = new Uint8Array(accessor.count * byteStride);
	let from = 0;
	for (let i = 0; i < accessor.count; ++i) {
		for (const offset of offsets) {
			bytes.set(elements.subarray(from, from + size), i * byteStride + offset);
			from += size;
		}
	}
	return byteStride === elementBytes ? { bytes } : { bytes, byteStride };
}

function append(output, { bytes, byteStride }) {
	const { bufferViews } = output.gltf.json;
	const gap = -output.length & 3;
	const view = { buffer: 0, byteOffset: output.length + gap, byteLength: bytes.length };
	if (byteStride !== undefined) view.byteStride = byteStride;
	output.chunks.push(new Uint8Array(gap), bytes);
	output.length += gap + bytes.length;
	return bufferViews.push(view) - 1;
}

function removeExtension(gltf) {
	for (const primitive of primitivesOf(gltf)) {
		if (extensionOf(primitive) === undefined) continue;
		delete primitive.extensions[EXTENSION];
		if (Object.keys(primitive.extensions).length === 0) delete primitive.extensions;
	}
	for (const list of ['extensionsUsed', 'extensionsRequired']) {
		const names = gltf.json[list]?.filter((name) => name !== EXTENSION) ?? [];
		if (names.length === 0) delete gltf.json[list];
		else gltf.json[list] = names;
	}
}

function main() {
	if (argv.length !== 4) {
		console.error('usage: node decode.mjs IN.glb OUT.glb');
		return 2;
	}
	try {
		writeFileSync(argv[3], decodeGlb(readFileSync(argv[2])));
		return 0;
	} catch (error) {
		console.error(`${argv[2]}: ${error.message.split('\n')[0]}`);
		return 1;
	}
}

if (isMain(import.meta)) exit(main());
