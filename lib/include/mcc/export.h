/* Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0 */
#ifndef MCC_EXPORT_H_
#define MCC_EXPORT_H_

/** Marks what the shared libraries export. Everything else is compiled hidden: internals may change in every release. */
#if defined(__GNUC__)
#define MCC_API __attribute__((visibility("default")))
#else
#define MCC_API
#endif

#endif /* MCC_EXPORT_H_ */
