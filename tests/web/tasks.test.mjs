// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Where payloads are decoded: predictions, and short tasks.
import assert from 'node:assert/strict';
import test from 'node:test';
import { Pace } from '../../lib/web/pace.mjs';
import { LONGEST_TASK_MS, ShortTasks } from '../../lib/web/tasks.mjs';

test('predictions follow what was measured, of much more than of little', () => {
  const pace = new Pace();
  const before = pace.predict(1e6);
  for (let i = 0; i < 10; ++i) pace.learn(1000, 5); // of small payloads, most of the time is not for their bytes
  assert.ok(pace.predict(1e6) < 10 * before, 'a few small payloads do not say much');
  for (let i = 0; i < 20; ++i) pace.learn(1e6, 40);
  assert.ok(Math.abs(pace.predict(1e6) - 40) < 2, `${pace.predict(1e6)}`);
  assert.ok(pace.predict(0) > 0 && pace.predict(2e6) > pace.predict(1e6));
});

test('pieces of work are done in their order, as many in a task as are expected to fit', async () => {
  const tasks = new ShortTasks();
  let taskNumber = 0;
  let isDone = false;
  const { port1, port2 } = new MessageChannel();
  const inTask = [];
  const add = (ms, name) => tasks.add(ms, () => { inTask.push([name, taskNumber]); return name; });
  // Counts tasks of the event loop, as long as there is work.
  port1.onmessage = () => { ++taskNumber; if (isDone) port1.close(); else port2.postMessage(null); };
  port2.postMessage(null);
  const all = [add(0, 'a'), add(0, 'b'), add(2 * LONGEST_TASK_MS, 'c'), add(2 * LONGEST_TASK_MS, 'd')];
  assert.deepEqual(await Promise.all(all), ['a', 'b', 'c', 'd']);
  isDone = true;
  assert.deepEqual(inTask.map(([name]) => name), ['a', 'b', 'c', 'd']);
  const [, second, third, fourth] = inTask.map(([, number]) => number);
  assert.ok(third > second && fourth > third, 'long ones have tasks of their own');
});

test('what fails rejects for itself', async () => {
  const tasks = new ShortTasks();
  const failed = tasks.add(1, () => { throw new Error('mine'); });
  const after = tasks.add(1, async () => 5);
  await assert.rejects(failed, /mine/);
  assert.equal(await after, 5);
});
