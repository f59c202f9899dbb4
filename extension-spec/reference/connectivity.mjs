// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

// Mesh collapse, decoded backwards [A.4].

import { arrayOf, binaryModel, bit, golomb, golombModel, signedGolomb } from './entropy.mjs';
import { fail, failUnless } from './errors.mjs';
import { NONE, createSurface } from './surface.mjs';

const DUMMY = -1, CLOSED = -2;
// A gate is a half-edge (a number), the node whose gate it is glued to (an object), or BOUNDARY.
const BOUNDARY = NONE;
const TWIG_CLASS = 5, END_CLASS = 6;
export const connectivityModels = () => ({
	START: arrayOf(6), KIND_SPUR: arrayOf(4), KIND_TWIG: arrayOf(4), KIND_START: arrayOf(4), KIND_END: arrayOf(4),
	KIND_HANDLE: binaryModel(), FINISH: binaryModel(), JOINED_SPUR: arrayOf(2), DUMMY_END: arrayOf(2),
	DUMMY_TWIG: binaryModel(), DUMMY_FINISH: binaryModel(), SPECIAL: arrayOf(8 * 49), RUN: arrayOf(128),
	DUMMY_DEGREE: golombModel(), HANDLE_NODE: golombModel(), HANDLE_TOP: golombModel(), HANDLE_DEPTH: golombModel(),
});

const malformed = (message, section) => fail('BadConnectivity', section, message);

// [A.4.2] connectivity(): the faces and their twins.
export function decodeConnectivity(coder, models, piece) {
	const s = {
		coder, models, piece, surface: createSurface(piece.face_count), nodes: [], top: undefined, stack: [],
		vertices: 0, dummies: 0, faces: 0, age: 0, last: END_CLASS, before: END_CLASS,
	};
	for (let operations = 0; operations < piece.operation_count; ++operations) {
		if (s.top === undefined) end(s, true);
		else operation(s);
	}
	if (s.top !== undefined) finish(s);
	const { vertex_count, face_count, dummy_count } = piece;
	const isComplete = s.vertices === vertex_count && s.faces === face_count && s.dummies === dummy_count;
	failUnless(isComplete, 'BadConnectivity', 'A.4.2', 'the operations do not yield the counts of the header');
	return s.surface;
}

// [A.4.1]
function newNode(s, vertex, degree) {
	if (s.nodes.length === 2 ** 28) fail('Limit', 'A.4.1', 'too many nodes');
	const n = { number: s.nodes.length, next: undefined, vertex, gate: BOUNDARY, degree: limited(degree), shared: 0 };
	n.next = n;
	s.nodes.push(n);
	return n;
}
const limited = (degree) => Math.min(degree, 65535);
function newVertex(s) {
	if (s.vertices === s.piece.vertex_count) malformed('too many vertices', 'A.4.1');
	return s.vertices++;
}

function newDummy(s) {
	++s.dummies;
	return DUMMY;
}
const dummiesLeft = (s) => s.dummies < s.piece.dummy_count;
const newDummyOrVertex = (s, M) => (dummiesLeft(s) && bit(s.coder, M) ? newDummy(s) : newVertex(s));
function remember(s, operationClass) {
	s.before = s.last;
	s.last = operationClass;
}
const isNode = (gate) => typeof gate === 'object';
const isHalfEdge = (gate) => typeof gate === 'number' && gate !== BOUNDARY;
function pointBack(n) {
	if (isNode(n.gate)) n.gate.gate = n;
}

function addDegree(n, more) {
	n.degree = limited(n.degree + more);
}

function spur(s, vertex) {
	const { top } = s;
	const copy = newNode(s, top.vertex, top.degree + 1), tip = newNode(s, vertex, 1);
	addDegree(top, 1);
	copy.next = top.next;
	copy.gate = top.gate;
	pointBack(copy);
	tip.next = copy;
	tip.gate = top;
	top.next = tip;
	top.gate = tip;
	return { tip, copy };
}

