// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// node draw.mjs: writes the figures of the specification next to itself.
import fs from 'node:fs';

const GREY = '#90a4ae';
const DARK = '#37474f';
const BLUE = '#1e88e5';
const RED = '#e53935';
const ORANGE = '#fb8c00';
const DONE = '#e3f2fd';
const NEW = '#bbdefb';

const number = (x) => Number(x.toFixed(1));
const line = (a, b, colour = GREY, width = 2, more = '') =>
  `<path d="M${number(a[0])} ${number(a[1])}L${number(b[0])} ${number(b[1])}" stroke="${colour}"${width === 1 ? '' : ` stroke-width="${width}"`}${more}/>`;
const arrow = (a, b, colour = DARK) => line(a, b, colour, 2, ` marker-end="url(#${colour === BLUE ? 'b' : 'a'})"`);
const dashed = (a, b, colour = GREY) => line(a, b, colour, 1.5, ' stroke-dasharray="5 4"');
const dot = (p, colour = DARK, radius = 5) =>
  `<circle cx="${number(p[0])}" cy="${number(p[1])}" r="${radius}" fill="${colour}"/>`;
const area = (points, fill = DONE) =>
  `<polygon points="${points.map((p) => `${number(p[0])},${number(p[1])}`).join(' ')}" fill="${fill}"/>`;
const box = (x, y, width, height, fill) =>
  `<rect x="${x}" y="${y}" width="${width}" height="${height}" fill="${fill}" stroke="${DARK}"/>`;
const TEXT = { fill: '#263238', 'font-size': 12, 'text-anchor': 'middle' }; // unless an element has others
const attributes = (named) => Object.entries(named).map(([name, value]) => ` ${name}="${value}"`).join('');
const text = (p, string, size = 13, anchor = TEXT['text-anchor'], colour = TEXT.fill, weight) => {
  const own = Object.entries({ fill: colour, 'font-size': size, 'font-weight': weight, 'text-anchor': anchor }).filter(([name, value]) => value !== TEXT[name]);
  return `<text x="${number(p[0])}" y="${number(p[1])}"${attributes(Object.fromEntries(own))}>${string}</text>`;
};

/// Points of a regular polygon, counterclockwise from `degrees`.
function ring(centre, radius, count, degrees = -90) {
  return Array.from({ length: count }, (_, i) => {
    const angle = ((degrees - (360 * i) / count) * Math.PI) / 180;
    return [centre[0] + radius * Math.cos(angle), centre[1] + radius * Math.sin(angle)];
  });
}
const middle = (a, b, t = 0.5) => [a[0] + (b[0] - a[0]) * t, a[1] + (b[1] - a[1]) * t];
const closed = (points, colour = GREY, width = 2) =>
  points.map((p, i) => line(p, points[(i + 1) % points.length], colour, width));

/// Lines of one style that follow each other become one path, unless each has its own arrowhead.
function joined(parts) {
  const all = [];
  for (const part of parts.flat()) {
    const [, line, style] = /^<path d="([^"]*)"(.*)$/.exec(part) ?? [];
    const last = all.at(-1);
    if (line !== undefined && last?.style === style && !style.includes('marker')) last.text = last.text.replace('" ', `${line}" `);
    else all.push({ text: part, style });
  }
  return all.map(({ text }) => text);
}

function write(name, top, width, bottom, label, parts) {
  const marker = (id, colour) =>
    `<marker id="${id}" viewBox="0 0 10 10" refX="8" refY="5" markerWidth="7" markerHeight="7" orient="auto"><path d="M0 0L10 5L0 10z" fill="${colour}"/></marker>`;
  const svg = [
    `<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 ${top} ${width} ${bottom - top}" font-family="Helvetica, Arial, sans-serif"${attributes(TEXT)} role="img" aria-label="${label}">`,
    `<defs>${marker('a', DARK)}${marker('b', BLUE)}</defs>`,
    `<rect y="${top}" width="${width}" height="${bottom - top}" fill="#fff"/>`,
    ...joined(parts),
    '</svg>',
  ].join('\n');
  fs.writeFileSync(new URL(name, import.meta.url), `${svg}\n`);
}

