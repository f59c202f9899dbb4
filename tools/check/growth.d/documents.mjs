#!/usr/bin/env node
// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// tools/check/growth documents PROGRAM [N [KIND...]]: measures the processor time and the peak
// memory of convert, decode, inspect and validate for documents with N, 2 N and 4 N of one thing,
// among them documents that nobody but an attacker would make. Linear time and memory double from
// column to column. KIND is a part of a name in the table. PROGRAM is a path from the root, or absolute.
import { execFileSync } from 'node:child_process';
import { existsSync, mkdtempSync, readFileSync, rmSync, statSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join, resolve } from 'node:path';
import { glbOf } from '../../../tests/web/support/glb.mjs';

const FLOAT = 5126;
const UNSIGNED_BYTE = 5121;
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
		this.json.buffers = [{ byteLength: this.length }, ...(this.json.buffers ?? [])];
		return glbOf(this.json, Buffer.concat(this.chunks));
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
	'members of the root, and accessors': (b, n) => {
		b.json = { asset: b.json.asset, ...Object.fromEntries(range(10 * n).map((i) => [`member ${i}`, 0])), ...b.json };
		b.addMesh([primitive(b, sheet(30))]);
		const bufferView = b.addView(new Uint8Array(40 * n));
		for (let i = 0; i < 10 * n; ++i) b.addAccessor({ bufferView, byteOffset: 4 * i, componentType: FLOAT, count: 1, type: 'SCALAR' });
	},
	'members of the root, and primitives': (b, n) => {
		b.json = { asset: b.json.asset, ...Object.fromEntries(range(10 * n).map((i) => [`member ${i}`, 0])), ...b.json };
		b.addMesh(range(n).map((i) => primitive(b, sheet(3, i))));
	},
	'pieces over the same bytes': (b, n) => {
		const values = sheet(Math.ceil(Math.sqrt(20 * n)))[0];
		const bufferView = b.addView(Float32Array.from(values));
		const count = values.length / 3 - n;
		b.addMesh(range(n).map((i) => ({ attributes: { POSITION: b.addAccessor({ bufferView, byteOffset: 12 * i, componentType: FLOAT,
			count: count - (count % 3), type: 'VEC3', min: [0, 0, -1], max: [1, 1, 1] }) } })));
	},
	'indices over the same bytes': (b, n) => {
		const [positions, indices] = sheet(60);
		const all = range(Math.ceil(n / 100)).flatMap(() => indices);
		const bufferView = b.addView(Uint16Array.from(all));
		const POSITION = b.addPositions(positions);
		const count = all.length - 3 * n;
		b.addMesh(range(n).map((i) => ({ attributes: { POSITION }, indices: b.addAccessor({ bufferView, byteOffset: 6 * i,
			componentType: UNSIGNED_SHORT, count: count > 0 ? count - (count % 3) : 3, type: 'SCALAR' }) })));
	},
	'meshes that overlap in a pile': (b, n) => {
		const values = range(9 * n + 9).map((i) => Math.sin(i * i));
		const bufferView = b.addView(Float32Array.from(values));
		for (let i = 0; i < n; ++i) {
			b.addMesh([{ attributes: { POSITION: b.addAccessor({ bufferView, byteOffset: 12 * i, componentType: FLOAT,
				count: 3 * Math.floor((3 * n - 2 * i) / 3), type: 'VEC3', min: [-1, -1, -1], max: [1, 1, 1] }) } }]);
		}
	},
	'accessors over the same bytes': (b, n) => {
		b.addMesh([primitive(b, sheet(30))]);
		const bufferView = b.addView(new Uint8Array(400 * n));
		for (let i = 0; i < n; ++i) b.addAccessor({ bufferView, byteOffset: 4 * i, componentType: FLOAT, count: 100 * n - i, type: 'SCALAR' });
	},
	'sparse accessors over the same bytes': (b, n) => {
		b.addMesh([primitive(b, sheet(30))]);
		const bufferView = b.addView(new Uint8Array(400 * n));
		for (let i = 0; i < n; ++i) {
			b.addAccessor({ bufferView, componentType: FLOAT, count: 100 * n - i, type: 'SCALAR', sparse: { count: 1,
				indices: { bufferView, componentType: UNSIGNED_BYTE }, values: { bufferView } } });
		}
	},
	'images of one view': (b, n) => {
		b.addMesh([primitive(b, sheet(30))]);
		const bufferView = b.addView(new Uint8Array(400 * n));
		b.json.images = Array(n).fill({ bufferView, mimeType: 'image/png' });
	},
	'views of the same bytes': (b, n) => {
		b.addMesh([primitive(b, sheet(30))]);
		b.addView(new Uint8Array(400 * n));
		const view = b.json.bufferViews.at(-1);
		for (let i = 0; i < n; ++i) b.json.bufferViews.push({ ...view, byteOffset: view.byteOffset + i, byteLength: view.byteLength - i });
		b.json.extensionsUsed = ['NOBODY_knows_this'];
	},
	'buffers': (b, n) => {
		b.addMesh([primitive(b, sheet(30))]);
		b.json.buffers = Array(n).fill({ byteLength: 3, uri: 'data:application/octet-stream;base64,AAAA' });
	},
	'buffers without bytes': (b, n) => {
		b.addMesh([primitive(b, sheet(30))]);
		b.json.buffers = Array(n).fill({ byteLength: 3 });
		for (let i = 0; i < n; ++i) b.json.bufferViews.push({ buffer: i + 1, byteLength: 3 });
	},
	'nodes, skins, animations of one accessor': (b, n) => {
		b.addMesh([primitive(b, sheet(30))]);
		const matrices = b.addAccessor({ bufferView: b.addView(new Float32Array(16 * n)), componentType: FLOAT, count: n, type: 'MAT4' });
		b.json.nodes = range(n).map((i) => ({ mesh: 0, skin: i }));
		b.json.skins = range(n).map(() => ({ joints: [0], inverseBindMatrices: matrices }));
		b.json.animations = range(n).map(() => ({ samplers: [{ input: matrices, output: matrices }], channels: [] }));
	},
	'numbers below many keys of views': (b, n) => {
		b.addMesh([primitive(b, sheet(30))]);
		let extras = range(100 * n);
		for (let i = 0; i < 200; ++i) extras = { bufferViewAccessor: extras };
		b.json.extras = extras;
	},
	'names of extensions': (b, n) => {
		b.addMesh([primitive(b, sheet(30))]);
		b.json.extensionsUsed = range(10 * n).map((i) => `EXT_${i}`);
	},
	'members of an accessor, and pieces': (b, n) => {
		const [positions, indices] = sheet(3);
		const NORMAL = b.addPositions(positions);
		b.json.accessors[NORMAL].extras = Object.fromEntries(range(10 * n).map((i) => [`member ${i}`, 0]));
		const shared = b.addIndices(indices);
		b.addMesh(range(n).map((i) => ({ attributes: { POSITION: b.addPositions(sheet(3, i)[0]), NORMAL }, indices: shared })));
	},
	'members of a primitive': (b, n) => {
		b.addMesh([{ ...primitive(b, sheet(30)), ...Object.fromEntries(range(10 * n).map((i) => [`member ${i}`, 0])) }]);
	},
	'attributes of a primitive': (b, n) => {
		const all = primitive(b, sheet(3));
		const bufferView = b.addView(new Float32Array(16));
		const custom = b.addAccessor({ bufferView, componentType: FLOAT, count: 16, type: 'SCALAR' });
		for (let i = 0; i < 10 * n; ++i) all.attributes[`_ATTRIBUTE_${i}`] = custom;
		b.addMesh([all, primitive(b, sheet(100))]);
	},
	'morph targets': (b, n) => {
		const all = primitive(b, sheet(3));
		all.targets = range(n).map(() => ({ POSITION: all.attributes.POSITION }));
		b.addMesh([all, primitive(b, sheet(100))]);
	},
	'primitives below a long name': (b, n) => {
		const name = 'N'.repeat(100 * n);
		b.addMesh([primitive(b, sheet(30))]);
		b.addMesh(Array(n).fill({ attributes: primitive(b, sheet(3)).attributes }));
		b.json.meshes[1].extensions = { [name]: {} };
		b.json.accessors[0].extensions = { [name]: {} };
	},
	'faulty primitives': (b, n) => {
		b.addMesh([primitive(b, sheet(30))]);
		const wrong = primitive(b, [sheet(30)[0], sheet(30)[1].map((i) => i + 1)]);
		b.addMesh(Array(n).fill(wrong));
		b.addMesh(Array(n).fill({ attributes: { POSITION: 99999999 } }));
	},
	'lines of vertex numbers over the same bytes': (b, n) => {
		const bufferView = b.addView(new Uint8Array(400 * n));
		b.addMesh(range(n).map((i) => ({ ...primitive(b, sheet(3, i)), extensions: { CESIUM_primitive_outline: {
			indices: b.addAccessor({ bufferView, componentType: UNSIGNED_BYTE, count: 400 * n - i, type: 'SCALAR' }) } } })));
		b.json.extensionsUsed = ['CESIUM_primitive_outline'];
	},
	'payloads that overlap': (b, n) => {
		const all = primitive(b, sheet(3));
		b.addView(new Uint8Array(400 * n));
		const view = b.json.bufferViews.at(-1);
		b.addMesh(range(n).map((i) => {
			b.json.bufferViews.push({ ...view, byteLength: view.byteLength - i });
			return { ...all, extensions: { KHR_mesh_collapse_compression: { bufferView: b.json.bufferViews.length - 1, attributes: { POSITION: 0 } } } };
		}));
	},
};