function swapLinks(a, b) {
	[a.next, b.next] = [b.next, a.next];
	if (a.gate === b) return;
	[a.gate, b.gate] = [b.gate, a.gate];
	pointBack(a);
	pointBack(b);
}

// Without HANDLES nothing refers to a node that has left its ring.
function close(s, first, count) {
	if (!s.piece.HANDLES) return;
	for (let n = first, k = 0; k < count; n = n.next, ++k) n.vertex = CLOSED;
}
const newFan = () => ({ first: NONE, lastHalf: NONE, taken: 0 });

// The gate is not read earlier, since the triangle before may have been glued to it.
function takeGate(s, v, n, fan) {
	const { twin } = s.surface;
	const { gate } = n;
	const f = newFace(s, v, n.vertex, n.next.vertex);
	const [left, base, right] = f === NONE ? [NONE, NONE, NONE] : [3 * f, 3 * f + 1, 3 * f + 2];
	if (f !== NONE) {
		twin[left] = fan.lastHalf;
		twin[base] = isHalfEdge(gate) ? gate : NONE;
		twin[right] = NONE;
	}
	if (isHalfEdge(gate)) twin[gate] = base;
	if (isNode(gate)) gate.gate = base === NONE ? BOUNDARY : base;
	if (fan.taken === 0) fan.first = left;
	else if (fan.lastHalf !== NONE) twin[fan.lastHalf] = left;
	fan.lastHalf = right;
	++fan.taken;
}

// Triangles at a dummy are no faces.
function newFace(s, v, a, b) {
	if (v === DUMMY || a === DUMMY || b === DUMMY) return NONE;
	if (s.faces === s.piece.face_count) malformed('too many faces', 'A.4.1');
	const f = s.faces++;
	s.surface.tail.set([v, a, b], 3 * f);
	return f;
}

// [A.4.2]
function operation(s) {
	const { coder, models, top, stack } = s;
	if (s.age < 6 && stack.length !== 0 && bit(coder, models.START[s.age])) return joinedStart(s);
	const special = 49 * Math.min(top.degree, 7) + 7 * s.last + s.before;
	if (!bit(coder, models.SPECIAL[special])) return run(s, newVertex(s));
	const c = Math.min(Math.max(top.degree, 1) - 1, 3);
	if (bit(coder, models.KIND_SPUR[c])) return expandSpur(s, newVertex(s));
	if (bit(coder, models.KIND_TWIG[c])) return twig(s);
	if (stack.length !== 0 && bit(coder, models.KIND_START[c])) return joinedStart(s);
	const possible = s.piece.HANDLES || dummiesLeft(s);
	if (!possible || bit(coder, models.KIND_END[c])) return end(s, false);
	let handle = s.piece.HANDLES;
	if (handle && dummiesLeft(s)) handle = bit(coder, models.KIND_HANDLE) === 1;
	if (handle) return joinedHandle(s);
	newDummy(s);
	return dummyRun(s);
}

function twig(s) {
	const { top } = s;
	const { copy } = spur(s, newDummyOrVertex(s, s.models.DUMMY_TWIG));
	copy.shared = top.shared;
	top.shared = 1;
	addDegree(copy, 1);
	s.top = copy;
	++s.age;
	remember(s, TWIG_CLASS);
}

// [A.4.3]
function end(s, first) {
	if (!first) {
		if (s.stack.length === 0 && bit(s.coder, s.models.FINISH)) finish(s);
		else s.stack.push(s.top);
	}
	const v = [0, 1].map((i) => newDummyOrVertex(s, s.models.DUMMY_END[i]));
	const [a, b] = v.map((vertex) => newNode(s, vertex, 1));
	[a.next, a.gate] = [b, b];
	[b.next, b.gate] = [a, a];
	s.top = a;
	s.age = 0;
	remember(s, END_CLASS);
}

