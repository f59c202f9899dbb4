// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Our extension, EXT_meshopt_compression and KHR_texture_basisu in one file, in three.js.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { composedModel } from '../support/composed.mjs';
import { openPage } from './support/browser.mjs';
import { coverageOf, differenceOf, readPicture } from './support/pixels.mjs';
import { useSite } from './support/site.mjs';

const site = useSite();

/** How much more red than blue there is where the background is not. */
function redness({ data }) {
  let [red, blue] = [0, 0];
  for (let i = 0; i < data.length; i += 4) {
    if (data[i + 1] === 255) continue;
    red += data[i];
    blue += data[i + 2];
  }
  return red / blue;
}

test('three.js shows meshes of ours, animations and instances of meshopt, and textures of KTX2', async () => {
  const { plain, composed } = await composedModel();
  site.models.set('composed', plain).set('composed.mcc', composed);
  const { page, violations } = await openPage(site.browser, `${site.server.origin}/pages/composed.html?eval&blobs`,
    () => globalThis.draw !== undefined);
  const draw = (...args) => page.evaluate((all) => globalThis.draw(...all), args);
  const { picture: dataUrl, ...expected } = await draw('composed', false);
  const reference = readPicture(dataUrl);
  assert.ok(coverageOf(reference) > 0.2);
  assert.ok(redness(reference) > 1.5, 'the texture is shown');
  assert.deepEqual(expected, { instanceCounts: [100], keyCounts: [200] });
  for (const isFirst of [false, true]) {
    const { picture, ...found } = await draw('composed.mcc', isFirst);
    assert.deepEqual(found, expected);
    assert.ok(differenceOf(readPicture(picture), reference) < 0.001);
  }
  assert.deepEqual(violations(), []);
  await page.close();
});
