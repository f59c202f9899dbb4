// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// A slow link: passes connections on to a server, with a delay and so many bits per second for all of them together. The network
// emulation of Chromium's developer tools does not reach requests of service workers.
import { connect, createServer } from 'node:net';

const PART_BYTES = 4096;

/** Writes what it gets to a socket at the times it is told, in order. */
class Delay {
  #queue = [];
  #socket;

  constructor(socket) {
    this.#socket = socket;
  }

  /** @param {Buffer | undefined} bytes undefined: ends the socket */
  write(bytes, due) {
    this.#queue.push({ bytes, due });
    if (this.#queue.length === 1) this.#pump();
  }

  #pump() {
    while (this.#queue.length !== 0) {
      const wait = this.#queue[0].due - performance.now();
      if (wait > 0) {
        setTimeout(() => this.#pump(), Math.ceil(wait));
        return;
      }
      const { bytes } = this.#queue.shift();
      if (!this.#socket.writable) continue;
      if (bytes === undefined) this.#socket.end();
      else this.#socket.write(bytes);
    }
  }
}

/**
 * @param {number} port of the server on this machine
 * @param {{ bitsPerSecond: number, roundTripMs: number }} speed
 * @returns {Promise<{ origin: string, close(): void }>}
 */
export async function startLink(port, { bitsPerSecond, roundTripMs }) {
  const sockets = new Set();
  let freeAt = 0; // when the link will have sent everything
  const server = createServer((client) => {
    const far = connect(port, '127.0.0.1');
    for (const socket of [client, far]) {
      sockets.add(socket);
      socket.setNoDelay(true).on('error', () => socket.destroy()).on('close', () => sockets.delete(socket));
    }
    const [asked, answered] = [new Delay(far), new Delay(client)];
    client.on('data', (bytes) => asked.write(bytes, performance.now() + roundTripMs / 2));
    far.on('data', (bytes) => {
      for (let at = 0; at < bytes.length; at += PART_BYTES) {
        const part = bytes.subarray(at, at + PART_BYTES);
        freeAt = Math.max(freeAt, performance.now()) + (8000 * part.length) / bitsPerSecond;
        answered.write(part, freeAt + roundTripMs / 2);
      }
      // Connections take turns: none goes on before the link has sent what is waiting.
      far.pause();
      setTimeout(() => far.resume(), Math.max(0, freeAt - performance.now()));
    });
    client.on('close', () => far.destroy());
    far.on('close', () => answered.write(undefined, freeAt + roundTripMs / 2));
  });
  await new Promise((resolve) => server.listen(0, '127.0.0.1', resolve));
  return {
    origin: `http://127.0.0.1:${server.address().port}`,
    close: () => {
      server.close();
      for (const socket of sockets) socket.destroy();
    },
  };
}
