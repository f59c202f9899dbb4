// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Runs of programs for tools/bench-tiles: tiles per second, and what is left of runs that were killed.
import { execFileSync, spawn } from 'node:child_process';
import { createHash } from 'node:crypto';
import { mkdirSync, readFileSync, rmSync } from 'node:fs';
import path from 'node:path';
import { RECORD } from './make.mjs';
import { filesIn } from './tileset.mjs';

export const median = (numbers) => [...numbers].sort((a, b) => a - b)[numbers.length >> 1];

function secondsOf(work) {
  const begin = performance.now();
  work();
  return (performance.now() - begin) / 1000;
}

const runQuietly = (program, args) => execFileSync(program, args, { stdio: ['ignore', 'ignore', 'pipe'] });

/** Seconds of whole runs of ours: { [what]: seconds }, medians of `runs`, in turns. */
export function measureRuns(program, tileset, work, runs) {
  const folder = path.join(work, 'rates');
  const ours = (jobs) => () => runQuietly(program, ['tiles', '--quiet', '-j', `${jobs}`, tileset, folder]);
  const tasks = {
    'gltf-mcc, 1 job': ours(1),
    'gltf-mcc, 2 jobs': ours(2),
  };
  const seconds = Object.fromEntries(Object.keys(tasks).map((name) => [name, []]));
  for (let i = 0; i < runs; ++i) {
    for (const [name, task] of Object.entries(tasks)) {
      rmSync(folder, { recursive: true, force: true });
      seconds[name].push(secondsOf(task));
    }
  }
  rmSync(folder, { recursive: true, force: true });
  return Object.fromEntries(Object.entries(seconds).map(([name, list]) => [name, median(list)]));
}

/** { [name]: digest } of all files but the record, which has the times of the files. */
export function digestsOf(folder) {
  const names = filesIn(folder).filter((name) => name !== RECORD);
  return Object.fromEntries(names.map((name) => [name, createHash('sha256').update(readFileSync(path.join(folder, name))).digest('hex')]));
}

const differencesOf = (a, b) => [...new Set([...Object.keys(a), ...Object.keys(b)])].filter((name) => a[name] !== b[name]);

/** Starts a run and kills it after some milliseconds. Returns whether it was still working. */
async function killAfter(program, args, ms) {
  const child = spawn(program, args, { stdio: 'ignore' });
  const ended = new Promise((resolve) => child.on('exit', (code, signal) => resolve(signal)));
  const timer = setTimeout(() => child.kill('SIGKILL'), ms);
  const signal = await ended;
  clearTimeout(timer);
  return signal === 'SIGKILL';
}

/**
 * Kills runs at some parts of the time that a whole one takes, lets each go on, and compares all files with those of an undisturbed run.
 * One folder more is killed at all of these times, one after the other.
 * @returns [{ at, killed, written, different }]: times killed, files that were complete then, and names of those that differ in the end
 */
export async function measureResumes(program, tileset, work, jobs, parts) {
  const [whole, folder] = ['whole', 'killed'].map((name) => path.join(work, name));
  const args = (to) => ['tiles', '--quiet', '-j', `${jobs}`, tileset, to];
  rmSync(whole, { recursive: true, force: true });
  const ms = 1000 * secondsOf(() => runQuietly(program, args(whole)));
  const expected = digestsOf(whole);
  const results = [];
  for (const times of [...parts.map((part) => [part]), parts]) {
    rmSync(folder, { recursive: true, force: true });
    mkdirSync(folder, { recursive: true });
    let killed = 0;
    for (const part of times) killed += await killAfter(program, args(folder), part * ms);
    const written = Object.keys(digestsOf(folder)).filter((name) => name in expected).length;
    runQuietly(program, args(folder));
    results.push({ at: times, killed, written, files: Object.keys(expected).length, different: differencesOf(expected, digestsOf(folder)) });
  }
  for (const place of [whole, folder]) rmSync(place, { recursive: true });
  return results;
}
