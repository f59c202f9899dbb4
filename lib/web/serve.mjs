// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// What a worker of a decoder pool does. It is sent the compiled module, then lists of jobs, which are payloads, one block or, if it is told
// how, whole files. Lists are answered in the order in which they came, and the next may come before the last is answered. Buffers of payloads,
// blocks and results are transferred. It keeps what it needs for other blocks of a payload until it is told to close it. If a job needs more
// than the core of the decoder, the worker asks for the whole decoder, and waits for it.
import { asTrap } from './arguments.mjs';
import { buffersOfBlock, runTask } from './block_decoder.mjs';
import { buffersOf, Decoder } from './core.mjs';
import { MccError } from './error.mjs';
import { listenInNode } from './node.mjs';
import { nextTask } from './tasks.mjs';
import { warmUpPayload } from './warm_up.mjs';

/** After so many, engines compile well what is called often. What more of them take is not saved later. */
const WARM_UPS = 10;

/** Of a message that does not arrive whole. */
const UNREADABLE = { isUnreadable: true };

let answerToFile;
let post;
/** The core, unless the page has only loaded the whole decoder. */
let decoder;
/** The promise of the whole decoder, once it was asked for, and what is called with it. */
let whole;
let gotWhole;
const blockDecoders = new Map();
/** Messages are answered one after the other. */
let answered = Promise.resolve();
let unansweredCount = 0;

/**
 * Answers the messages to this worker.
 * @param {(file: Uint8Array, options: object) => Promise<{ file?: Uint8Array }>} [answer]  for workers that know what to do with files
 */
export function serve(answer) {
  answerToFile = answer;
  if (typeof self === 'object' && typeof self.postMessage === 'function') {
    post = (message, moved) => self.postMessage(message, moved);
    self.onmessage = ({ data }) => take(data);
    self.onmessageerror = () => post(UNREADABLE, []);
  } else {
    listenInNode(take, UNREADABLE, (send) => { post = send; });
  }
}

function take(message) {
  if (message.whole !== undefined) {
    gotWhole(message.whole);
    return;
  }
  ++unansweredCount;
  answered = answered.then(() => answer(message)).finally(() => --unansweredCount);
}

async function answer({ close, module, jobs }) {
  if (close !== undefined) {
    blockDecoders.delete(close);
  } else if (module !== undefined) {
    decoder = new Decoder(module);
    post({ isUp: true }, []);
    await warmUp().catch(() => {}); // what goes wrong here goes wrong again when a payload is decoded
  } else {
    const answers = [];
    for (const job of jobs) answers.push(await answerTo(job));
    post({ answers }, answers.flatMap(buffersOfAnswer));
  }
}

/** Decodes until there is something to do. */
async function warmUp() {
  await decoder.prepare();
  const payload = warmUpPayload();
  for (let i = 0; i < WARM_UPS; ++i) {
    await nextTask(); // takes the messages that wait
    if (unansweredCount > 1) return;
    await decoder.decode(payload);
  }
}

async function answerTo({ bytes, options, task, file }) {
  try {
    if (task !== undefined) return { block: await decodeBlock(task) };
    if (file !== undefined) return await answerToFile(file, { ...options, decode });
    const begin = performance.now();
    const decoded = await decode(bytes, options);
    return { decoded, ms: performance.now() - begin };
  } catch (error) {
    const { message, code } = asTrap(error);
    return { message, code };
  }
}

const decode = (bytes, options) => tryDecoders(decoder, (one) => one.decode(bytes, options));

/** The core has no blocks. */
const decodeBlock = async (task) => tryDecoders(await (whole ?? decoder), ({ module }) => runTask(blockDecoders, module, task));

/** Calls a function with a decoder, and again with the whole one if it takes more than the core. */
async function tryDecoders(first, call) {
  try {
    return await call(first);
  } catch (error) {
    if (error.code !== 'NotInCore') throw error;
  }
  return call(await (whole ??= askForWhole()));
}

async function askForWhole() {
  const { module, message, code } = await new Promise((resolve) => {
    gotWhole = resolve;
    post({ needsWhole: true }, []);
  });
  if (module !== undefined) return new Decoder(module);
  whole = undefined; // the next job asks again
  throw new MccError(message, code);
}

const buffersOfAnswer = ({ decoded, block, file }) => (
  block ? buffersOfBlock(block) : decoded ? buffersOf(decoded) : file ? [file.buffer] : []);
