// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

// The error of a malformed payload.

// [A.1.4] The kinds, by their numbers.
const KINDS = ['document', 'Truncated', 'BadMagic', 'UnsupportedVersion', 'BadChecksum', 'BadHeader', 'BadConnectivity',
	'BadStitch', 'BadAttribute', 'TrailingBytes', 'Limit'];

export class PayloadError extends Error {
	constructor(kind, section, message) {
		super(`${kind}: ${message} [${section}]`);
		this.name = 'PayloadError';
		this.kind = kind;
		this.section = section;
		this.number = KINDS.indexOf(kind);
	}
}

export function fail(kind, section, message) {
	throw new PayloadError(kind, section, message);
}

export function failUnless(condition, kind, section, message) {
	if (!condition) fail(kind, section, message);
}
