// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
import { Extension, GLB_BUFFER, PropertyType } from '@gltf-transform/core';
import { Budget, namedBytes, sum } from './budget.mjs';
import { EXTENSION_NAME, elementsOf, payloadsOf } from './document.mjs';
import { asMccError, fail, inView, MccError } from './error.mjs';
import { BIN_CHUNK, readGlb, writeGlb } from './unpack.mjs';

/**
 * Reads and writes KHR_mesh_collapse_compression with glTF-Transform.
 *
 *     const io = new NodeIO().registerExtensions([KHRMeshCollapseCompression]);
 *     io.registerDependencies({
 *       'mcc.decoder': decoder,  // the module gltf-mcc, after `await decoder.ready`
 *       'mcc.encoder': encoder,  // to write: gltf-mcc/encoder, after `await encoder.initEncoder()`
 *       'mcc.limits': { maxDecodedBytes: 2 ** 30 },  // limits for reading; optional
 *     });
 *
 * After reading, a document has its geometry in ordinary accessors. As long as it has this
 * extension, it is compressed again when it is written; `extension.dispose()` ends that. The output
 * is the same as that of the program gltf-mcc for the same document and options. It is decoded and
 * compared with the document before it is returned.
 */
export class KHRMeshCollapseCompression extends Extension {
  static EXTENSION_NAME = EXTENSION_NAME;
  extensionName = EXTENSION_NAME;
  prereadTypes = [PropertyType.PRIMITIVE];
  readDependencies = ['mcc.decoder', 'mcc.limits'];
  writeDependencies = ['mcc.encoder'];
  #decoder;
  #encoder;
  #encoderOptions = {};
  #limits;
  #report;

  install(key, dependency) {
    if (key === 'mcc.decoder') this.#decoder = dependency;
    if (key === 'mcc.limits') this.#limits = dependency;
    if (key === 'mcc.encoder') this.#encoder = dependency;
    return this;
  }

  /**
   * Sets the options. They take effect when the document is written.
   * @param {import('./encoder.mjs').EncodeOptions} options
   */
  setEncoderOptions(options) {
    this.#encoderOptions = { ...options };
    return this;
  }

  /** Returns the sizes and measured errors of the last write; undefined before the first. */
  getReport() {
    return this.#report;
  }

  preread(context) {
    if (!this.#decoder) {
      if (!this.isRequired()) return this; // there is a fallback
      refuse('Please install the dependency "mcc.decoder".');
    }
    const payloads = payloadsOf(context.jsonDoc.json);
    const fileBytes = Object.values(context.jsonDoc.resources).reduce((sum, { byteLength }) => sum + byteLength, 0);
    const budget = new Budget(fileBytes, this.#limits);
    budget.add(sum(payloads.map(namedBytes)));
    for (const payload of payloads) {
      const { bufferView, targets } = payload;
      const bytes = context.bufferViews[bufferView];
      // glTF-Transform silently shortens a view that is longer than its buffer.
      if (bytes?.byteLength !== context.jsonDoc.json.bufferViews[bufferView].byteLength) {
        fail(`/bufferViews/${bufferView}`, 'reaches beyond its buffer');
      }
      const decoded = this.#decode(payload, bytes, budget);
      const taken = new Set();
      for (const target of targets) this.#fill(context, target, decoded, bufferView, taken, budget);
    }
    return this;
  }

  #decode(payload, bytes, budget) {
    try {
      return budget.settle(payload, this.#decoder.decodePayloadSync?.(bytes, budget.optionsFor(payload)));
    } catch (error) {
      throw inView(error, payload.bufferView);
    }
  }

  // Each accessor gets an array of its own, because callers may change it.
  #fill(context, target, decoded, payloadView, taken, budget) {
    const definition = context.jsonDoc.json.accessors[target.accessor];
    let array = elementsOf(decoded, target, definition);
    if (taken.has(array)) {
      budget.add(array.byteLength);
      array = array.slice();
    }
    taken.add(array);
    context.accessors[target.accessor].setArray(array).setBuffer(context.bufferViewBuffers[payloadView]);
  }

  // The buffers of a fallback are empty now, and a GLB may have only one buffer.
  read() {
    for (const buffer of this.document.getRoot().listBuffers()) {
      if (buffer.listParents().every(({ propertyType }) => propertyType === PropertyType.ROOT)) buffer.dispose();
    }
    return this;
  }