function container() {
  const parts = [];
  let x = 20;
  const field = (name, below, width, fill) => {
    parts.push(box(x, 40, width, 46, fill), text([x + width / 2, 68], name));
    below.forEach((row, i) => parts.push(text([x + width / 2, 106 + 17 * i], row, 12, 'middle', '#546e7a')));
    x += width;
  };
  field('magic', ['1'], 60, '#eceff1');
  field('version', ['1'], 60, '#eceff1');
  field('CRC-32', ['4'], 60, '#ffe0b2');
  field('flags', ['1'], 50, '#eceff1');
  field('pieces', ['counts, parts,', 'attributes'], 150, '#eceff1');
  field('lengths', ['of streams,', 'padding'], 80, '#eceff1');
  field('codes', ['range coder: connectivity,', 'stitching, seams, flags'], 180, NEW);
  field('tokens', ['rANS: residuals of positions', 'and attributes'], 190, '#c8e6c9');
  field('raw', ['plain bits'], 90, '#f8bbd0');
  parts.push(text([20, 26], 'one buffer view', 13, 'start'));
  parts.push(text([20, 158], 'Bytes. The checksum covers everything but itself, with blocks only the header. A small payload has one stream, codes; a block has its own three.', 12, 'start', '#546e7a'));
  write('container.svg', 0, 960, 172, 'Fields of a payload: magic, version, checksum, flags, pieces, lengths, and three streams', parts);
}

function halfEdges() {
  const a = [110, 190], b = [290, 190], c = [200, 50], d = [390, 60];
  const inside = (p, q, r) => {
    const centre = [(p[0] + q[0] + r[0]) / 3, (p[1] + q[1] + r[1]) / 3];
    return arrow(middle(middle(p, q, 0.14), centre, 0.2), middle(middle(p, q, 0.86), centre, 0.2), BLUE);
  };
  const parts = [area([a, b, c]), area([b, d, c])];
  for (const [p, q] of [[a, b], [b, c], [c, a], [b, d], [d, c]]) parts.push(line(p, q));
  for (const [p, q, r] of [[a, b, c], [b, c, a], [c, a, b], [c, b, d], [b, d, c], [d, c, b]]) parts.push(inside(p, q, r));
  for (const p of [a, b, c, d]) parts.push(dot(p));
  parts.push(text([200, 150], 'face f'), text([295, 106], 'face g'));
  parts.push(text([88, 206], 'corner 0', 12), text([312, 206], 'corner 1', 12), text([200, 38], 'corner 2', 12));
  const rows = [
    ['3f', 'runs from corner 0 to corner 1 of face f'],
    ['3f + 1', 'from corner 1 to corner 2'],
    ['3f + 2', 'from corner 2 to corner 0'],
    ['twin(3f + 1)', 'the half-edge of face g along the same edge'],
    ['ccw(h)', 'twin(prev(h)): leaves the same vertex as h'],
    ['cw(h)', 'next(twin(h)): likewise, clockwise'],
  ];
  rows.forEach(([left, right], i) => {
    parts.push(text([450, 62 + 26 * i], left, 13, 'start', '#1565c0', 'bold'), text([560, 62 + 26 * i], right, 13, 'start'));
  });
  write('half_edges.svg', 20, 900, 225, 'Corners and half-edges of a face, and its neighbour', parts);
}

/// A digon as the decoder sees it: decoded faces outside, gates as a ring, the mc-vertex unknown in the middle.
function digon(centre, names) {
  const inner = ring(centre, 62, names.length);
  const outer = ring(centre, 108, names.length);
  const parts = [];
  inner.forEach((p, i) => {
    const j = (i + 1) % inner.length;
    parts.push(area([p, inner[j], outer[j], outer[i]]), line(outer[i], p, '#cfd8dc', 1.5), line(outer[i], inner[j], '#cfd8dc', 1.5));
  });
  return { inner, outer, parts };
}

