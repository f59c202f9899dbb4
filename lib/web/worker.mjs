// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// A worker of a decoder pool. It is sent the compiled module, then one payload at a time; buffers
// are transferred both ways. If a payload needs more than the core of the decoder, the worker keeps
// it until it is sent the whole decoder, which from then on decodes everything that the core
// cannot.
import { buffersOf, Decoder } from './core.mjs';
import { importOfNode } from './load.mjs';

const decoders = [];
let waiting = null;

async function answer({ module, bytes, options }, post) {
  if (module !== undefined) {
    decoders.push(new Decoder(module));
    if (waiting === null) return;
    ({ bytes, options } = waiting);
  }
  waiting = null;
  try {
    const decoded = await decoders[0].decode(bytes, options).catch((error) => {
      if (error.code !== 'NotInCore' || decoders.length === 1) throw error;
      return decoders[1].decode(bytes, options);
    });
    post({ decoded }, buffersOf(decoded));
  } catch ({ message, code }) {
    const needsWhole = code === 'NotInCore' && decoders.length === 1;
    if (needsWhole) waiting = { bytes, options };
    post({ needsWhole, message, code }, []);
  }
}

if (typeof self === 'object' && typeof self.postMessage === 'function') {
  self.onmessage = ({ data }) => answer(data, (message, moved) => self.postMessage(message, moved));
} else {
  // Does not use await at the top level, because the usual output format of bundlers for workers
  // does not allow it. Messages are queued until the listener is there.
  importOfNode('worker_threads').then(({ parentPort }) => {
    parentPort.on('message', (data) => answer(data, (message, moved) => parentPort.postMessage(message, moved)));
  });
}
