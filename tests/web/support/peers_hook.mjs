// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

/** Part of peers.mjs. */
export function resolve(specifier, context, next) {
  const isPeer = /^@?[a-z]/.test(specifier) && !specifier.includes(':') && context.parentURL?.includes('/lib/web/');
  return next(specifier, isPeer ? { ...context, parentURL: import.meta.url } : context);
}
