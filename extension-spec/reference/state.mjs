// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

// What is kept of the wedges while an attribute is decoded: A.10.1 of the specification.

import { NONE } from './mesh.mjs';

const NOT_CODED = 255;

export class AttributeState {
	constructor(attribute, wedges, bundleOf) {
		this.attribute = attribute;
		this.wedges = wedges;
		this.bundleOf = bundleOf;
		this.components = attribute.components;
		this.values = new Int32Array(wedges.count * this.components);
		this.coded = new Uint8Array(wedges.count);
		this.L = new Uint8Array(wedges.count).fill(NOT_CODED); // [A.10.2]
	}

	isCoded(w) {
		return w !== NONE && this.coded[w] === 1;
	}

	value(w) {
		return this.values.subarray(w * this.components, (w + 1) * this.components);
	}

	// All that was decoded of a wedge: of some tangents (A.10.13) also the sign.
	integers(w) {
		return [...this.value(w), this.negative?.[w] ?? 0];
	}

	set(w, value) {
		this.values.set(value, w * this.components);
	}

	// All members of a bundle get the value and the length.
	finish({ members }, value, L) {
		for (const w of members) {
			this.set(w, value);
			this.coded[w] = 1;
			this.L[w] = L;
		}
	}

	// The mean of the lengths at the neighbours of a bundle with an entry.
	meanLength({ n, p }) {
		return Math.min(Math.floor((this.L[n] + this.L[p] + 1) / 2), 10);
	}
}
