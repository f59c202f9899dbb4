#!/usr/bin/env node
// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// tools/check/growth tilesets PROGRAM [N [KIND...]]: measures the processor time, the peak memory
// and the messages of `tiles` for tilesets with N, 2 N and 4 N of one thing, among them tilesets
// that nobody but an attacker would make. Linear time and memory double from column to column. KIND
// is a part of a name in the table. PROGRAM is a path from the root, or absolute.
// tests/tiles/growth_test.cpp counts the work on the same tilesets.
import { execFileSync } from 'node:child_process';
import { existsSync, mkdirSync, mkdtempSync, readFileSync, readdirSync, rmSync, statSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join, resolve } from 'node:path';

const SECONDS = 20; // after which a run is ended

const range = (n) => Array.from({ length: n }, (_, i) => i);
const tile = (uri, more = {}) => ({ geometricError: 4, ...(uri && { content: { uri } }), ...more });
const parent = (children, more = {}) => ({ geometricError: 8, children, ...more });
const tileset = (root, more = {}) => ({ asset: { version: '1.1' }, geometricError: 16, root, ...more });
const moved = (i) => ({ transform: [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, i, i % 7, i % 11, 1] });
const turned = (i) => {
	const [c, s] = [Math.cos(i), Math.sin(i)];
	return { transform: [c, s, 0, 0, -s, c, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1] };
};
const implicit = (uri) => ({ implicitTiling: { subdivisionScheme: 'QUADTREE', subtreeLevels: 2, availableLevels: 2, subtrees: { uri } } });
const subtree = { tileAvailability: { constant: 1 }, contentAvailability: [{ constant: 1 }], childSubtreeAvailability: { constant: 0 } };
const schema = (n) => ({ id: 's', classes: Object.fromEntries(range(n).map((i) => [`class${i}`, {
	properties: { height: { type: 'SCALAR', componentType: 'FLOAT32' } } }])) });

// A chain of n tilesets that each name the next one twice.
function doubling(n, place) {
	const files = { 'x.pnts': '' };
	for (let i = 0; i < n; ++i) {
		const uri = i + 1 < n ? `${i + 1}.json` : 'x.pnts';
		files[i === 0 ? 'tileset.json' : `${i}.json`] = tileset(parent([tile(uri, place(1)), tile(uri, place(1 + 2 ** -i))]));
	}
	return files;
}

