// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// The decoders that tools/bench-web compares, for Node and for pages. A file is a list of units,
// as encode.mjs makes them.

const MODULES = new URL('../../node_modules/', import.meta.url);
const IN_NODE = globalThis.document === undefined;

export const CODECS = ['mcc', 'draco 0', 'draco 3', 'draco 5', 'meshopt'];

/**
 * Loads a codec's script and WebAssembly, as a page that shows its first model does.
 * @param {string} codec one of CODECS
 * @returns a function (units) => promise of what each unit decodes to, ready to call
 */
export async function loadDecoder(codec) {
  if (codec === 'mcc') {
    const { decodePayload, init } = await import('../../../../lib/web/decoder.mjs');
    await init();
    return (units) => Promise.all(units.map(({ bytes }) => decodePayload(bytes)));
  }
  if (codec === 'meshopt') {
    const { MeshoptDecoder } = await import(new URL('meshoptimizer/meshopt_decoder.mjs', MODULES).href);
    await MeshoptDecoder.ready;
    return async (units) => units.map(({ bytes, streams }) => decodeMeshopt(MeshoptDecoder, bytes, streams));
  }
  const create = await loadDracoScript('decoder');
  const module = await create({});
  return async (units) => units.map(({ bytes }) => decodeDraco(module, bytes));
}

/**
 * Draco's script, which returns a function that instantiates the module.
 * @param {'decoder'|'encoder'} role
 */
export async function loadDracoScript(role) {
  const url = new URL(`draco3d/draco_${role}_nodejs.js`, MODULES);
  if (IN_NODE) {
    const { createRequire } = await import('node:module');
    return createRequire(import.meta.url)(url.pathname);
  }
  const script = Object.assign(document.createElement('script'), { src: url.href });
  await new Promise((resolve, reject) => {
    Object.assign(script, { onload: resolve, onerror: reject });
    document.head.append(script);
  });
  return role === 'decoder' ? globalThis.DracoDecoderModule : globalThis.DracoEncoderModule;
}

/** The streams of a primitive to the arrays that a graphics card takes: lattice indices, packed normals. */
function decodeMeshopt(decoder, bytes, streams) {
  return streams.map(({ offset, length, count, stride, mode, filter }) => {
    const target = new Uint8Array(count * stride);
    decoder.decodeGltfBuffer(target, count, stride, bytes.subarray(offset, offset + length), mode, filter);
    return target;
  });
}

/**
 * Decodes a Draco buffer to indices and typed arrays: floats where the source had floats.
 * @param {(decoder) => void} prepare may set options of Draco's decoder
 * @param {(attribute) => object} describe adds to what is returned of an attribute
 */
export function decodeDraco(module, bytes, prepare = () => {}, describe = () => ({})) {
  const decoder = new module.Decoder();
  const mesh = new module.Mesh();
  prepare(decoder);
  const status = decoder.DecodeArrayToMesh(bytes, bytes.length, mesh);
  if (!status.ok()) throw new Error(status.error_msg());
  const points = mesh.num_points();
  const count = 3 * mesh.num_faces();
  const take = (byteLength, ArrayType, fill) => {
    const address = module._malloc(byteLength);
    fill(address);
    const array = new ArrayType(module.HEAPU8.buffer, address, byteLength / ArrayType.BYTES_PER_ELEMENT).slice();
    module._free(address);
    return array;
  };
  const indices = points <= 0xffff
    ? take(2 * count, Uint16Array, (at) => decoder.GetTrianglesUInt16Array(mesh, 2 * count, at))
    : take(4 * count, Uint32Array, (at) => decoder.GetTrianglesUInt32Array(mesh, 4 * count, at));
  const attributes = [];
  for (let i = 0; i < mesh.num_attributes(); ++i) {
    const attribute = decoder.GetAttribute(mesh, i);
    const components = attribute.num_components();
    const type = attribute.data_type();
    const ArrayType = {
      [module.DT_INT8]: Int8Array, [module.DT_UINT8]: Uint8Array, [module.DT_INT16]: Int16Array, [module.DT_UINT16]: Uint16Array,
      [module.DT_INT32]: Int32Array, [module.DT_UINT32]: Uint32Array, [module.DT_FLOAT32]: Float32Array,
    }[type];
    const byteLength = points * components * ArrayType.BYTES_PER_ELEMENT;
    const array = take(byteLength, ArrayType, (at) => decoder.GetAttributeDataArrayForAllPoints(mesh, attribute, type, byteLength, at));
    attributes.push({ semantic: attribute.attribute_type(), components, array, ...describe(attribute) });
  }
  module.destroy(mesh);
  module.destroy(decoder);
  return { indices, attributes, points };
}
