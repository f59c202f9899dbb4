// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// A worker of a decoder pool. Gets the compiled module, then one payload at a time; buffers are moved both ways. A payload
// that needs more than the core of the decoder waits here for the whole one, which from then on takes what the core does not.
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
  // No await at the top level, which bundlers' usual format for workers has not. Messages wait for the listener.
  importOfNode('worker_threads').then(({ parentPort }) => {
    parentPort.on('message', (data) => answer(data, (message, moved) => parentPort.postMessage(message, moved)));
  });
}