function expand() {
  const parts = [];
  const names = ['a1', 'a2', 'a3', 'a4', 'a5', 'a0 = top'];
  const left = [150, 170], right = [460, 170];
  const before = digon(left, names);
  parts.push(before.parts, closed(before.inner, BLUE, 2.5));
  before.inner.forEach((p, i) => parts.push(dashed(p, left), dot(p, i === 5 ? RED : DARK)));
  parts.push(dot(left, '#b0bec5', 7), text([150, 194], 'mc-vertex', 12, 'middle', '#78909c'));
  const after = digon(right, names);
  const v = middle(after.inner[1], right, 0.62);
  const fan = [after.inner[5], after.inner[0], after.inner[1], after.inner[2]];
  parts.push(after.parts);
  for (let i = 0; i < 3; ++i) parts.push(area([v, fan[i], fan[i + 1]], NEW));
  parts.push(closed(after.inner, GREY, 2));
  for (const p of fan) parts.push(line(v, p, BLUE, 2.5));
  for (const i of [2, 3, 4]) parts.push(line(after.inner[i], after.inner[i + 1], BLUE, 2.5));
  after.inner.forEach((p, i) => parts.push(dot(p, i < 2 ? '#b0bec5' : DARK)));
  parts.push(dot(v, RED, 6), text([v[0] + 14, v[1] + 18], 'v', 13, 'middle', '#c62828', 'bold'));
  before.inner.forEach((p, i) => parts.push(text([p[0] + (p[0] - left[0]) * 0.3, p[1] + (p[1] - left[1]) * 0.3 + 4], names[i].split(' ')[0], 12, 'middle', i === 5 ? '#c62828' : '#263238', 'bold')));
  parts.push(arrow([276, 170], [334, 170]), text([305, 158], 'EXPAND', 12), text([305, 190], 'r = 3', 12));
  parts.push(text([150, 318], 'ring of nodes around the mc-vertex; blue: gates', 12));
  parts.push(text([460, 318], 'three gates taken; a1, a2 close; v is the top', 12));

  const spur = ring([735, 170], 62, 5);
  const tip = middle(spur[0], [735, 170], 0.72);
  parts.push(area(ring([735, 170], 100, 5)), `<polygon points="${spur.map((p) => p.map(number).join(',')).join(' ')}" fill="#fff"/>`);
  parts.push(closed(spur, BLUE, 2.5), line(spur[0], tip, RED, 4));
  spur.forEach((p) => parts.push(dot(p)));
  parts.push(dot(tip, RED, 6), text([735, 318], 'spur, r = 0: the top gets', 12), text([735, 335], 'a second node', 12), text([tip[0] + 12, tip[1] + 16], 'v', 13, 'middle', '#c62828', 'bold'));

  const p = [905, 130], q = [905, 210];
  parts.push(line(p, q, RED, 4), dot(p, RED, 6), dot(q), text([921, 134], 'v1 = top', 12, 'start'), text([921, 214], 'v2', 12, 'start'));
  parts.push(text([920, 318], 'END: two gates,', 12), text([920, 335], 'glued together', 12));
  write('expand.svg', 50, 980, 345, 'EXPAND takes gates of the ring, a spur takes none, END begins a digon of two vertices', parts);
}

function joins() {
  const parts = [];
  // A hole and its dummy.
  const hole = ring([130, 150], 58, 7);
  const far = ring([130, 150], 105, 7, -64);
  parts.push(area(far));
  hole.forEach((p, i) => parts.push(line(p, far[i], '#cfd8dc', 1.5), line(p, far[(i + 6) % 7], '#cfd8dc', 1.5)));
  parts.push(area(hole, '#fff'), closed(hole, DARK, 2.5));
  hole.forEach((p) => parts.push(dashed(p, [130, 150], ORANGE), dot(p)));
  parts.push(dot([130, 150], ORANGE, 7), text([130, 286], 'hole: a dummy closes it,', 12), text([130, 303], 'its triangles are not emitted', 12));

  // START.
  const one = ring([360, 150], 50, 6, 0), two = ring([490, 150], 50, 6, 180);
  parts.push(closed(one, BLUE, 2.5), closed(two, GREY, 2.5));
  one.forEach((p, i) => parts.push(dot(p, i === 0 ? RED : DARK, i === 0 ? 6 : 5)));
  two.forEach((p, i) => parts.push(dot(p, i === 0 ? RED : DARK, i === 0 ? 6 : 5)));
  parts.push(`<path d="M ${one[0][0] + 8} 150 L ${two[0][0] - 8} 150" stroke="${RED}" stroke-width="1.5" stroke-dasharray="3 3" fill="none"/>`);
  parts.push(text([360, 154], 'at work', 12), text([490, 154], 'waits', 12, 'middle', '#78909c'));
  parts.push(text([425, 226], 'the same vertex', 12, 'middle', '#c62828'), arrow([425, 212], [425, 162]));
  parts.push(text([425, 286], 'START: the links of the two tops are exchanged,', 12), text([425, 303], 'two rings become one', 12));

  // HANDLE.
  const big = ring([740, 150], 82, 12, 90);
  parts.push(closed(big, BLUE, 2.5));
  big.forEach((p, i) => parts.push(dot(p, i === 0 || i === 6 ? RED : DARK, i === 0 || i === 6 ? 6 : 5)));
  parts.push(dashed(big[0], big[6], RED), text([740, 256], 'top', 12, 'middle', '#c62828'), text([740, 58], 'named node', 12, 'middle', '#c62828'));
  parts.push(text([700, 154], 'waits', 12, 'middle', '#78909c'), text([784, 154], 'at work', 12));
  parts.push(text([740, 286], 'HANDLE: likewise with a node of the same ring,', 12), text([740, 303], 'which splits it', 12));
  write('joins.svg', 40, 900, 320, 'A hole with its dummy, START joins two rings, HANDLE splits one', parts);
}

