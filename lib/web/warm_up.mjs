// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Engines compile a function of WebAssembly when it is called first, and compile it well when it has run for a while. A small payload, which
// is decoded while the first file is on its way, has that done before the file is there.

/** A torus of 190 triangles with normals, texture coordinates, a seam and a hole. */
const TORUS = 'SxBXzCwbAFlgvgECKgEBAwAIiCga5zM8MzOzv8C/AL8ZgAYDAOcPYOoB01dtOBEeLV5ACz0Jiek5ibIWxpc0blXx0QVbpLtWRpWyvgpGhMVMMvkUKAopPN4uPB26h34ozFTnZYq9i5FEpYPE1HT5+kindTHH+pO/nXxiffAxEIOhSQ+yneYQfct0NMORWImQDAB0wDEA6xACd17K1lOE8CtcK3b7QhPbAJUVnzHVe+gVqKKnQCCOLnT+r7PFStQPX0w6hdrgj8Ei9Kp202+NgUJKpGFxtTvOPfDNtl88Wp60uI0nyD9Rfu4GGgazlGL6wxpcplE4gtRDloaAOdqcvxY7YMRIyQEWIusAxc33exXB7Z6JcgDh73qgrRf0K3lcJFAcWlX2p6BiqAyNjGOmghJn0j/POca3U/RnCRXgMxG0gu5EzSGQS0cemDXygLLlQs71GF6NIFIk1E26BYQqux9kVdFiKY4cti9+DZ0H+bDdDeRvhSkioZ4MAaNu8PJAtLggJ58GMqnFfrt37/7EnN2ufwAAACARAAAAcAEAAAAyZAOYQxwcYdcn6/kAvz9YEOgKhEvgLlBwQAlCDczjwReGIf0B6QAAfxBAAAwYGAoD8aGaBQA=';

export const warmUpPayload = () => Uint8Array.from(atob(TORUS), (character) => character.charCodeAt(0));
