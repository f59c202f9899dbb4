// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Bytes as a text that can stand in a script. Brotli makes nearly as little of it as of the bytes, and of base64 a third more: frequent
// bytes of WebAssembly are one character, and equal bytes always look the same.

/** The first characters of pairs; others are bytes by themselves. */
const PAIRS = 3;
const SINGLES = 82;
const FIRST = 40;
/** Characters that scripts would write in another way. */
const [BACKSLASH, BACKTICK] = [92, 96];

const numberOf = (code) => code - FIRST - (code > BACKSLASH ? 1 : 0) - (code > BACKTICK ? 1 : 0);

/** @param {string} text of packText() */
export function unpackText(text) {
  const bytes = new Uint8Array(text.length);
  let length = 0;
  for (let i = 0; i < text.length; ++i) {
    const number = numberOf(text.charCodeAt(i));
    bytes[length++] = number < PAIRS ? SINGLES * (number + 1) + numberOf(text.charCodeAt(++i)) - PAIRS : number - PAIRS;
  }
  return bytes.subarray(0, length);
}

/** The inverse of unpackText(). */
export function packText(bytes) {
  const codes = Array.from({ length: 2 ** 7 }, (_, code) => code).filter((code) => code >= FIRST && code !== BACKSLASH && code !== BACKTICK);
  const characters = codes.map((code) => String.fromCharCode(code));
  const characterOf = (byte) => (byte < SINGLES ? characters[PAIRS + byte]
    : characters[Math.floor(byte / SINGLES) - 1] + characters[PAIRS + (byte % SINGLES)]);
  return Array.from(bytes, characterOf).join('');
}
