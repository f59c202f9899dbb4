// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Tables of tools/bench-web, in Markdown. A result is a file's figures:
// { set, name, triangles, bytes: { [codec] and with +brotli }, native, brotli, engines: { [name]: { warm, first, second } },
//   whole: { [tool]: bytes } }; times are { [codec]: milliseconds }. What was not measured is absent.
import { CODECS } from './decoders.mjs';

const OTHERS = CODECS.filter((codec) => codec !== 'mcc');
const PHASES = { warm: 'warm', second: 'second decode', first: 'loading and first decode' };

const ms = (time) => time.toFixed(time < 100 ? 2 : 1);
const count = (number) => number.toLocaleString('en-US');
const geometricMean = (numbers) => Math.exp(numbers.reduce((sum, number) => sum + Math.log(number), 0) / numbers.length);

/** The files of each set, in the order of the sets. */
function setsOf(results) {
  const sets = new Map();
  for (const result of results) sets.set(result.set, [...(sets.get(result.set) ?? []), result]);
  return sets;
}

/** @param {string[]} left headings of columns of words; the others are of numbers */
function table(left, right, rows) {
  const line = (cells) => `| ${cells.join(' | ')} |`;
  return [line([...left, ...right]), `|${'---|'.repeat(left.length)}${'---:|'.repeat(right.length)}`, ...rows.map(line)].join('\n');
}

/**
 * Rows of files and, after those of each set, of the geometric mean of the ratios.
 * @param cellsOf (result) => cells before the ratios
 * @param ratiosOf (result) => the numbers that have a mean
 */
function fileRows(results, cellsOf, ratiosOf) {
  return [...setsOf(results)].flatMap(([set, files]) => {
    const ratios = files.map(ratiosOf);
    const means = ratios[0].map((_, i) => geometricMean(ratios.map((row) => row[i])));
    const cells = files.map(cellsOf);
    return [
      ...files.map(({ name }, i) => [name, ...cells[i], ...ratios[i].map((number) => number.toFixed(2))]),
      [`**mean, ${set}**`, ...cells[0].map(() => ''), ...means.map((number) => `**${number.toFixed(2)}**`)],
    ];
  });
}

const overOurs = (names) => names.map((name) => `${name}/mcc`);

/** Payloads that are compared, and how many times the bytes of ours they take; meshopt's are made for a second codec. */
const PAYLOADS = ['draco 0', 'draco 3', 'draco 5', 'meshopt+brotli'];
const payloadRatio = ({ bytes }, name) => bytes[name] / (name.endsWith('+brotli') ? bytes['mcc+brotli'] : bytes.mcc);

function bytesTable(results) {
  const names = ['mcc', 'mcc+brotli', ...OTHERS, 'meshopt+brotli'];
  const ratios = PAYLOADS.map((name) => (name.endsWith('+brotli') ? `${name}/mcc+brotli` : `${name}/mcc`));
  return table(['payloads, bytes'], ['triangles', ...names, ...ratios], fileRows(
    results,
    ({ triangles, bytes }) => [triangles, ...names.map((name) => bytes[name])].map(count),
    (result) => PAYLOADS.map((name) => payloadRatio(result, name)),
  ));
}

function wholeTable(results) {
  const names = Object.keys(results[0].whole).filter((name) => name !== 'mcc');
  return table(['whole files after brotli, bytes'], ['mcc', ...names, ...overOurs(names)], fileRows(
    results,
    ({ whole }) => [count(whole.mcc), ...names.map((name) => count(whole[name]))],
    ({ whole }) => names.map((name) => whole[name] / whole.mcc),
  ));
}

/** Warm times have two further columns where they were measured: our native decoder, and the time for meshopt's brotli. */
function timesTable(results, engine, phase) {
  const isWhole = phase === 'warm' && results.every(({ native }) => native !== undefined);
  const extra = isWhole ? ['native'] : [];
  const timesOf = (result) => ({ ...result.engines[engine][phase], native: result.native });
  const names = [...OTHERS, ...extra];
  return table([`${engine}, ${PHASES[phase]}, ms`], ['mcc', ...names, ...(isWhole ? ['brotli'] : []), ...overOurs(names)], fileRows(
    results,
    (result) => [...['mcc', ...names].map((name) => ms(timesOf(result)[name])), ...(isWhole ? [ms(result.brotli)] : [])],
    (result) => names.map((name) => timesOf(result)[name] / timesOf(result).mcc),
  ));
}

/** The file and the codec that are furthest ahead of us: "bench_cad .63". */
function worstOf(files, names, ratioOf) {
  const found = files.flatMap((file) => names.map((name) => ({ file, name, value: ratioOf(file, name) })));
  const { file, name, value } = found.reduce((worst, next) => (next.value < worst.value ? next : worst));
  return `${file.name} ${value.toFixed(2)}${names.length > 1 ? ` (${name})` : ''}`;
}

/** Means over each set, and where we are worst. */
export function summary(results) {
  const parts = [];
  const engines = Object.keys(results[0].engines);
  const hasNative = results.every(({ native }) => native !== undefined);
  const means = (files, names, ratioOf) => names.map((name) => geometricMean(files.map((file) => ratioOf(file, name))).toFixed(2));
  if (engines.length !== 0) {
    const rows = engines.flatMap((engine) => Object.entries(PHASES).flatMap(([phase, words]) => [...setsOf(results)].map(([set, files]) => {
      const ratioOf = (file, name) => (name === 'native' ? file.native : file.engines[engine][phase][name]) / file.engines[engine][phase].mcc;
      const isWhole = hasNative && phase === 'warm';
      const native = isWhole ? means(files, ['native'], ratioOf)[0] : '';
      return [`${engine}, ${words}`, set, ...means(files, OTHERS, ratioOf), native, worstOf(files, ['draco 0'], ratioOf)];
    })));
    parts.push(table(['times / ours', 'models'], [...OTHERS, 'native', 'worst of draco 0'], rows));
  }
  if (results[0].whole !== undefined) {
    const tools = Object.keys(results[0].whole).filter((name) => name !== 'mcc');
    const rows = [...setsOf(results)].flatMap(([set, files]) => {
      const ofWhole = ({ whole }, name) => whole[name] / whole.mcc;
      return [
        ['payloads', set, ...means(files, PAYLOADS, payloadRatio), ...tools.map(() => ''), worstOf(files, PAYLOADS, payloadRatio)],
        ['whole files, brotli', set, ...PAYLOADS.map(() => ''), ...means(files, tools, ofWhole), worstOf(files, tools, ofWhole)],
      ];
    });
    parts.push(table(['bytes / ours', 'models'], [...PAYLOADS, ...tools, 'worst'], rows));
  }
  return parts.join('\n\n');
}

/** All tables but the summary. */
export function tables(results) {
  const parts = [bytesTable(results)];
  if (results[0].whole !== undefined) parts.push(wholeTable(results));
  for (const engine of Object.keys(results[0].engines)) {
    for (const phase of Object.keys(PHASES)) parts.push(timesTable(results, engine, phase));
  }
  return parts.join('\n\n');
}