/// A.6: the known region, a vertex with the three scores, and a plain fan with what lies beyond.
function fan() {
  const parts = [];
  const at = (x, y) => [x, y];
  // Growth: rows of a triangle strip, the upper ones known.
  const rows = [60, 125, 190, 255];
  const grid = rows.map((y, r) => Array.from({ length: 6 }, (_, i) => at(40 + 66 * i + (r % 2) * 33, y)));
  const known = (r, i) => r < 2 || (r === 2 && i < 2);
  for (let r = 0; r < 3; ++r) {
    for (let i = 0; i < 6; ++i) {
      const below = r % 2 === 0 ? [i - 1, i] : [i, i + 1];
      for (const [a, b, c] of [[[r, i], [r + 1, below[0]], [r + 1, below[1]]], [[r, i], [r + 1, r % 2 === 0 ? i : i + 1], [r, i + 1]]]) {
        const corners = [a, b, c];
        if (corners.some(([y, x]) => grid[y] === undefined || grid[y][x] === undefined)) continue;
        const points = corners.map(([y, x]) => grid[y][x]);
        parts.push(area(points, corners.every(([y, x]) => known(y, x)) ? DONE : '#fff'), closed(points, GREY, 1.5));
      }
    }
  }
  grid.forEach((row, r) => row.forEach((p, i) => parts.push(dot(p, known(r, i) ? DARK : '#cfd8dc'))));
  const scores = [[2, 2, '2', RED], [2, 3, '1', ORANGE], [2, 4, '1', ORANGE], [2, 5, '1', ORANGE], [3, 0, '1', ORANGE]];
  for (const [r, i, score, colour] of scores) {
    parts.push(dot(grid[r][i], colour, 9), text([grid[r][i][0], grid[r][i][1] + 4], score, 12, 'middle', '#fff', 'bold'));
  }
  parts.push(text([205, 292], 'Known vertices are dark. A score is the number of', 12), text([205, 309], 'faces with two known corners, 3 at most; the highest', 12));
  parts.push(text([205, 326], 'one comes next.', 12));

  // The plain fan.
  const n0 = at(560, 200), n1 = at(640, 160), n2 = at(720, 200), v = at(640, 262), o0 = at(570, 120), o1 = at(710, 120);
  const ya = at(490, 150), yb = at(790, 150), xa = at(600, 62), xb = at(680, 62);
  parts.push(area([n0, n1, o0]), area([n1, n2, o1]), area([n0, n1, v], NEW), area([n1, n2, v], NEW));
  for (const [p, q] of [[n0, n1], [n1, n2], [n0, o0], [o0, n1], [n1, o1], [o1, n2], [n0, v], [n1, v], [n2, v]]) parts.push(line(p, q));
  for (const [p, q] of [[ya, n0], [ya, o0], [yb, n2], [yb, o1], [xa, o0], [xa, n1], [xb, o1], [xb, n1]]) parts.push(dashed(p, q));
  const t0 = at(n0[0] + n1[0] - o0[0], n0[1] + n1[1] - o0[1]), t1 = at(n1[0] + n2[0] - o1[0], n1[1] + n2[1] - o1[1]);
  parts.push(dashed(n0, t0, BLUE), dashed(n1, t0, BLUE), dashed(n1, t1, BLUE), dashed(n2, t1, BLUE));
  const labels = [[n0, 'n0', -18, 4], [n1, 'n1', 0, -12], [n2, 'n2', 18, 4], [o0, 'o0', -16, -4], [o1, 'o1', 16, -4], [ya, 'ya', -16, 4], [yb, 'yb', 16, 4], [xa, 'xa', 0, -10], [xb, 'xb', 0, -10]];
  for (const [p, name, dx, dy] of labels) parts.push(dot(p, 'xy'.includes(name[0]) ? '#90a4ae' : DARK), text([p[0] + dx, p[1] + dy], name));
  parts.push(dot(t0, BLUE, 4), text([t0[0] - 14, t0[1] + 12], 't0', 12, 'middle', '#1565c0'), dot(t1, BLUE, 4), text([t1[0] + 14, t1[1] + 12], 't1', 12, 'middle', '#1565c0'));
  parts.push(dot(v, RED, 6), text([v[0], v[1] + 20], 'v', 14, 'middle', '#c62828', 'bold'));
  parts.push(text([640, 309], 'A plain fan: two faces of v, the parallelograms over them, their tips t0 and t1,', 12), text([640, 326], 'and what the weights look at beyond', 12));
  write('fan.svg', 40, 900, 340, 'The region of known vertices with scores, and a plain fan with its tips', parts);
}

