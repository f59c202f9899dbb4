// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

// Blocks become one piece [A.11.3, A.11.4].

import { ALIAS } from './attributeheader.mjs';
import { elementsOf } from './components.mjs';
import { failUnless } from './errors.mjs';
import { concatenate } from './glb.mjs';
import { indicesOf } from './orders.mjs';
import { NONE, head } from './surface.mjs';

// [A.11.4] The glued piece; `decoded` are the decoded blocks, `blocks` what the table of blocks says of them.
export function gluePieces(decoded, blocks) {
	const numbers = glue(decoded, blocks);
	decoded.forEach(({ piece, values }, i) => checkBox(blocks[i], piece, values[0]));
	const isNew = (i, w) => numbers[i][w] >= blocks[i].first;
	return {
		indices: (part) => Uint32Array.from(decoded.flatMap(({ table, parts }, i) =>
			Array.from(indicesOf(table, parts[part]), (w) => numbers[i][w]))),
		elements: (attribute) => concatenate(decoded.map(({ piece, values, wedgeOrder }, i) =>
			elementsOf(piece, piece.attributes[attribute], values, wedgeOrder.filter((w) => isNew(i, w))))),
	};
}

// [A.11.3] glue(): for each block the numbers of its wedges in the glued piece.
function glue(decoded, blocks) {
	const rim = new Map();
	return decoded.map(({ piece, surface, values }, i) => {
		const { first, exceptions, repeated_count } = blocks[i];
		const tupleOf = tuples(piece, values), rimWedges = rimWedgesOf(surface);
		const tuplesOfRim = new Map([...rimWedges].map((w) => [w, tupleOf(w)]));
		const numbers = new Uint32Array(piece.wedge_count);
		let wedges = first;
		for (let w = 0; w < piece.wedge_count; ++w) {
			// A wedge that is not on the rim has no tuple here, and rim has no such key.
			const earlier = exceptions.has(w) ? exceptions.get(w) : rim.get(tuplesOfRim.get(w));
			numbers[w] = earlier === undefined ? wedges++ : earlier;
		}
		const repeated = piece.wedge_count - (wedges - first);
		failUnless(repeated === repeated_count, 'BadAttribute', 'A.11.3', 'another number of wedges is repeated');
		for (const w of rimWedges) {
			const tuple = tuplesOfRim.get(w);
			if (numbers[w] >= first && !exceptions.has(w) && !rim.has(tuple)) rim.set(tuple, numbers[w]);
		}
		return numbers;
	});
}

// The function that yields the tuple of a wedge, as a string.
function tuples(piece, values) {
	const numbers = piece.attributes.filter(({ coding }) => coding !== ALIAS).map(({ number }) => number);
	return (w) => numbers.map((number) => values[number][w].join()).join();
}

// The wedges at edges without a neighbouring face, by their numbers.
function rimWedgesOf(surface) {
	const rim = new Set();
	surface.twin.forEach((t, h) => { if (t === NONE) rim.add(surface.tail[h]).add(head(surface, h)); });
	return Int32Array.from(rim).sort();
}

// [A.11.4] The box holds the positions of all wedges, and is the smallest one that does.
function checkBox({ low, high }, piece, positions) {
	const least = [Infinity, Infinity, Infinity], most = [-Infinity, -Infinity, -Infinity];
	for (const q of positions) {
		for (let s = 0; s < 3; ++s) {
			least[s] = Math.min(least[s], q[s]);
			most[s] = Math.max(most[s], q[s]);
		}
	}
	const fits = [0, 1, 2].every((s) => least[s] === low[s] && most[s] === high[s]);
	failUnless(fits, 'BadAttribute', 'A.11.4', 'the positions of a block have another box');
}
