// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// The worker of tile_threads.mjs. It is told where the decoder is, and then gets files, of which it makes ones without the extension, one
// after the other.
import { asTrap } from './arguments.mjs';
import { prepareHere } from './decode.mjs';
import { listenInNode } from './node.mjs';
import { usePageSource } from './source.mjs';
import { unpackIfOurs } from './unpack_tile.mjs';

let answered = Promise.resolve();

async function answer({ where, id, bytes, limits }, post) {
  if (where !== undefined) {
    usePageSource(where);
    await prepareHere().catch(() => {}); // what goes wrong here goes wrong again when a payload is decoded
    return;
  }
  try {
    const file = await unpackIfOurs(bytes, { limits });
    if (file === bytes) post({ id }, []);
    else post({ id, file }, [file.buffer]);
  } catch (error) {
    const { message, code } = asTrap(error);
    post({ id, message, code }, []);
  }
}

function take(message, post) {
  answered = answered.then(() => answer(message, post));
}

if (typeof self === 'object' && typeof self.postMessage === 'function') {
  self.onmessage = ({ data }) => take(data, (message, moved) => self.postMessage(message, moved));
} else {
  listenInNode(take, {});
}
