// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// A worker of a decoder pool. It is sent the compiled module, then lists of jobs, which are payloads or one
// block; buffers are transferred both ways. It keeps what it needs for other blocks of a payload until
// it is told to close it. If a job needs more than the core of the decoder, the worker keeps
// the list until it is sent the whole decoder, which from then on decodes everything that the core
// cannot.
import { asTrap } from './arguments.mjs';
import { buffersOfBlock, runTask } from './block_decoder.mjs';
import { buffersOf, Decoder } from './core.mjs';
import { listenInNode } from './node.mjs';
import { nextTask } from './tasks.mjs';
import { warmUpPayload } from './warm_up.mjs';

/** After so many, engines compile well what is called often. What more of them take is not saved later. */
const WARM_UPS = 10;

const decoders = [];
const blockDecoders = new Map();
let waiting = null;
/** Messages are answered one after the other. */
let answered = Promise.resolve();
let unansweredCount = 0;

function take(message, post) {
  ++unansweredCount;
  answered = answered.then(() => answer(message, post)).finally(() => --unansweredCount);
}

async function answer(request, post) {
  if (request.close !== undefined) {
    blockDecoders.delete(request.close);
    return;
  }
  if (request.module !== undefined) {
    decoders.push(new Decoder(request.module));
    if (waiting === null) {
      post({ isUp: true }, []);
      await warmUp(decoders[0]).catch(() => {}); // what goes wrong here goes wrong again when a payload is decoded
      return;
    }
    request = waiting;
  }
  const { jobs, answers = [] } = request;
  waiting = null;
  for (const [i, job] of jobs.entries()) answers[i] ??= await answerTo(job);
  if (!answers.includes(undefined)) {
    post({ answers }, answers.flatMap(({ decoded, block }) => (block ? buffersOfBlock(block) : decoded ? buffersOf(decoded) : [])));
    return;
  }
  waiting = { jobs, answers };
  post({ needsWhole: true }, []);
}

/** Decodes until there is something to do. */
async function warmUp(decoder) {
  await decoder.prepare();
  const payload = warmUpPayload();
  for (let i = 0; i < WARM_UPS && unansweredCount === 1; ++i) {
    await decoder.decode(payload);
    await nextTask();
  }
}

/** Returns undefined if it takes a decoder that is not there yet. */
async function answerTo({ bytes, options, task }) {
  try {
    if (task !== undefined) return { block: await runTask(blockDecoders, decoders.at(-1).module, task) };
    const begin = performance.now();
    const decoded = await decoders[0].decode(bytes, options).catch((error) => {
      if (error.code !== 'NotInCore' || decoders.length === 1) throw error;
      return decoders[1].decode(bytes, options);
    });
    return { decoded, ms: performance.now() - begin };
  } catch (error) {
    const { message, code } = asTrap(error);
    return code === 'NotInCore' && decoders.length === 1 ? undefined : { message, code };
  }
}

/** Of a message that does not arrive whole. */
const UNREADABLE = { isUnreadable: true };

if (typeof self === 'object' && typeof self.postMessage === 'function') {
  self.onmessage = ({ data }) => take(data, (message, moved) => self.postMessage(message, moved));
  self.onmessageerror = () => self.postMessage(UNREADABLE);
} else {
  listenInNode(take, UNREADABLE);
}
