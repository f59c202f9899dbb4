// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Replaces quantised floats by the integers of KHR_mesh_quantization, which take half of the memory on a graphics card or less.
import { nextTask } from './tasks.mjs';

/** What the page's thread works at most before it lets others work. */
const WORK_MILLISECONDS = 3;
const SLICE = 1 << 14;
const FLOAT = 5126;
const [POSITION, NORMAL, TANGENT, TEXCOORD, COLOR] = [0, 1, 2, 3, 4];
const UNSIGNED_SHORT = 5123;
const MOST = 65535;
/** Much larger than the rounding of a float between -1 and 1, and much smaller than any step. */
const SLACK = 1e-6;

/** From small to large; `last` is the integer that stands for 1. */
const SIGNED = [{ IntegerArray: Int8Array, componentType: 5120, last: 127 }, { IntegerArray: Int16Array, componentType: 5122, last: 32767 }];
const UNSIGNED = [{ IntegerArray: Uint8Array, componentType: 5121, last: 255 }, { IntegerArray: Uint16Array, componentType: UNSIGNED_SHORT, last: MOST }];

/**
 * Makes attributes of a DecodedPayload integers, where no value moves by more than half a step of an integer type whose steps are not coarser
 * than those that the payload keeps. Positions become the integers of their lattice. Elements are padded to multiples of 4 bytes. All others stay
 * float: what is not quantised or does not fit, weights, which must add up to 1, and morph targets, which engines add to the others. Accessors
 * and their buffer views tell of it; `min` and `max` of positions stay those of the floats. In between, the thread may do other things.
 *
 * @param {object} lists  { accessors, bufferViews } of PayloadViews, which are changed
 * @param {import('./types.mjs').DecodedPayload} decoded
 * @param {object} payload  of payloadsOf()
 * @param {Set<number>} stay  accessors of positions that stay float
 * @returns {Promise<Map<number, { step: number, origin: number[] }>>}  by accessor of positions: they are origin + step * integer
 */
export async function makeIntegers({ accessors, bufferViews }, { pieces }, { targets }, stay) {
  const attributeOf = ({ piece, attribute }) => pieces[piece].attributes[attribute];
  const fixed = new Set(targets.filter(({ accessor }) => stay.has(accessor)).map(attributeOf)
    .filter((attribute) => attribute?.semantic === POSITION));
  const places = new Map();
  const pace = new Pace();
  for (const target of targets) {
    const attribute = attributeOf(target);
    const accessor = accessors[target.accessor];
    if (attribute === undefined || accessor.componentType !== FLOAT || fixed.has(attribute)) continue; // undefined: indices
    if (attribute.componentType === FLOAT) Object.assign(attribute, await integersOf(attribute, pace));
    const { componentType, normalized, array, place } = attribute;
    if (componentType === FLOAT) continue;
    Object.assign(accessor, { componentType, normalized });
    bufferViews[accessor.bufferView].byteStride = array.byteLength / accessor.count;
    if (place !== undefined) places.set(target.accessor, place);
    else accessor.min = accessor.max = undefined;
  }
  return places;
}

/** Lets the thread do other things. */
class Pace {
  #until = performance.now() + WORK_MILLISECONDS;

  async pause() {
    if (performance.now() < this.#until) return;
    await nextTask();
    this.#until = performance.now() + WORK_MILLISECONDS;
  }
}

/** Returns what changes in an attribute; undefined if it stays float. */
function integersOf(attribute, pace) {
  const { semantic, morphTarget, bits } = attribute;
  if (morphTarget !== 0 || !(bits > 0)) return undefined;
  return semantic === POSITION ? latticeIntegers(attribute, pace) : normalizedIntegers(attribute, pace);
}

/** Returns undefined if they are too far apart. */
async function latticeIntegers({ array, componentCount, lattice }, pace) {
  const [origin, step] = [lattice.slice(0, componentCount), lattice[4]];
  const low = origin.map(() => Infinity);
  const high = origin.map(() => -Infinity);
  for (let i = 0; i < array.length; ++i) {
    const c = i % componentCount;
    if (array[i] < low[c]) low[c] = array[i];
    if (array[i] > high[c]) high[c] = array[i];
  }
  await pace.pause();
  const first = low.map((value, c) => Math.round((value - origin[c]) / step));
  if (high.some((value, c) => !(Math.round((value - origin[c]) / step) - first[c] <= MOST))) return undefined;
  const integers = await padded(array, componentCount, Uint16Array, pace, (value, c) => Math.round((value - origin[c]) / step) - first[c]);
  return { array: integers, componentType: UNSIGNED_SHORT, place: { step, origin: origin.map((value, c) => value + first[c] * step) } };
}

/** Returns undefined if no type is fine enough, or if values are outside of what it can hold. */
async function normalizedIntegers({ array, componentCount, semantic, bits, lattice }, pace) {
  const isUnitVector = semantic === NORMAL || semantic === TANGENT;
  if (!isUnitVector && semantic !== TEXCOORD && semantic !== COLOR) return undefined;
  // Unit vectors have no lattice: this is how far points of the octahedral grid, or angles, are apart.
  const coded = lattice?.[4] ?? 2 / (2 ** bits - 2);
  const type = (isUnitVector ? SIGNED : UNSIGNED).find(({ last }) => 1 / last <= coded * (1 + SLACK));
  const low = isUnitVector ? -1 : 0;
  if (type === undefined || !array.every((value) => value >= low - SLACK && value <= 1 + SLACK)) return undefined;
  const { IntegerArray, componentType, last } = type;
  const round = (value) => Math.round(Math.min(1, Math.max(low, value)) * last);
  return { array: await padded(array, componentCount, IntegerArray, pace, round), componentType, normalized: true };
}

async function padded(array, componentCount, IntegerArray, pace, round) {
  const aligned = 4 / IntegerArray.BYTES_PER_ELEMENT;
  const stride = Math.ceil(componentCount / aligned) * aligned;
  const count = array.length / componentCount;
  const integers = new IntegerArray(count * stride);
  for (let begin = 0; begin < count; begin += SLICE) {
    for (let i = begin; i < Math.min(count, begin + SLICE); ++i) {
      for (let c = 0; c < componentCount; ++c) integers[i * stride + c] = round(array[i * componentCount + c], c);
    }
    await pace.pause();
  }
  return integers;
}