// Text of tiles inside each other, which may be deeper than JSON.stringify() can write.
function nested(n, open, inner) {
	return `{"asset":{"version":"1.1"},"geometricError":16,"root":${`${open}"children":[`.repeat(n)}${inner}${']}'.repeat(n)}}`;
}

// Each returns files by name.
const KINDS = {
	'implicit tiles with one inline schema': (n) => ({
		'tileset.json': tileset(parent(range(n).map(() => tile('x.pnts', implicit('s.json')))), { schema: schema(n) }), 's.json': subtree, 'x.pnts': '' }),
	'implicit tiles with one schema file': (n) => ({ 'schema.json': schema(n),
		'tileset.json': tileset(parent(range(n).map(() => tile('x.pnts', implicit('s.json')))), { schemaUri: 'schema.json' }), 's.json': subtree, 'x.pnts': '' }),
	'tilings of one long subtree': (n) => ({ 's.json': { ...subtree, extras: range(n) }, 'x.pnts': '',
		'tileset.json': tileset(parent(range(n).map(() => tile('x.pnts', implicit('s.json'))))) }),
	'tilings of a subtree that is damaged': (n) => ({ 's.json': JSON.stringify({ extras: range(n) }).slice(0, -1), 'x.pnts': '',
		'tileset.json': tileset(parent(range(n).map(() => tile('x.pnts', implicit('s.json'))))) }),
	'one external tileset, named again and again': (n) => ({ 'x.pnts': '',
		'tileset.json': tileset(parent(range(n).map(() => tile('e.json')))), 'e.json': tileset(parent(range(n / 10).map(() => tile('x.pnts')))) }),
	'one external tileset at many places': (n) => ({ 'x.pnts': '',
		'tileset.json': tileset(parent(range(n).map((i) => tile('e.json', moved(i))))), 'e.json': tileset(parent(range(10).map(() => tile('x.pnts')))) }),
	'one external tileset, turned at many places': (n) => ({ 'x.pnts': '',
		'tileset.json': tileset(parent(range(n).map((i) => tile('e.json', turned(i))))), 'e.json': tileset(parent(range(10).map(() => tile('x.pnts')))) }),
	'external tilesets at each level': (n) => ({ 'x.pnts': '',
		'tileset.json': nested(n, '{"geometricError":8,"content":{"uri":"e.json"},', '{"geometricError":0}'), 'e.json': tileset(tile('x.pnts')) }),
	'a chain that names the next one twice': (n) => doubling(Math.round(n / 160), () => ({})),
	'the same with a place for each': (n) => doubling(Math.round(n / 160), moved),
	'tiles that fail inside each other': (n) => ({ 'x.pnts': '',
		'tileset.json': nested(n, '{"geometricError":-1,"content":{"uri":"gone.glb"},', '{"geometricError":0}') }),
	'contents that are missing, with long names': (n) => ({
		'tileset.json': tileset(parent(range(n).map((i) => tile(`${'long/'.repeat(100)}${i}.glb`)))) }),
	'tiles of one content, each turned': (n) => ({ 'x.pnts': '', 'tileset.json': tileset(parent(range(n).map((i) => tile('x.pnts', turned(i))))) }),
	'subtrees that are missing': (n) => ({ 'x.pnts': '',
		'tileset.json': tileset(parent(range(n).map((i) => tile('x.pnts', implicit(`${i}.json`))))) }),
};

// Returns a cell of the table: kB of the input; processor time, peak memory, kB of messages.
function measure(program, folder, files) {
	rmSync(folder, { recursive: true, force: true });
	mkdirSync(join(folder, 'in'), { recursive: true });
	for (const [name, content] of Object.entries(files)) {
		writeFileSync(join(folder, 'in', name), typeof content === 'string' ? content : JSON.stringify(content));
	}
	const bytes = readdirSync(join(folder, 'in')).reduce((sum, name) => sum + statSync(join(folder, 'in', name)).size, 0);
	const script = `ulimit -t ${SECONDS} -v 8000000; /usr/bin/time -f '%U %S %M' -o times "$1" tiles in/tileset.json out -q > messages 2>&1; echo $?`;
	const status = Number(execFileSync('bash', ['-c', script, 'bash', program], { cwd: folder, encoding: 'utf8' }));
	const times = existsSync(join(folder, 'times')) ? readFileSync(join(folder, 'times'), 'utf8').trim().split('\n').at(-1).split(' ').map(Number) : [0, SECONDS, 0];
	const messages = Math.round(statSync(join(folder, 'messages')).size / 1000);
	const mark = status > 2 ? '> ' : status === 0 ? '' : 'x';
	return `${Math.round(bytes / 1000)}: ${mark}${(times[0] + times[1]).toFixed(2)} s ${Math.round(times[2] / 1024)} MB${messages === 0 ? '' : ` ${messages} kB`}`;
}

const [name, size = '1000', ...kinds] = process.argv.slice(2);
if (name === undefined) {
	console.error('usage: tools/check/growth tilesets PROGRAM [N [KIND...]]');
	process.exit(2);
}
const program = resolve(import.meta.dirname, '../../..', name);
const folder = mkdtempSync(join(tmpdir(), 'growth-'));
console.log(`Each cell: kB of the tileset; processor time, peak memory, and kB of messages; x: exit status 1; >: ended after ${SECONDS} s.\n`);
console.log('| kind | n | 2 n | 4 n |\n|---|---|---|---|');
for (const [kind, filesOf] of Object.entries(KINDS)) {
	if (kinds.length !== 0 && !kinds.some((part) => kind.includes(part))) continue;
	console.log(`| ${kind} | ${[1, 2, 4].map((factor) => measure(program, folder, filesOf(factor * Number(size)))).join(' | ')} |`);
}
rmSync(folder, { recursive: true });
