// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

// The attributes of a piece: A.10 of the specification.

import { elementsOf } from './components.mjs';
import { models } from './entropy.mjs';
import { decodeExactNormals, ExactNormalModels } from './exactnormals.mjs';
import { decodeExactTangents, ExactTangentModels } from './exacttangents.mjs';
import { finite } from './floats.mjs';
import { BelowGrid, TailModels } from './grids.mjs';
import { ALIAS, GRID, TANGENT } from './names.mjs';
import { decodeNormals, NormalModels } from './normals.mjs';
import { centreOf, unitVector } from './octahedral.mjs';
import { decodeSkins, SkinModels } from './skins.mjs';
import { AttributeState } from './state.mjs';
import { chartCoordinates, decodeTangentAngles, decodeTangentPoints, TangentModels } from './tangents.mjs';
import { decodeTexcoords, TexcoordModels } from './texcoords.mjs';
import { decodeValues, ValueModels } from './values.mjs';
import { EqualityModels, readBundles, Wedges } from './wedges.mjs';

export class AttributeModels {
	constructor() {
		this.equalities = new EqualityModels();
		this.values = new ValueModels();
		this.normals = new NormalModels();
		this.texcoords = new TexcoordModels();
		this.tangents = new TangentModels();
		this.skins = new SkinModels();
		this.exactNormals = new ExactNormalModels();
		this.exactTangents = new ExactTangentModels();
		this.tails = models([8, 2], () => new TailModels());
	}
}

// What the methods have in common in one piece.
class Context {
	constructor(streams, attributeModels, piece, wedges) {
		this.streams = streams;
		this.models = attributeModels;
		this.attributes = piece.attributes;
		this.wedges = wedges;
		this.states = new Map(); // by attribute
	}

	begin(attribute, bundleOf) {
		const state = new AttributeState(attribute, this.wedges, bundleOf);
		this.states.set(attribute, state);
		return state;
	}

	stateOf(attribute) {
		return this.states.get(attribute);
	}

	perWedge(make) {
		return Array.from({ length: this.wedges.count }, (_, w) => make(w));
	}

	// [A.10.12] The chart coordinates of the wedges, or undefined
	chart() {
		const { chart } = this.attributes;
		return chart && chartCoordinates(this.stateOf(chart));
	}

	exactNormalState() {
		return this.stateOf(this.attributes.exactNormal);
	}

	octahedralNormals() {
		const { octahedralNormal } = this.attributes;
		if (octahedralNormal === undefined) return undefined;
		const C = centreOf(octahedralNormal.bits);
		const state = this.stateOf(octahedralNormal);
		return this.perWedge((w) => unitVector(C, state.value(w)));
	}

	// [A.10.13] The normals that tangent points are perpendicular to, or undefined
	unitNormals() {
		const state = this.exactNormalState();
		if (state === undefined) return this.octahedralNormals();
		return this.perWedge((w) => [...state.value(w)].map(finite));
	}
}

// [A.10.1] Order of the attributes
function phaseOf(attribute) {
	return attribute.semantic === TANGENT && attribute.target === 0 ? 1 : 0;
}

const DECODERS = {
	'tangent point': decodeTangentPoints,
	normal: decodeNormals,
	tangent: decodeTangentAngles,
	'texture coordinate': decodeTexcoords,
	'exact normal': decodeExactNormals,
	'exact tangent': decodeExactTangents,
	values: decodeValues,
};

// [A.10.1] An attribute is read in three steps.
function decodeAttribute(context, attribute) {
	if (attribute.method === 'alias' || attribute.method === 'skin weights') return;
	const bundleOf = readBundles(context.streams, context.models.equalities, context.wedges, attribute);
	const state = context.begin(attribute, bundleOf);
	if (attribute.method === 'skin') {
		const weights = context.begin(attribute.partner, bundleOf);
		decodeSkins(context, state, weights);
		readBelowGrid(context, weights);
		return;
	}
	DECODERS[attribute.method](context, state);
	readBelowGrid(context, state);
}

// [A.10.5] A wedge that is not the first of its bundle gets the floats of the first.
function readBelowGrid({ streams, models: { tails } }, state) {
	const { attribute, wedges, bundleOf } = state;
	if (attribute.coding !== GRID) return;
	const below = new BelowGrid(streams, attribute, tails[attribute.semantic][attribute.target !== 0 ? 1 : 0]);
	for (let w = 0; w < wedges.count; ++w) {
		const first = bundleOf[w][0];
		state.set(w, first === w ? state.value(w).map((q, c) => below.read(q, c)) : state.value(first));
	}
}

// The values of the position are those of groups and isolated vertices.
function positionState(context, attribute) {
	const state = context.begin(attribute, undefined);
	const { wedges } = context;
	for (let w = 0; w < wedges.count; ++w) {
		const record = wedges.recordOf(w);
		state.set(w, wedges.integers.subarray(3 * record, 3 * record + 3));
	}
}

// elements: of all attributes, in the order of the header, of each wedge the bytes of its components; integersOf: of a wedge, the
// integers that were decoded, those of the position first.
export function decodeAttributes(streams, attributeModels, stages) {
	const { attributes } = stages.piece;
	if (attributes.length === 0) return { elements: [], integersOf: () => [] };
	const context = new Context(streams, attributeModels, stages.piece, new Wedges(stages));
	positionState(context, attributes[0]);
	for (const phase of [0, 1]) {
		for (const attribute of attributes.slice(1)) {
			if (phaseOf(attribute) === phase) decodeAttribute(context, attribute);
		}
	}
	const normals = context.octahedralNormals();
	const elements = attributes.map((a) => elementsOf(context.stateOf(a.coding === ALIAS ? attributes[a.alias] : a), normals));
	const states = attributes.filter((a) => a.coding !== ALIAS).map((a) => context.stateOf(a));
	return { elements, integersOf: (w) => states.flatMap((state) => state.integers(w)) };
}
