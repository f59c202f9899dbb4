// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

// Compares the accessors of two GLB files, bit for bit: node compare.mjs A.glb B.glb
// The n-th accessor of one is compared with the n-th of the other; where their bytes are is of no importance.

import { readFileSync } from 'node:fs';
import { argv, exit } from 'node:process';
import { COMPONENTS, readAccessor, readGlb } from './glb.mjs';
import { isMain } from './main.mjs';

const PROPERTIES = ['componentType', 'count', 'type', 'normalized'];

// A list of differences, one line each.
export function compareGlbs(a, b) {
	const [countA, countB] = [a, b].map((gltf) => gltf.json.accessors?.length ?? 0);
	if (countA !== countB) return [`${countA} accessors, ${countB} accessors`];
	return Array.from({ length: countA }, (_, i) => compareAccessors(a, b, i)).filter((line) => line !== undefined);
}

function compareAccessors(a, b, i) {
	const [accessorA, accessorB] = [a.json.accessors[i], b.json.accessors[i]];
	for (const name of PROPERTIES) {
		const [x, y] = [accessorA[name] ?? false, accessorB[name] ?? false];
		if (x !== y) return `accessor ${i}: ${name} is ${x} and ${y}`;
	}
	const [bytesA, bytesB] = [readAccessor(a, i), readAccessor(b, i)];
	const at = bytesA.findIndex((byte, k) => byte !== bytesB[k]);
	if (at < 0) return undefined;
	const perElement = bytesA.length / accessorA.count;
	const perComponent = perElement / COMPONENTS[accessorA.type];
	const component = Math.floor((at % perElement) / perComponent);
	const different = countDifferentElements(bytesA, bytesB, perElement);
	const first = `element ${Math.floor(at / perElement)}, component ${component}`;
	return `accessor ${i}: ${different} of ${accessorA.count} elements differ, the first at ${first}`;
}

function countDifferentElements(a, b, size) {
	let count = 0;
	for (let i = 0; i < a.length; i += size) {
		if (!a.subarray(i, i + size).every((byte, k) => byte === b[i + k])) ++count;
	}
	return count;
}

if (isMain(import.meta)) {
	if (argv.length !== 4) {
		console.error('usage: node compare.mjs A.glb B.glb');
		exit(2);
	}
	const differences = compareGlbs(...argv.slice(2).map((path) => readGlb(readFileSync(path))));
	for (const line of differences) console.log(line);
	exit(differences.length === 0 ? 0 : 1);
}
