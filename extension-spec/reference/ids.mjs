// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

// Ids: B.3.3 of the specification.

import { ATTRIBUTES, models, Row } from './entropy.mjs';
import { readByLength } from './lengths.mjs';

// The same for all attributes.
export class IdModels {
	constructor() {
		this.IS_NEW = models([2]);
		this.IS_SUCCESSOR = models([3]);
		this.RANK = new Row();
		this.DISTANCE = new Row();
	}
}

export class Ids {
	constructor(streams, m) {
		this.streams = streams;
		this.models = m;
		this.entries = new Array(4096); // undefined: unused
		this.recent = [];
		this.largest = -1;
		this.wasNew = 0;
		this.outcome = 0;
	}

	read(beside) {
		const k = Math.imul(beside, 0x9e3779b1) >>> 20;
		this.wasNew = this.streams.bit(this.models.IS_NEW[this.wasNew]);
		const id = this.wasNew ? (this.largest + 1) | 0 : this.successor(k, beside) ?? this.recentOrFar(beside);
		this.entries[k] = { id: beside, next: id };
		this.recent = [id, ...this.recent.filter((other) => other !== id)].slice(0, 15);
		this.largest = Math.max(this.largest, id);
		return id;
	}

	successor(k, beside) {
		const entry = this.entries[k];
		if (entry === undefined || entry.id !== beside) return undefined;
		const hit = this.streams.bit(this.models.IS_SUCCESSOR[this.outcome]);
		this.outcome = hit ? 2 : 1;
		return hit ? entry.next : undefined;
	}

	recentOrFar(beside) {
		const r = this.streams.token(0, this.models.RANK, ATTRIBUTES);
		if (r < this.recent.length) return this.recent[r];
		return (beside + readByLength(this.streams, 1, this.models.DISTANCE).residual) | 0;
	}
}
