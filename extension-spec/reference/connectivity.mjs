// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

// Connectivity: A.4 of the specification.

import { fail } from './bytes.mjs';
import { golombs, models } from './entropy.mjs';
import { NONE, Surface } from './mesh.mjs';

// What the field `vertex` of a node can be if not a vertex.
const DUMMY = -2;
const CLOSED = -3;

// A gate is a half-edge, BOUNDARY, or `node m`, which is stored as -2 - m.
const BOUNDARY = NONE;
const nodeGate = (m) => -2 - m;
const isNodeGate = (gate) => gate <= -2;
const nodeOfGate = (gate) => -2 - gate;

const START = 0;
const HANDLE = 1;

// [A.4.2] The models of the stage
export class ConnectivityModels {
	constructor() {
		this.START = models([6]);
		this.KIND_SPUR = models([4]);
		this.KIND_TWIG = models([4]);
		this.KIND_START = models([4]);
		this.KIND_END = models([4]);
		this.KIND_HANDLE = models([]);
		this.FINISH = models([]);
		this.JOINED_SPUR = models([2]);
		this.DUMMY_END = models([2]);
		this.DUMMY_TWIG = models([]);
		this.DUMMY_FINISH = models([]);
		this.SPECIAL = models([8 * 49]);
		this.RUN = models([128]);
		this.DUMMY_DEGREE = golombs([]);
		this.HANDLE_NODE = golombs([]);
		this.HANDLE_TOP = golombs([]);
		this.HANDLE_DEPTH = golombs([]);
	}
}

function badConnectivity(section, message) {
	fail('BadConnectivity', section, message);
}

// [A.4.1] The nodes: one array per field.
class Nodes {
	constructor() {
		this.next = [];
		this.vertex = [];
		this.gate = [];
		this.degrees = [];
		this.shared = [];
	}

	get count() {
		return this.next.length;
	}

	make(vertex, degree) {
		const n = this.count;
		if (n === 2 ** 28) fail('Limit', 'A.4.1', 'too many nodes');
		this.next.push(n);
		this.vertex.push(vertex);
		this.gate.push(BOUNDARY);
		this.degrees.push(0);
		this.shared.push(0);
		this.setDegree(n, degree);
		return n;
	}

	degree(n) {
		return this.degrees[n];
	}

	setDegree(n, degree) {
		this.degrees[n] = Math.min(degree, 65535);
	}

	addDegree(n, more) {
		this.setDegree(n, this.degrees[n] + more);
	}

	pointBack(n) {
		if (isNodeGate(this.gate[n])) this.gate[nodeOfGate(this.gate[n])] = nodeGate(n);
	}

	swapLinks(a, b) {
		[this.next[a], this.next[b]] = [this.next[b], this.next[a]];
		if (this.gate[a] === nodeGate(b)) return;
		[this.gate[a], this.gate[b]] = [this.gate[b], this.gate[a]];
		this.pointBack(a);
		this.pointBack(b);
	}
}

const newFan = () => ({ first: NONE, lastHalf: NONE, taken: 0 });

class Connectivity {
	constructor(streams, modelSet, piece) {
		this.streams = streams;
		this.models = modelSet;
		this.piece = piece;
		this.handles = piece.flags.HANDLES;
		this.tails = new Int32Array(3 * piece.faceCount);
		this.twins = new Int32Array(3 * piece.faceCount).fill(NONE);
		this.nodes = new Nodes();
		this.top = NONE;
		this.stack = [];
		this.vertices = 0;
		this.dummies = 0;
		this.faces = 0;
		this.operations = 0;
		this.age = 0;
		this.last = 6;
		this.before = 6;
	}

	bit(model) {
		return this.streams.bit(model);
	}

	// ---- [A.4.1] State

	newVertex() {
		if (this.vertices === this.piece.vertexCount) badConnectivity('A.4.1', 'too many vertices');
		return this.vertices++;
	}

	dummiesAreLeft() {
		return this.dummies < this.piece.dummyCount;
	}

	newDummy() {
		++this.dummies;
		return DUMMY;
	}

	// A dummy if one is left and the model says so, else a vertex.
	newDummyOrVertex(model) {
		return this.dummiesAreLeft() && this.bit(model) ? this.newDummy() : this.newVertex();
	}

	newFace(a, b, c) {
		if (this.faces === this.piece.faceCount) badConnectivity('A.4.1', 'too many faces');
		this.tails.set([a, b, c], 3 * this.faces);
		return this.faces++;
	}

	remember(operation) {
		this.before = this.last;
		this.last = operation;
	}

