// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Divides work on the page's thread into short tasks, so that the page can do other things in between.

/** Longer tasks make a page miss a frame. */
export const LONGEST_TASK_MS = 8;

/** Resolves in a task of its own. */
export function nextTask() {
  return new Promise((resolve) => {
    const { port1, port2 } = new MessageChannel();
    port1.onmessage = () => {
      port1.close();
      resolve();
    };
    port2.postMessage(null);
  });
}

/** Does pieces of work one after the other, as many in a task as are expected to fit. */
export class ShortTasks {
  #waiting = [];
  #isRunning = false;

  /** @param {number} ms  how long `work` is expected to take */
  add(ms, work) {
    return new Promise((resolve, reject) => {
      this.#waiting.push({ ms, work, resolve, reject });
      if (!this.#isRunning) this.#run();
    });
  }

  async #run() {
    this.#isRunning = true;
    while (this.#waiting.length > 0) {
      await nextTask();
      const end = performance.now() + LONGEST_TASK_MS;
      do await this.#doFirst();
      while (this.#waiting.length > 0 && performance.now() + this.#waiting[0].ms <= end);
    }
    this.#isRunning = false;
  }

  async #doFirst() {
    const { work, resolve, reject } = this.#waiting.shift();
    try {
      resolve(await work());
    } catch (error) {
      reject(error);
    }
  }
}
