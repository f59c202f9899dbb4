// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

// Trained starts [A.3.9].

import { ATTRIBUTES, adapt, update } from './entropy.mjs';

const NORMAL = 1, TEXCOORD = 3;                                          // semantics

// The outcomes that a letter stands for, first to last.
const OUTCOMES = {
	'.': '', a: '0', b: '1', c: '000', d: '111', e: '0000000', f: '1111111', g: '10', h: '01', i: '1000', j: '0111',
};

const RUN =
	'..e.chibgdbdjdb...................e.c.ijgjjbjfb.d.................e.e.a.i.g.j.d.b...............'
	+ '..e.e.i.h.g.gf';
const GAP_LENGTH = 'fffddjjjjhi.c';
const HAS_SEAM = '..bdce.ddbffdffffffff.ffffff';
const EDGE = 'a.dfa.dfagbfa....hbf....eec.e...eee.e...eee.....dfffffffddffb.ffbbff';
const PREVIOUS = '.b.a...ab..ab...........fffdbddbf.ddaeeeaeeeabee';

// The symbols of the rows of both components as letters, with a comma between two rows.
const TEXCOORD_ROWS = 'a,ab,a,a,a,a,ae,agfdheab,aigdhfae,ahifg,ai,a,aa,aba,aaa,aa,a,aiagkj,ai,ajikhga,aiaghjak,aj,aa,j';
const NORMAL_ROWS =
	'aaaaaaaa,abacaaa,abhgecad,hiadbc,haicjb,ihakj,a,,,,a,aaabcaaa,aaaaaaab,acaabaaa,abhgdecf,aihfeca'
	+ 'b,hjibdahk,ahij,i';

// Lets the models of a payload with TRAINED see what the tables have.
export function startTrained({ connectivity, positions, seams, attributes }) {
	showModels(connectivity.RUN, RUN);
	showModels(positions.palettes.GAP.LENGTH, GAP_LENGTH);
	showModels(seams.HAS_SEAM, HAS_SEAM);
	showModels(seams.EDGE, EDGE);
	for (const semantic of [NORMAL, TEXCOORD]) showModels(attributes.equalities[semantic].PREVIOUS, PREVIOUS);
	showRows(attributes.texcoords[0].ROW, TEXCOORD_ROWS);
	showRows(attributes.normals.ROW, NORMAL_ROWS);
}

// The models of an array of any dimensions, the last index changing fastest.
function showModels(models, letters) {
	const flat = models.flat(Infinity);
	[...letters].forEach((letter, i) => { for (const outcome of OUTCOMES[letter]) update(flat[i], Number(outcome)); });
}

function showRows(rows, text) {
	const flat = rows.flat();
	text.split(',').forEach((symbols, i) => { for (const s of symbols) adapt(flat[i], parseInt(s, 36) - 10, ATTRIBUTES); });
}