/// A.10.11 and A.6.12: unfolding a chart, and a cell of planes.
function hingeAndPlanes() {
  const parts = [];
  const n = [60, 160], p = [210, 160], o = [120, 70], v = [150, 262];
  parts.push(area([n, p, o]), area([n, p, v], NEW), closed([n, p, o]), closed([n, p, v]));
  const foot = [150, 160], footO = [120, 160];
  parts.push(dashed(v, foot, RED), dashed(o, footO, BLUE));
  for (const [q, name, dx, dy] of [[n, 'n', -14, 4], [p, 'p', 14, 4], [o, 'o', 0, -12], [v, 'v', 0, 20]]) parts.push(dot(q, name === 'v' ? RED : DARK), text([q[0] + dx, q[1] + dy], name));
  parts.push(text([176, 214], 'height', 11, 'middle', '#c62828'), text([96, 120], 'height o', 11, 'middle', '#1565c0'), text([135, 304], 'in space', 12));
  parts.push(arrow([240, 160], [290, 160]));
  const un = [330, 185], up = [470, 150], uo = [360, 85], uv = [447, 270];
  parts.push(area([un, up, uo]), closed([un, up, uo]), dashed(un, uv, RED), dashed(up, uv, RED));
  const along = middle(un, up, 0.6), alongO = middle(un, up, 0.4);
  parts.push(dashed(uo, alongO, BLUE), dashed(along, uv, RED));
  for (const [q, name, dx, dy] of [[un, 'n', -14, 4], [up, 'p', 14, 4], [uo, 'o', 0, -12], [uv, 'v', 14, 14]]) parts.push(dot(q, name === 'v' ? RED : DARK), text([q[0] + dx, q[1] + dy], name));
  parts.push(text([400, 304], 'in the chart: the map of n, p, o goes on beyond n-p', 12));

  const x = [600, 690, 780, 870], y = [70, 160, 250];
  for (const a of x) parts.push(line([a, 50], [a, 270], '#cfd8dc', 1.5));
  for (const b of y) parts.push(line([580, b], [890, b], '#cfd8dc', 1.5));
  parts.push(dashed([690, 250], [780, 160], ORANGE));
  const marks = [[[690, 112], BLUE, 'on a plane of x, between those of y', -36], [[735, 205], ORANGE, 'on a diagonal', 0], [[815, 92], RED, 'between planes on both axes', 0], [[600, 160], DARK, 'on planes of both', 0]];
  marks.forEach(([q, colour, string], i) => {
    parts.push(dot(q, colour, 6), dot([604, 300 + 18 * i], colour, 5), text([618, 304 + 18 * i], string, 12, 'start'));
  });
  write('hinge_and_planes.svg', 40, 900, 370, 'A chart unfolded over an edge, and vertices on and between the planes of a grid', parts);
}