function range(n) {
	return Array.from({ length: n }, (_, i) => i);
}

const LIMIT_SECONDS = 120;

// Measures a command: processor time, which does not depend on what else runs, and peak memory if
// GNU time is there. 'x' marks a command that fails.
function measure(program, words) {
	const times = join(folder, 'times');
	rmSync(times, { force: true });
	const hasTime = existsSync('/usr/bin/time');
	const command = hasTime ? ['/usr/bin/time', '-o', times, '-f', '%U %S %M'] : [];
	let mark = '';
	let seconds = 0;
	try {
		const script = `"$@" > /dev/null 2>&1 || echo failed; times`;
		const options = { encoding: 'utf8', timeout: 1000 * LIMIT_SECONDS, killSignal: 'SIGTERM' };
		const lines = execFileSync('bash', ['-c', script, 'bash', ...command, 'timeout', LIMIT_SECONDS - 1, program, ...words], options).trim().split('\n');
		if (lines[0] === 'failed') mark = 'x';
		seconds = lines.at(-1).split(' ').map((t) => t.split('m').map(parseFloat)).reduce((sum, [m, s]) => sum + 60 * m + s, 0);
	} catch {
		return `> ${LIMIT_SECONDS}`;
	}
	if (seconds >= LIMIT_SECONDS - 5) return `> ${LIMIT_SECONDS}`;
	const memory = existsSync(times) ? readFileSync(times, 'utf8').trim().split('\n').at(-1).split(' ')[2] : undefined;
	return `${mark}${seconds.toFixed(2)}${memory === undefined ? '' : ` ${Math.round(memory / 1024)}M`}`;
}

