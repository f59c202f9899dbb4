// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Makes one GLB of the files that a user has dropped or chosen together: a GLB, or a .gltf with its buffers and images.
import { BIN_CHUNK, FileError, MAX_FILE_BYTES, formatCount, readGltf } from './glb.mjs';
import { writeGlb } from './vendor/gltf-mcc/unpack.mjs';

const IMAGE_TYPES = [['image/png', [0x89, 0x50]], ['image/jpeg', [0xff, 0xd8]], ['image/webp', [0x52, 0x49]]];

const isModel = ({ name }) => /\.(glb|gltf)$/i.test(name);

/**
 * Chooses what to open: the first model, or the first file if none looks like one.
 * @param {File[]} files
 * @returns {{ model: File, parts: File[], others: File[] }} parts: what it may refer to; others: models that are not opened
 */
export function chooseModel(files) {
  const [model = files[0], ...others] = files.filter(isModel);
  return { model, parts: files.filter((file) => file !== model && !isModel(file)), others };
}

/** Checks a size before anything is read. */
export function checkFileSize(bytes) {
  if (bytes <= MAX_FILE_BYTES) return;
  const mebibytes = (size) => `${formatCount(size / 2 ** 20)} MiB`;
  throw new FileError(`The file has ${mebibytes(bytes)}; this page takes ${mebibytes(MAX_FILE_BYTES)} at most. `
    + 'The command line tool takes larger ones: gltf-mcc convert model.glb small.glb');
}

/**
 * Puts everything that a model refers to into one GLB.
 * @param {string} name of the model
 * @param {Uint8Array} bytes of the model; returned as they are if it is a GLB that refers to nothing
 * @param {File[]} parts
 * @returns {Promise<{ bytes: Uint8Array, unused: File[] }>}
 */
export async function wholeGlb(name, bytes, parts) {
  const { json, bin, isGlb } = readGltf(bytes);
  const named = [...json.buffers ?? [], ...json.images ?? []].filter(({ uri }) => uri !== undefined);
  if (isGlb && named.length === 0) return { bytes, unused: parts };
  const found = findParts(name, named.map(({ uri }) => uri), parts);
  const whole = new Whole(json);
  for (const [index, buffer] of (json.buffers ?? []).entries()) {
    whole.addBuffer(index, buffer, buffer.uri === undefined ? bin : await contentsOf(buffer.uri, found));
  }
  for (const image of json.images ?? []) if (image.uri !== undefined) whole.addImage(image, await contentsOf(image.uri, found));
  const used = new Set(found.values());
  return { bytes: whole.write(), unused: parts.filter((file) => !used.has(file)) };
}

/** Returns the files of all URIs. */
function findParts(name, uris, parts) {
  const outside = [...new Set(uris.filter((uri) => !uri.startsWith('data:')))];
  const byName = new Map(parts.map((file) => [file.name, file]));
  const found = new Map(outside.map((uri) => [uri, byName.get(nameOf(uri))]));
  const missing = outside.filter((uri) => found.get(uri) === undefined);
  const advice = `or combine them first: gltf-mcc decode ${/\.gltf$/i.test(name) ? 'model.gltf' : 'model.glb'} whole.glb`;
  if (missing.length !== 0) {
    const list = missing.slice(0, 3).map((uri) => `“${uri}”`).join(', ');
    const more = missing.length > 3 ? ` and ${missing.length - 3} more` : '';
    throw new FileError(`The file refers to ${list}${more}. Drop or choose all of these files together with it, ${advice}`);
  }
  if (new Set(found.values()).size !== outside.length) throw new FileError(`Two files of different folders have the same name. Rename one, ${advice}`);
  checkFileSize([...found.values()].reduce((sum, { size }) => sum + size, 0));
  return found;
}

/** The name of a file without its folder. */
function nameOf(uri) {
  const last = uri.split(/[/\\]/).at(-1);
  try {
    return decodeURIComponent(last);
  } catch {
    return last;
  }
}

async function contentsOf(uri, found) {
  if (!uri.startsWith('data:')) return new Uint8Array(await found.get(uri).arrayBuffer());
  const [, base64] = /^data:[^,]*;base64,(.*)$/s.exec(uri) ?? [];
  try {
    return Uint8Array.from(atob(base64), (character) => character.charCodeAt(0));
  } catch {
    throw new FileError('The file is damaged: a data: URI in it is not base64.');
  }
}

/** A document whose buffers become one. */
class Whole {
  constructor(json) {
    this.json = json;
    this.parts = [];
    this.length = 0;
    this.begins = [];
    this.views = [...json.bufferViews ?? []];
  }

  add(bytes) {
    const at = this.length;
    this.parts.push({ at, bytes });
    this.length = Math.ceil((at + bytes.length) / 8) * 8;
    checkFileSize(this.length);
    return at;
  }

  addBuffer(index, { byteLength, uri }, bytes) {
    if (!(byteLength <= bytes.length)) {
      const where = uri === undefined || uri.startsWith('data:') ? 'a buffer' : `“${uri}”`;
      throw new FileError(`The file is damaged: ${where} has ${formatCount(bytes.length)} bytes instead of ${formatCount(byteLength)}.`);
    }
    this.begins[index] = this.add(bytes.subarray(0, byteLength));
  }

  addImage(image, bytes) {
    const type = IMAGE_TYPES.find(([, begin]) => begin.every((value, i) => bytes[i] === value))?.[0];
    const view = { byteOffset: this.add(bytes), byteLength: bytes.length };
    image.bufferView = this.views.push(view) - 1;
    image.mimeType = type ?? image.mimeType;
    delete image.uri;
  }

  write() {
    const bufferViews = this.views.map(({ buffer, byteOffset = 0, ...view }) => {
      if (buffer === undefined) return { buffer: 0, byteOffset, ...view };
      if (this.begins[buffer] === undefined) throw new FileError('The file is damaged: a buffer view is in a buffer that is not there.');
      return { buffer: 0, byteOffset: this.begins[buffer] + byteOffset, ...view };
    });
    const buffers = this.length === 0 ? undefined : [{ byteLength: this.length }];
    const json = { ...this.json, buffers, bufferViews: bufferViews.length === 0 ? undefined : bufferViews };
    return writeGlb(json, [{ type: BIN_CHUNK, data: { length: this.length, parts: this.parts } }]);
  }
}
