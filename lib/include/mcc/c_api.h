/* Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * C API of reader, writer and glTF layer, for C99 and for other languages.
 *
 * - Functions return a mcc_status; no C++ exception leaves them. Null for a pointer that must not be is
 *   MCC_ERROR_BAD_ARGUMENT.
 * - Objects (mcc_payload, mcc_encoding, mcc_document) are made by one function and given back to their own
 *   release function, which accepts null. They may move between threads, but only reading them is safe from several.
 * - Options begin with `struct_bytes`. The init functions fill in that and the defaults; members that later versions
 *   append keep their defaults for programs compiled before. A null pointer to options means the defaults.
 * - The functions of the writer (mcc_encode…) and of documents (mcc_convert…, mcc_decode_glb, mcc_document…) are in
 *   those libraries; the reader's library has the rest.
 */
#ifndef MCC_C_API_H_
#define MCC_C_API_H_

#include <stddef.h>
#include <stdint.h>

#include "mcc/export.h"

#ifdef __cplusplus
extern "C" {
#endif

/** What went wrong. The numbers never change. */
enum {
  MCC_OK = 0,
  MCC_ERROR_TRUNCATED = 1,           /**< the payload ends inside a field or a stream */
  MCC_ERROR_BAD_MAGIC = 2,           /**< the bytes are not a mesh collapse payload */
  MCC_ERROR_UNSUPPORTED_VERSION = 3, /**< a major version this reader does not know */
  MCC_ERROR_BAD_CHECKSUM = 4,        /**< the CRC-32 does not match: the payload is damaged */
  MCC_ERROR_BAD_HEADER = 5,          /**< a header field has a value the format does not assign */
  MCC_ERROR_BAD_CONNECTIVITY = 6, /**< an operation that no mesh collapse code can contain here */
  MCC_ERROR_BAD_STITCH = 7,       /**< a reference to a vertex group that does not exist */
  MCC_ERROR_BAD_ATTRIBUTE = 8,    /**< an attribute stream that no writer produces */
  MCC_ERROR_TRAILING_BYTES = 9,   /**< bytes are left over behind the last stream */
  MCC_ERROR_LIMIT = 10,           /**< a count above the caller's limits or the format's own */
  MCC_ERROR_OUT_OF_MEMORY = 11,   /**< the allocator returned null */
  MCC_ERROR_BAD_ARGUMENT = 12,    /**< the arguments contradict each other */
  MCC_ERROR_CANCELLED = 13,       /**< the progress callback asked to stop */
  MCC_ERROR_DOCUMENT = 64         /**< of documents: see mcc_document_message() */
};

/** The offset of a status that knows none. */
#define MCC_NO_OFFSET UINT64_MAX

/** Result of every fallible function. */
typedef struct mcc_status {
  int32_t error;         /**< MCC_OK or one of MCC_ERROR_… */
  const char* what;      /**< plain English, never freed; "" when all went well */
  uint64_t offset_bytes; /**< place in the payload, or MCC_NO_OFFSET */
} mcc_status;

/** Version of the library, "1.2.3". */
MCC_API const char* mcc_version(void);

/**
 * Writes a status as one line, "the checksum does not match (byte 4)", with its terminating zero, cut to fit.
 * @param text        text_bytes bytes; null: nothing is written
 * @return length of the whole line without the zero, as snprintf()
 */
MCC_API size_t mcc_status_text(mcc_status status, char* text, size_t text_bytes);

/** What an attribute means; see the specification, A.2.4. */
enum {
  MCC_POSITION = 0,
  MCC_NORMAL = 1,
  MCC_TANGENT = 2,
  MCC_TEXCOORD = 3,
  MCC_COLOR = 4,
  MCC_JOINTS = 5,
  MCC_WEIGHTS = 6,
  MCC_CUSTOM = 7
};

/** Component types of glTF accessors. */
enum {
  MCC_INT8 = 0,
  MCC_UINT8 = 1,
  MCC_INT16 = 2,
  MCC_UINT16 = 3,
  MCC_UINT32 = 4,
  MCC_FLOAT32 = 5
};

/** Type of one attribute. Elements are tightly packed components, those of matrices too. */
typedef struct mcc_attribute_format {
  uint32_t semantic; /**< MCC_POSITION … MCC_CUSTOM */
  uint32_t
      set_index; /**< n of TEXCOORD_n; of custom ones the low 8 bits of the CRC-32 of the name */
  uint32_t component_type;  /**< MCC_INT8 … MCC_FLOAT32 */
  uint32_t component_count; /**< 1 to 4, 9 or 16 */
  uint32_t normalized;      /**< 1: integers stand for fractions */
  uint32_t morph_target;    /**< 0: the base mesh; k: deltas of morph target k - 1 */
} mcc_attribute_format;

/** Bytes of one element; 0 when the format is none. */
MCC_API size_t mcc_element_bytes(const mcc_attribute_format* format);

/** Regular grid of a quantised float attribute: value = float(float(q * step) + origin). */
typedef struct mcc_lattice {
  float origin[4];
  float step;
} mcc_lattice;

/** Where memory comes from. Null functions mean malloc() and free(). */
typedef struct mcc_allocator {
  void* (*allocate)(void* user, size_t bytes); /**< may return null */
  void (*release)(void* user, void* memory, size_t bytes);
  void* user;
} mcc_allocator;

/* ---------------------------------------------------------------- reader */

/** An opened payload: its parsed and checked header. */
typedef struct mcc_payload mcc_payload;

/** Bounds that hold before anything is allocated, see mcc::Limits. */
typedef struct mcc_open_options {
  size_t struct_bytes;
  uint64_t max_vertices;     /**< default 2^28 */
  uint64_t max_triangles;    /**< default 2^28 */
  uint64_t max_elements;     /**< the work; no bound by default */
  uint64_t max_output_bytes; /**< of all attributes and indices of 32 bits; no bound by default */
  uint32_t max_attributes;   /**< default 1024 */
  uint32_t max_pieces;       /**< default 65536 */
  mcc_allocator allocator;   /**< for the payload object itself */
} mcc_open_options;

/** Fills in `struct_bytes`, which is sizeof(mcc_open_options) of the caller, and the defaults. */
MCC_API void mcc_open_options_init(mcc_open_options* options, size_t struct_bytes);

/**
 * Parses and checks a payload: header, checksum, all counts against the limits. Time O(byte_count).
 * Safe for untrusted input. Tests: tests/c_api.
 * @param bytes    exactly those of the buffer view; they must outlive the payload
 * @param payload  receives the object, null on an error; mcc_payload_close() releases it
 * @return MCC_ERROR_TRUNCATED, _BAD_MAGIC, _UNSUPPORTED_VERSION, _BAD_CHECKSUM, _BAD_HEADER, _TRAILING_BYTES, _LIMIT,
 *         _OUT_OF_MEMORY, _BAD_ARGUMENT
 */
MCC_API mcc_status mcc_payload_open(const void* bytes, size_t byte_count,
                                    const mcc_open_options* options, mcc_payload** payload);

/** Releases a payload. */
MCC_API void mcc_payload_close(mcc_payload* payload);

/** Counts of one piece: a set of wedges (glTF vertices) with its attributes and triangle lists. */
typedef struct mcc_piece_info {
  uint32_t wedge_count;     /**< accessor.count of every attribute */
  uint32_t vertex_count;    /**< distinct positions */
  uint32_t attribute_count; /**< 0: the payload has the triangles alone */
  uint32_t part_count;      /**< triangle lists; each is one glTF primitive */
} mcc_piece_info;

/** How an attribute is stored, see mcc::AttributeCoding. */
typedef struct mcc_attribute_info {
  mcc_attribute_format format;
  uint32_t
      coding; /**< 0 lattice, 1 integer, 2 exact float, 3 octahedral, 4 tangent angle, 5 alias, 6 grid */
  uint32_t bits;       /**< of codings 0, 3, 4, 6 */
  mcc_lattice lattice; /**< of coding 0: values are off by at most half a step, weights by one */
} mcc_attribute_info;

/** Number of pieces. */
MCC_API uint32_t mcc_payload_piece_count(const mcc_payload* payload);
/** Counts of a piece. @return MCC_ERROR_BAD_ARGUMENT when there is no such piece */
MCC_API mcc_status mcc_payload_piece(const mcc_payload* payload, uint32_t piece,
                                     mcc_piece_info* info);
/** Type and coding of an attribute. @return MCC_ERROR_BAD_ARGUMENT when there is none of these numbers */
MCC_API mcc_status mcc_payload_attribute(const mcc_payload* payload, uint32_t piece,
                                         uint32_t attribute, mcc_attribute_info* info);
/** Triangles of a part. @return MCC_ERROR_BAD_ARGUMENT when there is none of these numbers */
MCC_API mcc_status mcc_payload_part(const mcc_payload* payload, uint32_t piece, uint32_t part,
                                    uint32_t* triangle_count);

/** Where one attribute goes. */
typedef struct mcc_attribute_target {
  void* data;          /**< wedge_count elements; null: the attribute is decoded and dropped */
  size_t stride_bytes; /**< from element to element, at least mcc_element_bytes() */
} mcc_attribute_target;

/** Where the triangles of one part go. */
typedef struct mcc_part_target {
  void* indices; /**< 3 * triangle_count; null: dropped */
  uint32_t
      index_bytes; /**< 1, 2 or 4: uint8_t, uint16_t or uint32_t, where wedge_count - 1 must fit */
} mcc_part_target;

/** Where a piece goes: one entry per attribute and per part, in the payload's order. */
typedef struct mcc_piece_target {
  const mcc_attribute_target* attributes;
  size_t attribute_count;
  const mcc_part_target* parts;
  size_t part_count;
} mcc_piece_target;

/** What mcc_payload_decode() may use, and whom it tells. */
typedef struct mcc_decode_options {
  size_t struct_bytes;
  mcc_allocator allocator; /**< for the working memory */
  /** Called behind every stage with the work done, rising to 1, on the thread of the call; 0 cancels. May be null. */
  int (*progress)(void* user, double done);
  void* progress_user;
} mcc_decode_options;

/** Fills in `struct_bytes`, which is sizeof(mcc_decode_options) of the caller, and the defaults. */
MCC_API void mcc_decode_options_init(mcc_decode_options* options, size_t struct_bytes);

/**
 * Decodes all pieces into memory of the caller. On an error that holds unspecified bytes; nothing is written beyond it.
 * Safe for untrusted input; work and memory are linear in the counts; the same bytes on every platform. Several payloads
 * may be decoded at the same time. Inverse: mcc_encode(). Tests: tests/c_api.
 * @param targets  one entry per piece
 * @return MCC_ERROR_TRUNCATED, _BAD_CONNECTIVITY, _BAD_STITCH, _BAD_ATTRIBUTE, _TRAILING_BYTES, _LIMIT, _OUT_OF_MEMORY,
 *         _BAD_ARGUMENT, _CANCELLED
 */
MCC_API mcc_status mcc_payload_decode(const mcc_payload* payload, const mcc_piece_target* targets,
                                      size_t target_count, const mcc_decode_options* options);

/* ---------------------------------------------------------------- writer */

/** One vertex attribute as the caller holds it. */
typedef struct mcc_attribute_view {
  mcc_attribute_format format;
  const void* data;    /**< wedge_count elements */
  size_t stride_bytes; /**< at least mcc_element_bytes() */
  uint32_t
      quantization_bits; /**< of floats: 1..24, of normals and tangents 2..16; 0: every bit is kept */
  const mcc_lattice* lattice; /**< used instead of the box of the values; null: that box */
} mcc_attribute_view;

/** A triangle list: any indices below wedge_count, three per triangle. */
typedef struct mcc_part_view {
  const uint32_t* indices;
  size_t index_count;
} mcc_part_view;

/** A set of wedges with attributes and triangle lists. attributes[0] is POSITION, three components. */
typedef struct mcc_piece_view {
  uint32_t wedge_count;
  const mcc_attribute_view* attributes;
  size_t attribute_count;
  const mcc_part_view* parts;
  size_t part_count;
} mcc_piece_view;

/** What choices between bytes and the time of decoding go by, see mcc::Preference. */
enum { MCC_PREFER_BALANCED = 0, MCC_PREFER_SIZE = 1, MCC_PREFER_SPEED = 2 };

/** How mcc_encode() encodes. */
typedef struct mcc_encode_options {
  size_t struct_bytes;
  uint32_t keep_vertex_order; /**< 1: decoded wedges come in the order of the view */
  uint32_t
      keep_triangle_order; /**< 1: decoded triangles come in order, each with its own first corner */
  uint32_t effort;         /**< 0 fast, 1, 2 small */
  uint32_t prefer;         /**< MCC_PREFER_… */
} mcc_encode_options;

/** Fills in `struct_bytes`, which is sizeof(mcc_encode_options) of the caller, and the defaults. */
MCC_API void mcc_encode_options_init(mcc_encode_options* options, size_t struct_bytes);

/** A finished payload with what is known about it. */
typedef struct mcc_encoding mcc_encoding;

/**
 * Compresses pieces into one payload. Deterministic: the same bytes on every machine. Time O(n log n).
 * Inverse: mcc_payload_decode(). Tests: tests/c_api.
 * @param encoding  receives the object, null on an error; mcc_encoding_release() releases it
 * @return MCC_ERROR_BAD_ARGUMENT (an index beyond the wedges, no POSITION, bits out of range, null data), _LIMIT,
 *         _OUT_OF_MEMORY
 */
MCC_API mcc_status mcc_encode(const mcc_piece_view* pieces, size_t piece_count,
                              const mcc_encode_options* options, mcc_encoding** encoding);
/** The payload, owned by the encoding. */
MCC_API const uint8_t* mcc_encoding_payload(const mcc_encoding* encoding, size_t* byte_count);
/** source[i] is the wedge of the view that decoded wedge i carries; owned by the encoding. Null: no such piece. */
MCC_API const uint32_t* mcc_encoding_source_wedges(const mcc_encoding* encoding, size_t piece,
                                                   size_t* wedge_count);
/** Releases an encoding. */
MCC_API void mcc_encoding_release(mcc_encoding* encoding);

/* ---------------------------------------------------------------- documents */

/** A GLB that was made, or the words why not. */
typedef struct mcc_document mcc_document;

/** Which primitives share a lattice of positions, and therefore cannot crack apart. */
enum { MCC_GRID_MESH = 0, MCC_GRID_SCENE = 1, MCC_GRID_PRIMITIVE = 2 };

/** See mcc::gltf::ConvertOptions. */
typedef struct mcc_convert_options {
  size_t struct_bytes;
  uint32_t position_bits;       /**< default 14; 0 keeps every bit, as below */
  uint32_t normal_bits;         /**< default 10 */
  uint32_t texcoord_bits;       /**< default 12 */
  uint32_t color_bits;          /**< default 8 */
  uint32_t tangent_bits;        /**< default 12 */
  uint32_t weight_bits;         /**< default 12 */
  uint32_t lossless;            /**< 1: every float keeps every bit */
  uint32_t grid;                /**< MCC_GRID_… */
  double max_position_error;    /**< not 0: no position moves farther, instead of position_bits */
  uint32_t is_error_relative;   /**< 1: that is a fraction of the largest side of the box */
  uint32_t indices_only;        /**< 1: triangles alone are compressed */
  uint32_t keep_vertex_order;   /**< 1: decoded vertices come in the order of the source */
  uint32_t keep_triangle_order; /**< 1: decoded triangles, too */
  uint32_t effort;              /**< 0 fast, 1, 2 small */
  uint32_t thread_count;        /**< the result does not depend on it */
  const mcc_lattice* position_lattice; /**< lattice of all positions, for tiles; null: none */
  uint32_t prefer;                     /**< MCC_PREFER_… */
  uint64_t max_decoded_bytes; /**< of what is compressed; 0: as of mcc_decode_glb_options */
  uint32_t drop_unused;       /**< 1: vertices that no triangle uses are left out */
} mcc_convert_options;

/** Fills in `struct_bytes`, which is sizeof(mcc_convert_options) of the caller, and the defaults. */
MCC_API void mcc_convert_options_init(mcc_convert_options* options, size_t struct_bytes);

/**
 * Compresses the meshes of a GLB. The result was decoded and compared with the source; it is the source when nothing was
 * gained. Safe for untrusted input. Deterministic. Inverse: mcc_decode_glb(). Tests: tests/c_api.
 * @param document  receives an object also on an error, for its message; null only when memory is short.
 *                  mcc_document_release() releases it
 * @return MCC_ERROR_DOCUMENT, _BAD_ARGUMENT, _OUT_OF_MEMORY
 */
MCC_API mcc_status mcc_convert_glb(const void* glb, size_t byte_count,
                                   const mcc_convert_options* options, mcc_document** document);

/** What mcc_decode_glb() makes. */
typedef struct mcc_decode_glb_options {
  size_t struct_bytes;
  uint32_t decode_to_integers; /**< 1: quantised attributes stay integers (KHR_mesh_quantization) */
  uint32_t thread_count; /**< payloads decoded at the same time; the result does not depend on it */
  /** A GLB that asks for more bytes of decoded geometry is refused before memory is taken. 0, the default: 1024 for each of its
   * bytes, but no less than 256 MiB and no more than 4 GiB. */
  uint64_t max_decoded_bytes;
} mcc_decode_glb_options;

/** Fills in `struct_bytes`, which is sizeof(mcc_decode_glb_options) of the caller, and the defaults. */
MCC_API void mcc_decode_glb_options_init(mcc_decode_glb_options* options, size_t struct_bytes);

/**
 * Turns compressed primitives of a GLB into ordinary accessors again. As mcc_convert_glb() otherwise, whose inverse it is.
 */
MCC_API mcc_status mcc_decode_glb(const void* glb, size_t byte_count,
                                  const mcc_decode_glb_options* options, mcc_document** document);

/** The GLB, owned by the document; null after an error. */
MCC_API const uint8_t* mcc_document_bytes(const mcc_document* document, size_t* byte_count);
/** Why there is none, "/meshes/0/primitives/1: what is wrong"; "" when there is. Owned by the document. */
MCC_API const char* mcc_document_message(const mcc_document* document);
/** Releases a document. */
MCC_API void mcc_document_release(mcc_document* document);

#ifdef __cplusplus
}
#endif

#endif /* MCC_C_API_H_ */
