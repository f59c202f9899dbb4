// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
import { after, before } from 'node:test';
import { launchBrowser } from './browser.mjs';
import { makeModels } from './models.mjs';
import { startServer } from './server.mjs';

/** For the tests of a file: { models, server, browser }, which are there once the first test runs and end after the last. */
export function useSite() {
  const site = {};
  before(async () => {
    site.models = await makeModels();
    [site.server, site.browser] = await Promise.all([startServer(site.models), launchBrowser()]);
  });
  after(async () => {
    await site.browser?.close();
    await site.server?.close();
  });
  return site;
}
