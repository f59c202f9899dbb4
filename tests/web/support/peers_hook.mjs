// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

/** Part of peers.mjs. */
export function resolve(specifier, context, next) {
  if (/^gltf-mcc(\/|$)/.test(specifier)) {
    return next(new URL(`../../../lib/web/${specifier.slice('gltf-mcc/'.length) || 'index'}.mjs`, import.meta.url).href, context);
  }
  const isPackage = /^@?[a-z]/.test(specifier) && !specifier.includes(':');
  const isOutside = isPackage && !context.parentURL?.includes('/tests/web/');
  return next(specifier, isOutside ? { ...context, parentURL: import.meta.url } : context);
}
