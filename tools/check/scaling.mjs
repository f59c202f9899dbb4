#!/usr/bin/env node
// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// tools/check/scaling.mjs PROGRAM [N [KIND...]]: measures the processor time of convert, decode and
// validate for documents with N, 2 N and 4 N of one thing. Linear time doubles from column to
// column.
import { execFileSync } from 'node:child_process';
import { mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';

const FLOAT = 5126;
const UNSIGNED_SHORT = 5123;

class Builder {
	json = { asset: { version: '2.0' }, bufferViews: [], accessors: [], meshes: [] };
	chunks = [];
	length = 0;

	addView(bytes) {
		const padded = Buffer.concat([Buffer.from(bytes.buffer, bytes.byteOffset, bytes.byteLength), Buffer.alloc(-bytes.byteLength & 3)]);
		this.json.bufferViews.push({ buffer: 0, byteOffset: this.length, byteLength: bytes.byteLength });
		this.chunks.push(padded);
		this.length += padded.length;
		return this.json.bufferViews.length - 1;
	}
	addAccessor(accessor) {
		return this.json.accessors.push(accessor) - 1;
	}
	addPositions(values) {
		const of = (choose) => [0, 1, 2].map((c) => Math.fround(choose(...values.filter((_, i) => i % 3 === c))));
		return this.addAccessor({ bufferView: this.addView(Float32Array.from(values)), componentType: FLOAT,
			count: values.length / 3, type: 'VEC3', min: of(Math.min), max: of(Math.max) });
	}
	addIndices(values) {
		return this.addAccessor({ bufferView: this.addView(Uint16Array.from(values)), componentType: UNSIGNED_SHORT,
			count: values.length, type: 'SCALAR' });
	}
	addMesh(primitives) {
		this.json.meshes.push({ primitives });
	}
	toGlb() {
		this.json.buffers = [{ byteLength: this.length }];
		const text = Buffer.from(JSON.stringify(this.json));
		const json = Buffer.concat([text, Buffer.alloc(-text.length & 3, ' ')]);
		const words = (...values) => new Uint8Array(Uint32Array.from(values).buffer);
		const chunk = (type, bytes) => Buffer.concat([words(bytes.length, type), bytes]);
		const body = Buffer.concat([chunk(0x4e4f534a, json), chunk(0x004e4942, Buffer.concat(this.chunks))]);
		return Buffer.concat([words(0x46546c67, 2, 12 + body.length), body]);
	}
}

// Makes a bumpy sheet of 2 n² triangles: [positions, indices].
function sheet(n, seed = 0) {
	const positions = [];
	const indices = [];
	for (let y = 0; y <= n; ++y) {
		for (let x = 0; x <= n; ++x) positions.push(x / n, y / n, 0.1 * Math.sin((6 * x) / n + seed));
	}
	for (let y = 0; y < n; ++y) {
		for (let x = 0; x < n; ++x) {
			const a = y * (n + 1) + x;
			indices.push(a, a + 1, a + n + 2, a, a + n + 2, a + n + 1);
		}
	}
	return [positions, indices];
}

function primitive(b, [positions, indices]) {
	return { attributes: { POSITION: b.addPositions(positions) }, indices: b.addIndices(indices) };
}

function tinyPrimitives(b, n) {
	return Array.from({ length: n }, (_, i) => primitive(b, [[9 + 2 * i, 0, 0, 10 + 2 * i, 0, 0, 9 + 2 * i, 1, 0.5], [0, 1, 2]]));
}

const KINDS = {
	'tiny primitives of a mesh': (b, n) => b.addMesh(tinyPrimitives(b, n)),
	'tiny primitives beside a large one': (b, n) => b.addMesh([primitive(b, sheet(100)), ...tinyPrimitives(b, n)]),
	'small primitives of a mesh': (b, n) => b.addMesh(Array.from({ length: n }, (_, i) => primitive(b, sheet(5, i)))),
	'primitives that draw one part': (b, n) => b.addMesh(Array(n).fill(primitive(b, sheet(100)))),
	'payloads that share accessors in a chain': (b, n) => {
		const positions = Array.from({ length: n + 1 }, (_, i) => b.addPositions(sheet(3)[0].map((x, k) => x + Math.sin(i * 49 + k * k))));
		const indices = b.addIndices(sheet(3)[1]);
		for (let i = 0; i < n; ++i) b.addMesh([{ attributes: { POSITION: positions[i], _NEXT: positions[i + 1] }, indices }]);
	},
	'keys of one object': (b, n) => {
		b.addMesh([primitive(b, sheet(30))]);
		b.json.extras = Object.fromEntries(Array.from({ length: n }, (_, i) => [`key ${i}`, i]));
	},
	'accessors in one view': (b, n) => {
		b.addMesh([primitive(b, sheet(30))]);
		const bufferView = b.addView(new Uint8Array(4 * n));
		for (let i = 0; i < n; ++i) b.addAccessor({ bufferView, byteOffset: 4 * i, componentType: FLOAT, count: 1, type: 'SCALAR' });
	},
	'meshes': (b, n) => {
		for (let i = 0; i < n; ++i) b.addMesh([primitive(b, sheet(3, i))]);
	},
};

// Measures the processor time of a command, which does not depend on what else runs.
function secondsOf(program, words) {
	try {
		const script = '"$@" > /dev/null 2>&1 || echo failed; times';
		const lines = execFileSync('bash', ['-c', script, 'bash', program, ...words], { encoding: 'utf8', timeout: 300000 }).trim().split('\n');
		if (lines[0] === 'failed') return 'failed';
		const [minutes, seconds] = lines.at(-1).split(' ')[0].split('m').map(parseFloat);
		return (60 * minutes + seconds).toFixed(2);
	} catch {
		return '> 300';
	}
}

const [program, size = '1000', ...kinds] = process.argv.slice(2);
if (program === undefined) {
	console.error('usage: tools/check/scaling.mjs PROGRAM [N [KIND...]]');
	process.exit(2);
}
const folder = mkdtempSync(join(tmpdir(), 'scaling-'));
const [source, converted, decoded] = ['a.glb', 'b.glb', 'c.glb'].map((name) => join(folder, name));
console.log('| convert / decode / validate, s | n | 2 n | 4 n |\n|---|---|---|---|');
for (const [kind, build] of Object.entries(KINDS)) {
	if (kinds.length !== 0 && !kinds.includes(kind)) continue;
	const cells = [1, 2, 4].map((factor) => {
		const builder = new Builder();
		build(builder, factor * Number(size));
		writeFileSync(source, builder.toGlb());
		return [['convert', source, converted, '--compare', 'none', '-q'], ['decode', converted, decoded, '-q'], ['validate', converted]]
			.map((words) => secondsOf(program, words)).join(' / ');
	});
	console.log(`| ${kind} | ${cells.join(' | ')} |`);
}
rmSync(folder, { recursive: true });