/// A.7: ends of seams cut the corners around a group into runs, and wedges are made of runs.
function wedges() {
  const parts = [];
  const fills = { w1: '#bbdefb', w2: '#c8e6c9', w3: '#ffe0b2' };
  const umbrella = (centre, count, isOpen, runs, seams, start) => {
    const rim = ring(centre, 92, count + (isOpen ? 1 : 0) + (isOpen ? 1 : 0), start);
    for (let i = 0; i < count; ++i) {
      const p = rim[i], q = rim[(i + 1) % rim.length];
      const mean = middle(middle(p, q), centre, 0.42);
      parts.push(area([centre, p, q], fills[runs[i]]), text([mean[0], mean[1] + 4], runs[i], 12));
    }
    for (let i = 0; i < count; ++i) parts.push(line(rim[i], rim[(i + 1) % rim.length], GREY, 1.5));
    rim.slice(0, isOpen ? count + 1 : count).forEach((p, i) => {
      const isSeam = seams.includes(i);
      parts.push(line(centre, p, isSeam ? RED : GREY, isSeam ? 4 : 1.5), dot(p, '#90a4ae', 4));
    });
    parts.push(dot(centre, DARK, 7));
  };
  umbrella([150, 160], 6, false, ['w1', 'w1', 'w2', 'w2', 'w2', 'w1'], [2, 5], -90);
  parts.push(text([150, 286], 'A closed umbrella: two seams (red) end here, so', 12), text([150, 303], 'its six corners are two runs, wedges w1 and w2.', 12));
  umbrella([520, 160], 4, true, ['w1', 'w3', 'w3', 'w3'], [1], -20);
  parts.push(text([520, 286], 'An open umbrella of the same group: one seam, two', 12), text([520, 303], 'runs. The first is w1 again, the second a new wedge.', 12));
  parts.push(dashed([158, 160], [512, 160], ORANGE), text([336, 134], 'one group: two', 12, 'middle', '#ef6c00'), text([336, 150], 'vertices, stitched', 12, 'middle', '#ef6c00'));
  const rows = [['red', 'end(h) = 1: a seam ends at this group on the edge of h'], ['run', 'corners in a row, counterclockwise, without an end between'],
    ['start', 'the first half-edge of the first run of a wedge'], ['wedge', 'one run, or several: MERGE names an earlier wedge again']];
  rows.forEach(([left, right], i) => {
    parts.push(text([650, 92 + 26 * i], left, 13, 'start', '#1565c0', 'bold'), text([706, 92 + 26 * i], right, 12, 'start'));
  });
  write('wedges.svg', 50, 1060, 320, 'A group with two umbrellas: ends of seams cut their corners into runs, and runs are wedges', parts);
}

/// A.10.6: the grid of an octahedron, the turn of a prediction, and residuals that wrap.
function frame() {
  const parts = [];
  const square = (x, y, size) => [[x, y], [x + size, y], [x + size, y + size], [x, y + size]];
  const diamond = (x, y, size) => [[x + size / 2, y], [x + size, y + size / 2], [x + size / 2, y + size], [x, y + size / 2]];
  const grid = (x, name, more) => {
    parts.push(area(square(x, 60, 200), '#eceff1'), area(diamond(x, 60, 200)), closed(square(x, 60, 200)), closed(diamond(x, 60, 200), BLUE, 1.5));
    parts.push(line([x, 160], [x + 200, 160], '#cfd8dc', 1), line([x + 100, 60], [x + 100, 260], '#cfd8dc', 1));
    name.forEach((row, i) => parts.push(text([x + 100, 284 + 17 * i], row.replaceAll('<', '&lt;').replaceAll('>', '&gt;'), 12)));
    parts.push(more);
  };
  grid(30, ['The grid: z > 0 inside of the diamond,', 'z < 0 in the corners, folded outwards.', 'A prediction q outside is turned over to p.'], [
    dot([206, 86], RED, 6), text([190, 80], 'q', 13, 'middle', '#c62828', 'bold'), dot([154, 124], RED, 6), text([140, 120], 'p', 13, 'middle', '#c62828', 'bold'), arrow([201, 92], [160, 119]),
    text([228, 154], 'x', 12), text([122, 74], 'y', 12)]);
  parts.push(arrow([246, 160], [304, 160]), text([275, 148], '(c, s)', 12));
  grid(320, ['Quarter turns bring p to p′,', 'where x ≤ 0 and y ≤ 0, so that', 'residuals are alike in all quadrants.'], [
    dot([444, 124], '#ef9a9a', 5), dot([384, 136], '#ef9a9a', 5), dot([396, 196], RED, 6), text([382, 214], 'p′', 13, 'middle', '#c62828', 'bold'),
    `<path d="M 444 124 A 43.3 43.3 0 0 0 384 136 A 43.3 43.3 0 0 0 394 189" stroke="${DARK}" stroke-width="1.5" stroke-dasharray="4 3" fill="none"/>`]);
  parts.push(arrow([536, 160], [594, 160]), text([565, 148], 'residual', 12));
  grid(610, ['p′ + (r0, r1), each at most C in size, may', 'leave the grid on one side; it comes', 'in again on the other (wrap).'], [
    dot([686, 196], RED, 6), text([672, 214], 'p′', 13, 'middle', '#c62828', 'bold'), arrow([686, 196], [590, 180], BLUE), dot([790, 180], BLUE, 6), dashed([590, 180], [790, 180], BLUE)]);
  write('frame.svg', 40, 860, 330, 'The frame of a prediction: the predicted point is turned into one quadrant of the diamond, and residuals wrap around the grid', parts);
}

