// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

// Exact normals: A.10.16 of the specification.

import { bounded, makeUnit, meanError, noError, vectorOf, VectorReader, vectorRows } from './exactvectors.mjs';
import { orderedOfBits } from './floats.mjs';
import { exactFaceNormalSums } from './faces.mjs';
import { magnitudeBits, Memory, memoryModels, predictionKey } from './memories.mjs';
import { next, NONE } from './mesh.mjs';
import { add64, scale64, sub64 } from './vectors.mjs';
import { bundles } from './wedges.mjs';

export class ExactNormalModels {
	constructor() {
		this.ROW = vectorRows();
		this.KNOWN = memoryModels();
	}
}

// The float with the magnitude of i, with a minus where the predicted component is negative.
const withSignOf = (i, predicted) => orderedOfBits((magnitudeBits(i) | (predicted < 0 ? 0x80000000 : 0)) >>> 0);

class ExactNormals {
	constructor(context, state) {
		const byte = state.attribute.predictor;
		const { wedges } = state;
		const { ROW, KNOWN } = context.models.exactNormals;
		this.state = state;
		this.wedges = wedges;
		this.blend = (byte & 4) !== 0;
		this.reader = new VectorReader(context.streams, ROW);
		this.memory = byte & 8 ? new Memory(context.streams, KNOWN, state, magnitudeBits) : undefined;
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
		const predicted = this.predict(bundle, direction);
		const value = this.known(bundle, predicted) ?? this.reader.read(predicted, this.error);
		this.last = vectorOf(value).map(bounded);
		const missed = sub64(this.last, direction);
		for (const w of bundle.members) {
			this.S[w] = missed;
			this.E[w] = { ...this.error };
		}
		this.state.finish(bundle, value, 0);
		this.memory?.learn(keyOfPrediction(predicted), bundle.first);
		this.memory?.learnFaces(bundle.members);
		makeUnit(this.last);
	}

	direction(members) {
		let direction = [...this.S[members[0]]];
		for (const w of members.slice(1)) direction = add64(direction, this.S[w]);
		return makeUnit(direction) ? direction : [...this.last];
	}

	hasNeighbours({ hasEntry, n, p }) {
		return hasEntry && this.state.isCoded(n) && this.state.isCoded(p);
	}

	// this.error becomes that expected.
	predict(bundle, direction) {
		if (!this.hasNeighbours(bundle)) return direction;
		const { n, p } = bundle;
		this.error = meanError(this.E[n], this.E[p]);
		if (!this.blend) return direction;
		const predicted = add64(direction, scale64(add64(this.S[n], this.S[p]), 0.5));
		makeUnit(predicted);
		return predicted;
	}

	known(bundle, predicted) {
		if (this.memory === undefined) return undefined;
		this.memory.begin();
		let k = this.memory.ask(keyOfPrediction(predicted), NONE);
		if (k === NONE && this.hasNeighbours(bundle)) {
			const beyond = this.wedges.surface.across(next(bundle.halfEdges[0]));
			const o = beyond === NONE ? NONE : this.wedges.surface.tail(beyond);
			k = this.memory.ask(this.memory.edgeKey(bundle.n, bundle.p), this.state.isCoded(o) ? o : NONE);
		}
		return k === NONE ? undefined : this.state.value(k).map((x, s) => withSignOf(x, predicted[s]));
	}
}

const keyOfPrediction = (predicted) => predictionKey(predicted.map((x) => Math.trunc(Math.abs(x) * 4096 + 0.5)));

export function decodeExactNormals(context, state) {
	new ExactNormals(context, state).decode();
}