// [A.4.4] joinedExpand(START)
function joinedStart(s) {
	joinedExpand(s, s.stack[s.stack.length - 1].vertex, 0);
	const { top } = s;
	const waiting = s.stack.pop();
	// The EXPAND itself may have closed the node.
	if (waiting.vertex === CLOSED) malformed('START joins a closed node', 'A.4.4');
	swapLinks(top, waiting);
	const d = top.degree + waiting.degree;
	waiting.degree = limited(d);
	waiting.shared = 1;
	top.degree = limited(d + 1);
}

// [A.4.4] joinedExpand(HANDLE)
function joinedHandle(s) {
	const back = golomb(s.coder, s.models.HANDLE_NODE);
	if (back > s.nodes.length - 1) malformed('HANDLE names a node that does not exist', 'A.4.4');
	const h = s.nodes[s.nodes.length - 1 - back];
	joinedExpand(s, h.vertex, 1);
	joinHandle(s, h);
}

function joinedExpand(s, v, join) {
	if (v === CLOSED) malformed('a closed node is joined', 'A.4.4');
	if (v === DUMMY) dummyRun(s);
	else if (bit(s.coder, s.models.JOINED_SPUR[join])) expandSpur(s, v);
	else run(s, v);
}

function joinHandle(s, h) {
	const { stack, top } = s;
	// Modulo 2^32 a negative number is that of no node.
	const t = s.nodes[h.number + signedGolomb(s.coder, s.models.HANDLE_TOP)];
	const depth = golomb(s.coder, s.models.HANDLE_DEPTH);
	const isThere = t !== undefined && t.vertex !== CLOSED && h.vertex !== CLOSED;
	if (!isThere || depth > 255 || depth > stack.length) malformed('HANDLE names what does not exist', 'A.4.4');
	swapLinks(top, h);
	stack.splice(stack.length - depth, 0, t);
	h.shared = 1;
	addDegree(top, 1);
}

// [A.4.5]
function expandSpur(s, v) {
	const { tip, copy } = spur(s, v);
	copy.shared = 1;
	addDegree(s.top, 1);
	s.top = tip;
	++s.age;
	remember(s, 0);
}

function run(s, v) {
	const closing = s.top.next, fan = newFan();
	let q = s.top;
	for (;;) {
		takeGate(s, v, q, fan);
		q = q.next;
		if (q === s.top) break;
		const context = 32 * (Math.min(fan.taken, 4) - 1) + 2 * Math.min(q.degree, 15) + q.shared;
		if (!bit(s.coder, s.models.RUN[context])) break;
	}
	close(s, closing, fan.taken - 1);
	endRun(s, v, q, fan);
}

function dummyRun(s) {
	const r = golomb(s.coder, s.models.DUMMY_DEGREE);
	if (r === 0) return expandSpur(s, DUMMY);
	const closing = s.top.next, fan = newFan();
	let q = s.top;
	do {
		takeGate(s, DUMMY, q, fan);
		q = q.next;
	} while (fan.taken < r && q !== s.top);
	if (fan.taken !== r) malformed('a dummy takes more gates than there are', 'A.4.5');
	close(s, closing, fan.taken - 1);
	endRun(s, DUMMY, q, fan);
}

function endRun(s, v, q, fan) {
	const { top } = s;
	const n = newNode(s, v, fan.taken + 1);
	addDegree(top, 1);
	// q may be top.
	addDegree(q, 1);
	top.next = n;
	top.gate = fan.first;
	n.next = q;
	n.gate = fan.lastHalf;
	s.top = n;
	++s.age;
	remember(s, Math.min(fan.taken, 4));
}

// [A.4.6]
function finish(s) {
	if (s.stack.length !== 0) malformed('a component ends while digons wait', 'A.4.6');
	const v = newDummyOrVertex(s, s.models.DUMMY_FINISH), fan = newFan(), { twin } = s.surface;
	let q = s.top;
	do {
		takeGate(s, v, q, fan);
		q = q.next;
	} while (q !== s.top);
	close(s, s.top, fan.taken);
	if (fan.first !== NONE) twin[fan.first] = fan.lastHalf;
	if (fan.lastHalf !== NONE) twin[fan.lastHalf] = fan.first;
	s.top = undefined;
}
