// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Decodes the blocks of payloads on this thread.
import { runTask } from './block_decoder.mjs';
import { blocksOf, nextTask } from './block_stream.mjs';
import { decodePayload } from './decoder.mjs';
import { wholeModule } from './source.mjs';

/** Decodes the blocks of a payload on this thread, which may do other things between two of them. */
export function decodeBlocks(source, options) {
  return blocksOf(new OnThisThread(), source, options);
}

/** Runs tasks on this thread. A pool does the same in workers. */
export class OnThisThread {
  #decoders = new Map();
  ahead = 1;

  module() {
    return wholeModule();
  }

  decodePayload(bytes, options) {
    return decodePayload(bytes, options);
  }

  /**
   * Decodes a block.
   * @param {object} key of the payload
   * @param {(isFirst: boolean) => { task: object, moved: ArrayBuffer[] }} makeTask `isFirst`: whoever runs it does not know the payload yet
   */
  async run(key, makeTask) {
    await nextTask();
    const { task } = makeTask(!this.#decoders.has(key));
    return runTask(this.#decoders, await wholeModule(), task);
  }

  /** Forgets a payload. */
  close(key) {
    this.#decoders.delete(key);
  }
}
