// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Tables of tools/bench-tiles, in Markdown, from its figures: { machine, tilesets: { [name]: { [part]: figures of the part } } }.
import { OURS, SOURCE } from './make.mjs';

const count = (number) => number.toLocaleString('en-US');
const meters = (number) => (number === undefined ? '' : number === 0 ? '0' : Number(number.toPrecision(3)).toString());
const line = (cells) => `| ${cells.join(' | ')} |`;

/** @param {string[]} left headings of columns of words; the others are of numbers */
function table(left, right, rows) {
  return [line([...left, ...right]), `|${'---|'.repeat(left.length)}${'---:|'.repeat(right.length)}`, ...rows.map(line)].join('\n');
}

const eachTileset = (figures, part, rowsOf) => Object.entries(figures.tilesets)
  .flatMap(([name, parts]) => (parts[part] === undefined ? [] : rowsOf(name, parts[part])));

function bytesTable(figures) {
  const kinds = ['bytes', 'gzip', 'brotli'];
  const ratio = (row, ours, kind) => (row[kind] / ours[kind]).toFixed(2);
  const geometry = (row) => row.bytes - row.images;
  return table(['contents of all tiles'], ['position bits', ...kinds.map((kind) => (kind === 'bytes' ? 'bytes' : `after ${kind}`)),
    'bytes / ours', 'gzip / ours', 'brotli / ours', 'bytes without images / ours'], eachTileset(figures, 'bytes', (name, { rows }) => {
    const ours = rows[OURS];
    return Object.entries(rows).map(([row, figuresOfRow]) => [
      `${name}: ${row === OURS ? `**${row}**` : row}${unchangedText(figuresOfRow.unchanged)}`,
      bitsText(figuresOfRow.bits), ...kinds.map((kind) => count(figuresOfRow[kind])), ...kinds.map((kind) => ratio(figuresOfRow, ours, kind)),
      (geometry(figuresOfRow) / geometry(ours)).toFixed(2),
    ]);
  }));
}

const unchangedText = ({ length }) => (length === 0 ? '' : ` (${length === 1 ? '1 tile stays as it was' : `${count(length)} tiles stay as they were`})`);

function bitsText(bits) {
  if (bits.length === 0) return '';
  const [low, high] = [Math.min(...bits), Math.max(...bits)];
  return low === high ? `${low}` : `${low}-${high}`;
}

/** Largest errors of each level, and the largest parts of what was promised for a tile; rows that quantise alike are one. */
function errorsTable(figures) {
  const depth = Math.max(0, ...Object.values(figures.tilesets).map(({ bytes }) => bytes?.levels.length ?? 0));
  const levels = Array.from({ length: depth }, (_, i) => i);
  return table(['largest error, m (of what its tile was promised)'], levels.map((level) => `level ${level}`), eachTileset(figures, 'bytes', (name, { rows, levels: promised }) => [
    [`${name}: tiles`, ...levels.map((level) => (promised[level] === undefined ? '' : count(promised[level].tiles)))],
    [`${name}: least promise`, ...levels.map((level) => meters(promised[level]?.promise || undefined))],
    ...Object.entries(rows).filter(([row]) => row !== SOURCE && !/ 10,| v1,/.test(row)).map(([row, { errors, shares }]) => [
      `${name}: ${row.replace('Draco 7,', 'Draco,')}`,
      ...levels.map((level) => meters(errors[level]) + (shares[level] === undefined ? '' : ` (${Math.round(100 * shares[level])} %)`)),
    ]),
  ]));
}

function ratesTable(figures) {
  return table(['whole runs'], ['tiles', 'seconds', 'tiles per second', 'MB of the source per second'], eachTileset(figures, 'rates', (name, { tiles, bytes, seconds }) => (
    Object.entries(seconds).map(([what, time]) => [`${name}: ${what}`, count(tiles), time.toFixed(1), (tiles / time).toFixed(1), (bytes / time / 1e6).toFixed(1)]))));
}

function resumeTable(figures) {
  return table(['killed at, of the whole time'], ['jobs', 'times killed', 'files complete before the last run', 'of', 'files that differ in the end'],
    eachTileset(figures, 'resume', (name, runs) => runs.map(({ at, jobs, killed, written, files, different }) => (
      [`${name}: ${at.map((part) => `${Math.round(100 * part)} %`).join(', ')}`, jobs, killed, written, files, different.length]))));
}

function validationTable(figures) {
  return table(['validator', 'issue'], ['in the source', 'in the result'], eachTileset(figures, 'validation', (name, validators) => (
    Object.entries(validators).flatMap(([validator, { source, result, more }]) => {
      const names = [...new Set([...Object.keys(source), ...Object.keys(result)])].sort();
      const rows = names.map((issue) => [`${name}: ${validator}`, issue in more ? `**${issue}**` : issue, count(source[issue] ?? 0), count(result[issue] ?? 0)]);
      return rows.length === 0 ? [[`${name}: ${validator}`, 'none', 0, 0]] : rows;
    }))));
}

function loadTable(figures) {
  return table(['loaded by CesiumJS'], ['tiles', 'ms', 'ms / ours', 'all runs, ms'], eachTileset(figures, 'load', (name, { links }) => (
    Object.entries(links).flatMap(([link, cameras]) => Object.entries(cameras).flatMap(([camera, rows]) => (
      Object.entries(rows).filter(([, { tiles }]) => tiles !== 0).map(([row, { ms, tiles, failed, all }]) => [
        `${name}, ${link}, ${camera}: ${row === OURS ? `**${row}**` : row}${failed === 0 ? '' : ` (${failed} tiles failed)`}`,
        tiles, Math.round(ms), (ms / rows[OURS].ms).toFixed(2), all.join(' '),
      ])))))));
}

/** { [name]: Markdown } of the parts that there are figures for. */
export function tables(figures) {
  const makers = { bytes: bytesTable, errors: errorsTable, rates: ratesTable, resume: resumeTable, validation: validationTable, load: loadTable };
  const has = (part) => Object.values(figures.tilesets).some((parts) => parts[part === 'errors' ? 'bytes' : part] !== undefined);
  return Object.fromEntries(Object.entries(makers).filter(([part]) => has(part)).map(([part, make]) => [part, make(figures)]));
}