  // The document is complete here, except for what extensions with later names add to its objects.
  write(context) {
    const { json, resources } = context.jsonDoc;
    removeName(json, EXTENSION_NAME);
    if (!this.#encoder) refuse('Please install the dependency "mcc.encoder".');
    checkViews(json);
    const unwritten = unwrittenExtensions(this.document, context);
    // These extensions may depend on an order, which the encoder keeps if it sees their names.
    for (const { extensionName, definitionOf } of unwritten) (definitionOf().extensions ??= {})[extensionName] = {};
    const { glb, report } = this.#encoder.encodeGlbSync(pack(json, resources), this.#encoderOptions);
    this.#report = report;
    takeOver(context.jsonDoc, readGlb(glb));
    for (const { extensionName, definitionOf } of unwritten) delete definitionOf().extensions[extensionName];
    return this;
  }
}

/**
 * Returns a transform after which the document is compressed when it is written.
 *
 *     await document.transform(weld(), prune(), meshCollapse({ positionBits: 12 }));
 *
 * @param {import('./encoder.mjs').EncodeOptions} [options]
 */
export function meshCollapse(options = {}) {
  return (document) => {
    document.createExtension(KHRMeshCollapseCompression).setRequired(true).setEncoderOptions(options);
  };
}

function refuse(message) {
  throw new MccError(`[${EXTENSION_NAME}] ${message}`, 'BadArgument');
}

// A document that was read from a file with EXT_meshopt_compression still has that extension.
function checkViews({ bufferViews = [] }) {
  const names = bufferViews.flatMap(({ extensions = {} }) => Object.keys(extensions));
  const coder = names.find((name) => name.endsWith('_meshopt_compression'));
  if (coder === undefined) return;
  refuse(`${coder} compresses this document, too. Please dispose of one of the two extensions.`);
}

function removeName(json, name) {
  for (const list of ['extensionsUsed', 'extensionsRequired']) json[list] = json[list]?.filter((other) => other !== name);
}

// Lists the extensions of meshes and primitives that are written later than this one, as
// { extensionName, definitionOf }.
function unwrittenExtensions(document, { jsonDoc: { json }, meshIndexMap }) {
  return document.getRoot().listMeshes().flatMap((mesh) => {
    const meshOf = () => json.meshes[meshIndexMap.get(mesh)];
    const owners = [[mesh, meshOf], ...mesh.listPrimitives().map((primitive, i) => [primitive, () => meshOf().primitives[i]])];
    return owners.flatMap(([property, definitionOf]) => property.listExtensions()
      .filter(({ extensionName }) => definitionOf().extensions?.[extensionName] === undefined)
      .map(({ extensionName }) => ({ extensionName, definitionOf })));
  });
}

function pack(json, resources) {
  try {
    return packGlb(json, resources);
  } catch (error) {
    throw asMccError(error, 'the document cannot be made a GLB', 'Document'); // it may be nested too deeply
  }
}

// Makes a GLB of the document, with all of its buffers in one. Images in files stay in files.
function packGlb(json, resources) {
  const buffers = (json.buffers ?? []).map(({ uri = GLB_BUFFER }) => resources[uri] ?? new Uint8Array(0));
  const offsets = [];
  let byteLength = 0;
  for (const { length } of buffers) {
    offsets.push(byteLength);
    byteLength += Math.ceil(length / 8) * 8;
  }
  const bin = new Uint8Array(byteLength);
  buffers.forEach((bytes, i) => bin.set(bytes, offsets[i]));
  const bufferViews = json.bufferViews?.map(
    ({ byteOffset = 0, ...view }) => ({ ...view, buffer: 0, byteOffset: byteOffset + offsets[view.buffer] }));
  const complete = { ...json, bufferViews, buffers: byteLength > 0 ? [{ byteLength }] : [] };
  // Empty lists are not valid glTF. They are removed from the output only after all extensions have
  // seen it.
  const isEmpty = (value) => typeof value === 'object' && Object.keys(value).length === 0;
  const members = Object.entries(complete).filter(([, value]) => value !== undefined && !isEmpty(value));
  return writeGlb(Object.fromEntries(members), [{ type: BIN_CHUNK, data: bin }]);
}

function takeOver({ json, resources }, encoded) {
  const bin = encoded.chunks.find(({ type }) => type === BIN_CHUNK)?.data;
  const [first, ...others] = json.buffers ?? [];
  for (const { uri = GLB_BUFFER } of others) delete resources[uri];
  if (first) resources[first.uri ?? GLB_BUFFER] = bin;
  const buffers = first ? [{ ...first, byteLength: encoded.json.buffers[0].byteLength }] : [];
  // Extensions with later names still write into objects that they hold on to, like those of
  // textures, so equal objects are not replaced.
  const complete = { ...encoded.json, buffers };
  for (const key of new Set([...Object.keys(json), ...Object.keys(complete)])) {
    if (JSON.stringify(json[key]) !== JSON.stringify(complete[key])) json[key] = complete[key];
  }
}