	spur(vertex) {
		const { nodes, top } = this;
		const copy = nodes.make(nodes.vertex[top], nodes.degree(top) + 1);
		const tip = nodes.make(vertex, 1);
		nodes.addDegree(top, 1);
		nodes.next[copy] = nodes.next[top];
		nodes.gate[copy] = nodes.gate[top];
		nodes.pointBack(copy);
		nodes.next[tip] = copy;
		nodes.gate[tip] = nodeGate(top);
		nodes.next[top] = tip;
		nodes.gate[top] = nodeGate(tip);
		return { tip, copy };
	}

	// The triangle of v and the gate of node n. With a dummy there is none; its half-edges are none, then.
	takeGate(v, n, fan) {
		const { nodes, twins } = this;
		const a = nodes.vertex[n];
		const b = nodes.vertex[nodes.next[n]];
		const gate = nodes.gate[n];
		const { left, base, right } = this.triangleAtGate(v, a, b, gate, fan);
		if (isNodeGate(gate)) nodes.gate[nodeOfGate(gate)] = base;
		else if (gate !== BOUNDARY) twins[gate] = base;
		if (fan.taken === 0) fan.first = left;
		else if (fan.lastHalf !== NONE) twins[fan.lastHalf] = left;
		fan.lastHalf = right;
		++fan.taken;
	}

	triangleAtGate(v, a, b, gate, fan) {
		if (v === DUMMY || a === DUMMY || b === DUMMY) return { left: NONE, base: NONE, right: NONE };
		const left = 3 * this.newFace(v, a, b);
		this.twins[left] = fan.lastHalf;
		this.twins[left + 1] = isNodeGate(gate) ? NONE : gate;
		return { left, base: left + 1, right: left + 2 };
	}

	// Nothing but handles refers to closed nodes.
	close(n, k) {
		if (!this.handles) return;
		for (let i = 0; i < k; ++i) {
			this.nodes.vertex[n] = CLOSED;
			n = this.nodes.next[n];
		}
	}

	// ---- [A.4.2] Operations

	decode() {
		const { piece } = this;
		while (this.operations < piece.operationCount) {
			++this.operations;
			if (this.top === NONE) this.end(true);
			else this.operation();
		}
		if (this.top !== NONE) this.finish();
		if (this.vertices !== piece.vertexCount || this.faces !== piece.faceCount || this.dummies !== piece.dummyCount) {
			badConnectivity('A.4.2', 'counts that the operations do not reach');
		}
		return new Surface(this.tails, this.twins);
	}

	operation() {
		const { models: m } = this;
		if (this.age < 6 && this.stack.length !== 0 && this.bit(m.START[this.age])) return this.joinedExpand(START);
		if (!this.bit(m.SPECIAL[this.specialContext()])) return this.run(this.newVertex());
		const c = Math.min(Math.max(this.nodes.degree(this.top), 1) - 1, 3);
		if (this.bit(m.KIND_SPUR[c])) return this.expandSpur(this.newVertex());
		if (this.bit(m.KIND_TWIG[c])) return this.twig();
		if (this.stack.length !== 0 && this.bit(m.KIND_START[c])) return this.joinedExpand(START);
		const possible = this.handles || this.dummiesAreLeft();
		if (!possible || this.bit(m.KIND_END[c])) return this.end(false);
		let handle = this.handles;
		if (handle && this.dummiesAreLeft()) handle = this.bit(m.KIND_HANDLE) === 1;
		if (handle) return this.joinedExpand(HANDLE);
		this.newDummy();
		return this.dummyRun();
	}

	specialContext() {
		return 49 * Math.min(this.nodes.degree(this.top), 7) + 7 * this.last + this.before;
	}

	twig() {
		const { nodes } = this;
		const v = this.newDummyOrVertex(this.models.DUMMY_TWIG);
		const { copy } = this.spur(v);
		nodes.shared[copy] = nodes.shared[this.top];
		nodes.shared[this.top] = 1;
		nodes.addDegree(copy, 1);
		this.top = copy;
		++this.age;
		this.remember(5);
	}

	// ---- [A.4.3] END

	end(first) {
		if (!first) {
			if (this.stack.length === 0 && this.bit(this.models.FINISH)) this.finish();
			else this.stack.push(this.top);
		}
		const { nodes } = this;
		const v = [0, 1].map((i) => this.newDummyOrVertex(this.models.DUMMY_END[i]));
		const a = nodes.make(v[0], 1);
		const b = nodes.make(v[1], 1);
		nodes.next[a] = b;
		nodes.gate[a] = nodeGate(b);
		nodes.next[b] = a;
		nodes.gate[b] = nodeGate(a);
		this.top = a;
		this.age = 0;
		this.remember(6);
	}

	// ---- [A.4.4] EXPAND that joins

