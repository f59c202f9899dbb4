// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Bytes as a text that can stand in a script. Brotli makes nearly as little of it as of the bytes, and of base64 a third more: the most
// frequent bytes are one character, and equal bytes always look the same.

/** The first characters of pairs; others are bytes by themselves. Three would do, but brotli makes less of the text so. */
const PAIRS = 5;
const SINGLES = 80;
const FIRST = 40;
/** Characters that scripts would write in another way. */
const [BACKSLASH, BACKTICK] = [92, 96];
/** How many bytes each of the first characters tells of: whether they are single. */
const BITS = 6;
const TOLD = Math.ceil(256 / BITS);

/** @param {string} text of packText() */
export function unpackText(text) {
  const numberAt = (i) => {
    const code = text.charCodeAt(i);
    return code - FIRST - (code > BACKSLASH) - (code > BACKTICK);
  };
  const values = [[], []]; // of pairs and of single characters
  for (let byte = 0; byte < 256; ++byte) values[(numberAt(byte / BITS) >> (byte % BITS)) & 1].push(byte);
  const bytes = new Uint8Array(text.length);
  let length = 0;
  for (let i = TOLD; i < text.length; ++i) {
    const number = numberAt(i);
    bytes[length++] = number < PAIRS ? values[0][SINGLES * number + numberAt(++i) - PAIRS] : values[1][number - PAIRS];
  }
  return bytes.subarray(0, length);
}

/** The inverse of unpackText(). */
export function packText(bytes) {
  const codes = Array.from({ length: 2 ** 7 }, (_, code) => code).filter((code) => code >= FIRST && code !== BACKSLASH && code !== BACKTICK);
  const characters = codes.map((code) => String.fromCharCode(code));
  const counts = new Array(256).fill(0);
  for (const byte of bytes) ++counts[byte];
  const values = [...counts.keys()];
  const singles = new Set([...values].sort((a, b) => counts[b] - counts[a]).slice(0, SINGLES));
  const texts = [];
  for (const [i, byte] of values.filter((each) => singles.has(each)).entries()) texts[byte] = characters[PAIRS + i];
  for (const [i, byte] of values.filter((each) => !singles.has(each)).entries()) {
    texts[byte] = characters[Math.floor(i / SINGLES)] + characters[PAIRS + (i % SINGLES)];
  }
  const told = Array.from({ length: TOLD }, (_, i) => characters[values.slice(BITS * i, BITS * (i + 1))
    .reduce((sum, byte, bit) => sum + (singles.has(byte) ? 2 ** bit : 0), 0)]);
  return [...told, ...Array.from(bytes, (byte) => texts[byte])].join('');
}
