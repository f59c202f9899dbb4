// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// A worker of a decoder pool. It is sent the compiled module, then one payload or one block at a
// time; buffers are transferred both ways. It keeps what it needs for other blocks of a payload until
// it is told to close it. If a payload or a block needs more than the core of the decoder, the worker keeps
// it until it is sent the whole decoder, which from then on decodes everything that the core
// cannot.
import { asTrap } from './arguments.mjs';
import { buffersOfBlock, runTask } from './block_decoder.mjs';
import { buffersOf, Decoder } from './core.mjs';
import { importOfNode } from './node.mjs';

const decoders = [];
const blockDecoders = new Map();
let waiting = null;
/** Messages are answered one after the other. */
let answered = Promise.resolve();

function take(message, post) {
  answered = answered.then(() => answer(message, post));
}

async function answer(request, post) {
  if (request.close !== undefined) {
    blockDecoders.delete(request.close);
    return;
  }
  if (request.module !== undefined) {
    decoders.push(new Decoder(request.module));
    if (waiting === null) return;
    request = waiting;
  }
  const { bytes, options, task } = request;
  waiting = null;
  try {
    if (task !== undefined) {
      const block = await runTask(blockDecoders, decoders.at(-1).module, task);
      post({ decoded: block }, buffersOfBlock(block));
      return;
    }
    const decoded = await decoders[0].decode(bytes, options).catch((error) => {
      if (error.code !== 'NotInCore' || decoders.length === 1) throw error;
      return decoders[1].decode(bytes, options);
    });
    post({ decoded }, buffersOf(decoded));
  } catch (error) {
    const { message, code } = asTrap(error);
    const needsWhole = code === 'NotInCore' && decoders.length === 1;
    if (needsWhole) waiting = request;
    post({ needsWhole, message, code }, []);
  }
}

/** Of a message that does not arrive whole. */
const UNREADABLE = { message: 'the message to the worker cannot be read', code: 'BadArgument' };

if (typeof self === 'object' && typeof self.postMessage === 'function') {
  self.onmessage = ({ data }) => take(data, (message, moved) => self.postMessage(message, moved));
  self.onmessageerror = () => self.postMessage(UNREADABLE);
} else {
  // Does not use await at the top level, because the usual output format of bundlers for workers
  // does not allow it. Messages are queued until the listener is there.
  importOfNode('worker_threads').then(({ parentPort }) => {
    parentPort.on('message', (data) => take(data, (message, moved) => parentPort.postMessage(message, moved)));
    parentPort.on('messageerror', () => parentPort.postMessage(UNREADABLE));
  });
}
