// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

// Exact normals: A.8.9 of the specification.

import { models } from './entropy.mjs';
import { bounded, makeUnit, meanError, noError, vectorOf, VectorModels, VectorReader } from './exactvectors.mjs';
import { exactFaceNormalSums } from './faces.mjs';
import { EdgeMemory, magnitudeBits, withSignOf } from './memories.mjs';
import { next, NONE } from './mesh.mjs';
import { add64, scale64, sub64 } from './vectors.mjs';
import { bundles } from './wedges.mjs';

export class ExactNormalModels {
	constructor() {
		this.vectors = new VectorModels();
		this.BESIDE = models([2, 4]);
	}
}

const PARTS = [0, 0.25, 0.5]; // of the blends none, half, whole

class ExactNormals {
	constructor(context, state) {
		const byte = state.attribute.predictor;
		const { wedges } = state;
		this.streams = context.streams;
		this.BESIDE = context.models.exactNormals.BESIDE;
		this.state = state;
		this.wedges = wedges;
		this.part = PARTS[(byte >> 2) & 3];
		this.reader = new VectorReader(context.streams, context.models.exactNormals.vectors, (byte & 16) !== 0);
		this.edges = byte & 32 ? new EdgeMemory(state, magnitudeBits) : undefined;
		this.edgeHistory = 0;
		this.S = exactFaceNormalSums(wedges.surface, wedges.count, wedges.exactPositions, byte & 3);
		this.E = new Array(wedges.count);
		this.last = [0, 0, 0];
		this.error = noError();
	}

	decode() {
		for (const bundle of bundles(this.wedges, this.state.bundleOf)) this.bundle(bundle);
	}

	bundle(bundle) {
		const direction = this.direction(bundle.members);
		const { value } = this.read(bundle, direction);
		this.last = vectorOf(value).map(bounded);
		const S = sub64(this.last, direction);
		for (const w of bundle.members) {
			this.S[w] = S;
			this.E[w] = { ...this.error };
			this.state.finish({ members: [w] }, value, 0);
			this.edges?.learnFaces(w);
		}
		makeUnit(this.last);
	}

	direction(members) {
		let direction = [...this.S[members[0]]];
		for (const w of members.slice(1)) direction = add64(direction, this.S[w]);
		return makeUnit(direction) ? direction : [...this.last];
	}

	// this.error becomes that of the bundle.
	read(bundle, direction) {
		const { n, p } = bundle;
		let predicted = [...direction];
		if (bundle.hasEntry && this.state.isCoded(n) && this.state.isCoded(p)) {
			this.error = meanError(this.E[n], this.E[p]);
			if (this.part !== 0) {
				predicted = add64(direction, scale64(add64(this.S[n], this.S[p]), this.part));
				makeUnit(predicted);
			}
			const value = this.edges && this.askEdges(bundle, predicted);
			if (value !== undefined) return { value };
		}
		return { value: this.reader.read(predicted, this.error) };
	}

	askEdges(bundle, predicted) {
		const { surface } = this.wedges;
		const behind = surface.across(next(bundle.halfEdges[0]));
		const o = behind === NONE ? bundle.first : surface.tail(behind);
		const candidates = this.edges.at(this.edges.key(bundle.n, bundle.p)).filter((k) => k !== o);
		for (let asked = 0; asked < candidates.length; ++asked) {
			const hit = this.streams.bit(this.BESIDE[asked][this.edgeHistory]);
			this.edgeHistory = (2 * this.edgeHistory + hit) & 3;
			if (hit) return this.state.value(candidates[asked]).map((x, s) => withSignOf(magnitudeBits(x), predicted[s]));
		}
		return undefined;
	}
}

export function decodeExactNormals(context, state) {
	new ExactNormals(context, state).decode();
}