const [name, size = '1000', ...kinds] = process.argv.slice(2);
if (name === undefined) {
	console.error('usage: tools/check/growth documents PROGRAM [N [KIND...]]');
	process.exit(2);
}
const program = resolve(import.meta.dirname, '../../..', name);
const folder = mkdtempSync(join(tmpdir(), 'growth-'));
const [source, converted, decoded] = ['a.glb', 'b.glb', 'c.glb'].map((file) => join(folder, file));
console.log('Each cell: kB of the file; processor time in s and peak memory of convert / decode / inspect / validate; x: refused.\n');
console.log('| kind | n | 2 n | 4 n |\n|---|---|---|---|');
for (const [kind, build] of Object.entries(KINDS)) {
	if (kinds.length !== 0 && !kinds.some((part) => kind.includes(part))) continue;
	const cells = [1, 2, 4].map((factor) => {
		const builder = new Builder();
		build(builder, factor * Number(size));
		writeFileSync(source, builder.toGlb());
		rmSync(converted, { force: true });
		const measured = [measure(program, ['convert', source, converted, '--compare', 'none', '-q'])];
		const input = existsSync(converted) ? converted : source;
		measured.push(...[['decode', input, decoded, '-q'], ['inspect', input], ['validate', input]].map((words) => measure(program, words)));
		return `${Math.round(statSync(source).size / 1000)}: ${measured.join(' / ')}`;
	});
	console.log(`| ${kind} | ${cells.join(' | ')} |`);
}
rmSync(folder, { recursive: true });
