// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// All JavaScript on our pages compiles in a strict TypeScript project, with the types of this package and of the engines.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { readFileSync } from 'node:fs';
import path from 'node:path';
import test from 'node:test';
import typescript from 'typescript';
import { LIBRARY, ROOT } from './support/paths.mjs';

/** Where the snippets seem to be, so that they find the engines. */
const FOLDER = path.join(ROOT, 'tests/web/types/snippets');

/** What a page expects its reader to have. */
const GIVEN = {
  bytes: 'Uint8Array<ArrayBuffer>', glb: 'Uint8Array<ArrayBuffer>', stream: 'ReadableStream<Uint8Array>', payloadBytes: 'number',
  draw: '(...args: unknown[]) => void', loader: "import('three/addons/loaders/GLTFLoader.js').GLTFLoader", scene: "import('three').Scene",
  renderer: "import('three').WebGLRenderer", app: "import('playcanvas').AppBase",
};
/** By heading, where it is something else. */
const OTHERWISE = {
  'Babylon.js': { scene: "import('@babylonjs/core/scene.js').Scene" },
  'Integers in Babylon.js': { scene: "import('@babylonjs/core/scene.js').Scene" },
  'CesiumJS': { scene: "import('cesium').Scene" },
};
/** What the text around a snippet imports. */
const IMPORTS = {
  'gltf-mcc': ['decodePayload', 'unpackGlb'],
  'gltf-mcc/three': ['registerMeshCollapse'],
  'three': ['Group', 'Mesh', 'MeshStandardMaterial'],
};
/** What TypeScript asks of any program that uses these engines: their types say less than they do. */
const ASSERTED = {
  'PlayCanvas': [['asset.resource.', "(asset.resource as import('playcanvas').ContainerResource)."]],
  'model-viewer': [["document.querySelector('model-viewer')", "document.querySelector('model-viewer')!"]],
};

function snippets() {
  const pages = execFileSync('git', ['ls-files', '*.md'], { cwd: ROOT, encoding: 'utf8' }).trim().split('\n');
  return pages.flatMap((page) => [...readFileSync(path.join(ROOT, page), 'utf8').matchAll(/^```(?:js|ts)\n(.*?)^```$/gms)].map((match) => {
    const before = match.input.slice(0, match.index);
    const heading = /.*^##+ ([^\n]*)$/ms.exec(before)?.[1] ?? '';
    return { where: `${page}:${before.split('\n').length}`, heading, code: match[1] };
  }));
}

/** The snippet as a module of a program that has what the page takes for granted. */
function moduleOf({ heading, code }) {
  for (const [from, to] of ASSERTED[heading] ?? []) {
    assert.ok(code.includes(from), `${heading}: ${from}`);
    code = code.replace(from, () => to);
  }
  const isOwn = (name) => new RegExp(`\\b(const|let|as)\\s+(${name}\\b|\\{[^}]*\\b${name}\\b)|import\\s*\\{[^}]*\\b${name}\\b`).test(code);
  const declared = Object.entries({ ...GIVEN, ...OTHERWISE[heading] }).filter(([name]) => !isOwn(name))
    .map(([name, type]) => `declare const ${name}: ${type};`);
  const imported = Object.entries(IMPORTS).map(([from, names]) => [from, names.filter((name) => !isOwn(name))])
    .map(([from, names]) => `import { ${names.join(', ')} } from '${from}';`);
  return [...imported, code, ...declared, 'export {};'].join('\n');
}

const OPTIONS = {
  noEmit: true, strict: true, skipLibCheck: true, target: typescript.ScriptTarget.ES2022, module: typescript.ModuleKind.ESNext,
  moduleResolution: typescript.ModuleResolutionKind.Bundler, lib: ['lib.esnext.d.ts', 'lib.dom.d.ts', 'lib.dom.iterable.d.ts'], types: [],
  paths: {
    'gltf-mcc': [`${LIBRARY}/index.d.mts`], 'gltf-mcc/*': [`${LIBRARY}/*.d.mts`],
    '/gltf-mcc/service_worker.mjs': [`${LIBRARY}/service_worker.d.mts`],
    '@gltf-transform/core': [path.join(ROOT, 'tests/web/node_modules/@gltf-transform/core/dist/index.d.ts')],
  },
};

function errorsOf(modules) {
  const host = typescript.createCompilerHost(OPTIONS);
  const { readFile, fileExists, getSourceFile } = host;
  host.readFile = (file) => modules.get(file) ?? readFile(file);
  host.fileExists = (file) => modules.has(file) || fileExists(file);
  host.getSourceFile = (file, ...rest) => (modules.has(file) ? typescript.createSourceFile(file, modules.get(file), ...rest) : getSourceFile(file, ...rest));
  const program = typescript.createProgram([...modules.keys()], OPTIONS, host);
  return typescript.getPreEmitDiagnostics(program).map(({ file, messageText }) => (
    [file?.fileName, typescript.flattenDiagnosticMessageText(messageText, '\n')]));
}

test('every snippet compiles', () => {
  const all = snippets();
  assert.ok(all.length >= 20, `only ${all.length} snippets`);
  const names = new Map(all.map((snippet, i) => [path.join(FOLDER, `${i}.mts`), snippet]));
  const errors = errorsOf(new Map([...names].map(([name, snippet]) => [name, moduleOf(snippet)])));
  assert.deepEqual(errors.map(([name, text]) => `${names.get(name)?.where ?? name}: ${text}`), []);
});

test('a wrong snippet is noticed', () => {
  const code = "import { unpackGlb } from 'gltf-mcc';\nnew Blob([await unpackGlb(glb as Uint8Array<SharedArrayBuffer>)]);";
  const [[, text]] = errorsOf(new Map([[path.join(FOLDER, 'wrong.mts'), moduleOf({ heading: '', code: code.replace('glb as', 'glb as unknown as') })]]));
  assert.match(text, /SharedArrayBuffer/);
});
