// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
import { Extension, GLB_BUFFER, PropertyType } from '@gltf-transform/core';
import { EXTENSION_NAME, elementsOf, payloadsOf } from './document.mjs';
import { BIN_CHUNK, readGlb, writeGlb } from './unpack.mjs';

/**
 * Reads and writes KHR_mesh_collapse_compression with glTF-Transform.
 *
 *     const io = new NodeIO().registerExtensions([KHRMeshCollapseCompression]).registerDependencies({
 *       'mcc.decoder': decoder,  // the module gltf-mcc, after `await decoder.ready`
 *       'mcc.encoder': encoder,  // to write: the module gltf-mcc/encoder, after `await encoder.initEncoder()`
 *     });
 *
 * A document that was read has its geometry in ordinary accessors. While it has this extension, it is compressed again when it is
 * written; `extension.dispose()` ends that. What is written is what the program gltf-mcc makes of the document with the same
 * options; it is decoded and compared before it is handed out.
 */
export class KHRMeshCollapseCompression extends Extension {
  static EXTENSION_NAME = EXTENSION_NAME;
  extensionName = EXTENSION_NAME;
  prereadTypes = [PropertyType.PRIMITIVE];
  readDependencies = ['mcc.decoder'];
  writeDependencies = ['mcc.encoder'];
  #decoder;
  #encoder;
  #encoderOptions = {};
  #report;

  install(key, dependency) {
    if (key === 'mcc.decoder') this.#decoder = dependency;
    if (key === 'mcc.encoder') this.#encoder = dependency;
    return this;
  }

  /**
   * Takes effect when the document is written.
   * @param {import('./encoder.mjs').EncodeOptions} options
   */
  setEncoderOptions(options) {
    this.#encoderOptions = { ...options };
    return this;
  }

  /** Sizes and measured errors of the last write; undefined before. */
  getReport() {
    return this.#report;
  }

  preread(context) {
    if (!this.#decoder) {
      if (!this.isRequired()) return this; // there is a fallback
      throw new Error(`[${EXTENSION_NAME}] Please install the dependency "mcc.decoder".`);
    }
    for (const { bufferView, targets, claims } of payloadsOf(context.jsonDoc.json)) {
      const decoded = this.#decoder.decodePayloadSync(context.bufferViews[bufferView], { claims });
      for (const target of targets) this.#fill(context, target, decoded, bufferView);
    }
    return this;
  }

  #fill(context, target, decoded, payloadView) {
    const definition = context.jsonDoc.json.accessors[target.accessor];
    context.accessors[target.accessor]
      .setArray(elementsOf(decoded, target, definition))
      .setBuffer(context.bufferViewBuffers[payloadView]);
  }

  // Buffers of a fallback are empty now, and a GLB may have one buffer only.
  read() {
    for (const buffer of this.document.getRoot().listBuffers()) {
      if (buffer.listParents().every(({ propertyType }) => propertyType === PropertyType.ROOT)) buffer.dispose();
    }
    return this;
  }

  // The document is complete here, but for what extensions with later names add to its objects. So objects stay the same ones.
  write(context) {
    const { json, resources } = context.jsonDoc;
    removeName(json, EXTENSION_NAME);
    if (!this.#encoder) throw new Error(`[${EXTENSION_NAME}] Please install the dependency "mcc.encoder".`);
    const stubs = addStubs(this.document, context);
    const { glb, report } = this.#encoder.encodeGlbSync(packGlb(json, resources), this.#encoderOptions);
    this.#report = report;
    takeOver(context.jsonDoc, readGlb(glb));
    for (const removeStub of stubs) removeStub();
    return this;
  }
}

/**
 * A transform: the document will be compressed when it is written.
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

function removeName(json, name) {
  for (const list of ['extensionsUsed', 'extensionsRequired']) json[list] = json[list]?.filter((other) => other !== name);
}

// Extensions of meshes that are written later than this one may depend on orders; the encoder has to see their names.
function addStubs(document, context) {
  const { json } = context.jsonDoc;
  return document.getRoot().listMeshes().flatMap((mesh) => {
    const definition = json.meshes[context.meshIndexMap.get(mesh)];
    const pairs = mesh.listPrimitives().map((primitive, i) => [primitive, () => definition.primitives[i]]);
    return [[mesh, () => definition], ...pairs].flatMap(([property, find]) => property.listExtensions()
      .filter(({ extensionName }) => find().extensions?.[extensionName] === undefined)
      .map(({ extensionName }) => {
        find().extensions = { ...find().extensions, [extensionName]: {} };
        return () => delete find().extensions[extensionName];
      }));
  });
}

// A GLB of the document, all of its buffers in one. Images that are files stay so.
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
  // Empty lists, which glTF does not have, are removed from what is written when all extensions have seen it.
  const isEmpty = (value) => typeof value === 'object' && Object.keys(value).length === 0;
  const members = Object.entries(complete).filter(([, value]) => value !== undefined && !isEmpty(value));
  return writeGlb(Object.fromEntries(members), [{ type: BIN_CHUNK, data: bin }]);
}

function takeOver({ json, resources }, encoded) {
  const bin = encoded.chunks.find(({ type }) => type === BIN_CHUNK)?.data;
  const [first, ...others] = json.buffers ?? [];
  for (const { uri = GLB_BUFFER } of others) delete resources[uri];
  if (first) resources[first.uri ?? GLB_BUFFER] = bin;
  const buffers = first ? [{ ...first, byteLength: encoded.json.buffers[0].byteLength }] : undefined;
  assignInPlace(json, { ...encoded.json, buffers });
}

const isContainer = (value) => typeof value === 'object' && value !== null;

// Makes `target` equal to `source`; objects and arrays that both have stay the same ones.
function assignInPlace(target, source) {
  if (Array.isArray(target)) target.length = source.length;
  for (const key of Object.keys(target)) {
    if (source[key] === undefined) delete target[key];
  }
  for (const [key, value] of Object.entries(source)) {
    if (JSON.stringify(value) === JSON.stringify(target[key])) continue; // extras belong to the document, too
    if (isContainer(value) && isContainer(target[key])) assignInPlace(target[key], value);
    else target[key] = value;
  }
}
