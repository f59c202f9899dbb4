// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Engines compile a function of WebAssembly when it is called first, and compile it well when it has run for a while. A small payload, which
// is decoded a few times while the first file is on its way, has that done before the file is there.

/** A torus of 442 triangles with normals, texture coordinates, a seam and a hole, of which the core decodes everything. */
const TORUS = 'SxEjORP0EJkg4AG6AwI4AQMAgQktkbI7uEivv5ety77kN7K/GcAFAwAGfdBxPFz/rjgSEAU7LP4B9yx2GFjTawzoS8I1UBv9gDdEyUwwdxplmOh1JFPysJv/nUqOwscDQNsNSDK4DowCKrQeAVfABABb+J5vgn7TGgqtF6NDk5ymn+jY7RWZaIzh0xIzvbScC/SsXfL3Kc2C7R4XCigq7Y/I4p2Cf7rGEKncBpSArPytPIbSQ1SdYMUY5/0XzVD5XWHmzE9t8nybkaXr7Bk4Bkrb3WfPURne8MFuKAh5a59ia1ICCY6qtVl0NDpYu04LXdXLV964BGsD3Diqpcq7AtCuZQymPE6wTZIgYkA3J1oT3S77U+ex87YqJwumbyHcoY3Y1K2lwLnWy+RPRvTywlhjppcfPNmXH7DB9x6XbqeVNHngHFi/sQ785BETMNvu9/OuHBguozevHsDzn3zXmyYZXOn6JQn/Q3k/qQ2XDRPBAowwXDOHdghzWhPpUVmQqasEyJbDKZgj6FKxoEVUp4jSI0IxY12SSea7eHhLMA7jxbxJyMBEo6oEaTJYu4Uq8vRl/xCJUyIpk7y2MIAiWmcODpYAkygYxUUJJEwPnugnipghFd451lKwDhopQxGGK2AtCpNLTW+iUKYT';

export const warmUpPayload = () => Uint8Array.from(atob(TORUS), (character) => character.charCodeAt(0));