/// A.11: blocks, their rim wedges, and the numbers of the glued piece.
function blocks() {
  const parts = [];
  const cells = (x, y, columns, fill) => {
    for (let i = 0; i < columns; ++i) {
      for (let j = 0; j < 3; ++j) {
        const [a, b, c, d] = [[x + 36 * i, y + 36 * j], [x + 36 * (i + 1), y + 36 * j], [x + 36 * (i + 1), y + 36 * (j + 1)], [x + 36 * i, y + 36 * (j + 1)]];
        parts.push(area([a, b, c, d], fill), closed([a, b, c, d], GREY, 1), line(a, c, GREY, 1));
      }
    }
  };
  const names = (x, y, first, colour) => first.forEach((name, j) => parts.push(dot([x, y + 36 * j], colour, 6), text([x + (colour === RED ? 18 : -18), y + 36 * j + 4], name, 11, 'middle', colour === RED ? '#c62828' : '#1565c0')));
  parts.push(text([104, 60], 'block 0', 13, 'middle', '#263238', 'bold'), text([300, 60], 'block 1', 13, 'middle', '#263238', 'bold'));
  cells(32, 80, 4, DONE);
  cells(236, 80, 4, '#e8f5e9');
  names(176, 80, ['4', '9', '14', '19'], BLUE);
  names(236, 80, ['0', '5', '10', '15'], RED);
  parts.push(text([206, 218], 'copies of four wedges', 12), text([206, 235], 'along the cut', 12));
  parts.push(arrow([400, 134], [452, 134]), text([426, 122], 'glue', 12));
  cells(476, 80, 4, DONE);
  cells(620, 80, 4, '#e8f5e9');
  for (let j = 0; j < 4; ++j) parts.push(dot([620, 80 + 36 * j], BLUE, 6));
  parts.push(text([620, 60], 'the glued piece', 13, 'middle', '#263238', 'bold'), text([620, 218], 'tuples of rim wedges are equal: numbers 4, 9, 14, 19', 12), text([620, 235], 'again; the other wedges of block 1 follow from 20 on', 12));
  const rows = [['header', 'counts, attributes of block 0, table of blocks (lengths, boxes)'], ['block 0', 'codes, tokens, raw; leaves its models to all others'], ['block 1 …', 'codes, tokens, raw; in any order, at the same time']];
  rows.forEach(([name, what], i) => parts.push(box(32, 258 + 30 * i, 110, 26, i === 0 ? '#eceff1' : i === 1 ? DONE : '#e8f5e9'), text([87, 276 + 30 * i], name, 12), text([156, 276 + 30 * i], what, 12, 'start')));
  write('blocks.svg', 40, 800, 356, 'A mesh cut into blocks; the tuples of rim wedges glue them together', parts);
}

container();
halfEdges();
expand();
joins();
fan();
hingeAndPlanes();
wedges();
frame();
blocks();
