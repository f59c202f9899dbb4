/* Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0 */
#ifndef MCC_EXPORT_H_
#define MCC_EXPORT_H_

/**
 * Marks what the shared libraries export. Everything else is compiled as hidden, so that internals
 * may change in every release. On Windows, define MCC_STATIC to link the static libraries and
 * MCC_BUILDING to compile the sources into a DLL; the targets of the CMake package do so.
 */
#if defined(_WIN32)
#if defined(MCC_BUILDING)
#define MCC_API __declspec(dllexport)
#elif defined(MCC_STATIC)
#define MCC_API
#else
#define MCC_API __declspec(dllimport)
#endif
#elif defined(__GNUC__)
#define MCC_API __attribute__((visibility("default")))
#else
#define MCC_API
#endif

#endif /* MCC_EXPORT_H_ */