	joinedExpand(join) {
		const { nodes } = this;
		const h = join === START ? this.stack[this.stack.length - 1] : this.handleNode();
		const v = nodes.vertex[h];
		if (v === CLOSED) badConnectivity('A.4.4', 'a join with a vertex that is closed');
		if (v === DUMMY) this.dummyRun();
		else if (this.bit(this.models.JOINED_SPUR[join])) this.expandSpur(v);
		else this.run(v);
		if (join === START) this.joinStart();
		else this.joinHandle(h);
	}

	handleNode() {
		const last = this.nodes.count - 1;
		const back = this.streams.golomb(this.models.HANDLE_NODE);
		if (back > last) badConnectivity('A.4.4', 'a handle with a node that does not exist');
		return last - back;
	}

	joinStart() {
		const { nodes, top } = this;
		const s = this.stack.pop();
		if (nodes.vertex[s] === CLOSED) badConnectivity('A.4.4', 'a join with a node that its own EXPAND closed');
		nodes.swapLinks(top, s);
		const d = nodes.degree(top) + nodes.degree(s);
		nodes.setDegree(s, d);
		nodes.shared[s] = 1;
		nodes.setDegree(top, d + 1);
	}

	joinHandle(h) {
		const { nodes, streams } = this;
		const t = (h + streams.signedGolomb(this.models.HANDLE_TOP)) >>> 0;
		const depth = streams.golomb(this.models.HANDLE_DEPTH);
		if (t >= nodes.count) badConnectivity('A.4.4', 'a handle with a node that does not exist');
		if (depth > 255 || depth > this.stack.length) badConnectivity('A.4.4', 'a handle with a digon that does not exist');
		if (nodes.vertex[t] === CLOSED || nodes.vertex[h] === CLOSED) badConnectivity('A.4.4', 'a handle with a closed node');
		nodes.swapLinks(this.top, h);
		this.stack.splice(this.stack.length - depth, 0, t);
		nodes.shared[h] = 1;
		nodes.addDegree(this.top, 1);
	}

	// ---- [A.4.5] EXPAND

	expandSpur(v) {
		const { nodes } = this;
		const { tip, copy } = this.spur(v);
		nodes.shared[copy] = 1;
		nodes.addDegree(this.top, 1);
		this.top = tip;
		++this.age;
		this.remember(0);
	}

	run(v) {
		const { nodes } = this;
		const closing = nodes.next[this.top];
		const fan = newFan();
		let q = this.top;
		for (;;) {
			this.takeGate(v, q, fan);
			q = nodes.next[q];
			if (q === this.top) break;
			if (!this.bit(this.models.RUN[this.runContext(fan.taken, q)])) break;
		}
		this.close(closing, fan.taken - 1);
		this.endRun(v, q, fan);
	}

	runContext(position, q) {
		const { nodes } = this;
		return 32 * (Math.min(position, 4) - 1) + 2 * Math.min(nodes.degree(q), 15) + nodes.shared[q];
	}

	dummyRun() {
		const { nodes } = this;
		const r = this.streams.golomb(this.models.DUMMY_DEGREE);
		if (r === 0) {
			this.expandSpur(DUMMY);
			return;
		}
		const closing = nodes.next[this.top];
		const fan = newFan();
		let q = this.top;
		do {
			this.takeGate(DUMMY, q, fan);
			q = nodes.next[q];
		} while (fan.taken < r && q !== this.top);
		if (fan.taken !== r) badConnectivity('A.4.5', 'a dummy with more gates than the ring has');
		this.close(closing, fan.taken - 1);
		this.endRun(DUMMY, q, fan);
	}

	endRun(v, q, fan) {
		const { nodes, top } = this;
		const n = nodes.make(v, fan.taken + 1);
		nodes.addDegree(top, 1);
		nodes.addDegree(q, 1);
		nodes.next[top] = n;
		nodes.gate[top] = fan.first;
		nodes.next[n] = q;
		nodes.gate[n] = fan.lastHalf;
		this.top = n;
		++this.age;
		this.remember(Math.min(fan.taken, 4));
	}

	// ---- [A.4.6] End of a component

	finish() {
		if (this.stack.length !== 0) badConnectivity('A.4.6', 'the end of a component while digons wait');
		const v = this.newDummyOrVertex(this.models.DUMMY_FINISH);
		const fan = newFan();
		let q = this.top;
		do {
			this.takeGate(v, q, fan);
			q = this.nodes.next[q];
		} while (q !== this.top);
		this.close(this.top, fan.taken);
		if (fan.first !== NONE) this.twins[fan.first] = fan.lastHalf;
		if (fan.lastHalf !== NONE) this.twins[fan.lastHalf] = fan.first;
		this.top = NONE;
	}
}

// The surface of a piece, with vertices at its corners.
export function decodeConnectivity(streams, modelSet, piece) {
	return new Connectivity(streams, modelSet, piece).decode();
}
