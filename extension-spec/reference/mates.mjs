// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

// Values of mates [A.10.20].

import { MATES } from './attributeheader.mjs';
import { arrayOf, noOutcomes, recentBit, recentModels } from './entropy.mjs';
import { otherMates } from './mirrors.mjs';

const MOST_ASKED = 3, MOST_WEDGES = 4;
export const mateModels = () => ({ ASKED: arrayOf(MOST_ASKED, recentModels) });
const isEqual = (a, b) => a.every((x, c) => x === b[c]);

// [A.10.20] The function that reads whether the bundle of w has the value of a mate, and yields that or undefined.
// imageOf(value, turn) is the image of a value, turned.
export function valuesOfMates(coding, models, attribute, imageOf) {
	const { piece, groupOf, mates } = coding.wedges;
	if ((attribute.predictor & MATES) === 0 || mates === undefined) return () => undefined;
	const wedgesOf = firstWedges(coding.wedges), recent = noOutcomes();
	return (w) => {
		if (w >= piece.surface_wedges) return undefined;
		const images = imagesAt(coding, otherMates(mates, groupOf[w]), wedgesOf, imageOf);
		return images.find((image, i) => recentBit(coding.coder, models.ASKED[i], recent));
	};
}

// The first wedges of each group.
function firstWedges({ piece, groupOf }) {
	const wedgesOf = [];
	for (let w = 0; w < piece.surface_wedges; ++w) {
		const wedges = wedgesOf[groupOf[w]] ??= [];
		if (wedges.length !== MOST_WEDGES) wedges.push(w);
	}
	return wedgesOf;
}

// The different images that may be asked for, in their order.
function imagesAt({ coded, values }, mates, wedgesOf, imageOf) {
	const images = [];
	for (const { turn, u } of mates) {
		for (const x of wedgesOf[u]) {
			if (!coded[x]) continue;
			const image = imageOf(values[x], turn);
			if (!images.some((before) => isEqual(before, image))) images.push(image);
		}
	}
	return images.slice(0, MOST_ASKED);
}
