/* Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0 */
#ifndef MCC_EXPORT_H_
#define MCC_EXPORT_H_

/** Marks what the shared libraries export. Everything else is compiled hidden: internals may change in every release.
 * On Windows whoever links the static libraries defines MCC_STATIC, and who compiles a DLL of the sources MCC_BUILDING;
 * the targets of the CMake package do so. */
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
