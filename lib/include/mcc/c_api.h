/* Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * C API of the reader, the writer and the glTF layer, for C99 and for other languages.
 *
 * - Functions return an mcc_status; no C++ exception leaves them. An argument that can be seen
 *   to be wrong gives MCC_ERROR_BAD_ARGUMENT: null for a pointer that must not be null, a number
 *   that is no enumerator, a flag that is neither 0 nor 1, a count or stride that leads beyond all
 *   memory, one function of an allocator without the other. Whether memory is there, and is as
 *   large as the caller says, cannot be seen.
 * - Objects (mcc_payload, mcc_encoding, mcc_document) are created by one function and released by
 *   their own release function, which accepts null. They may move between threads, but several
 *   threads may use one at the same time only to read it.
 * - Structs that later versions may extend at their end begin with `struct_bytes`: how many bytes
 *   of the struct the program knows, sizeof when it was compiled. The library never reads or writes
 *   more of it, so that a program and a library of different versions go together. Members that the
 *   library is too old to know are neither read nor written.
 *     - Options: the init functions set `struct_bytes` and fill in the defaults. Members that later
 *       versions append keep their defaults for programs compiled earlier. A null pointer means the
 *       defaults. A `struct_bytes` that no struct can have, because it is not a multiple of the
 *       alignment, gives MCC_ERROR_BAD_ARGUMENT.
 *     - Information (mcc_piece_info, mcc_attribute_info): the program sets `struct_bytes` before
 *       the call that fills the rest; it stays set for the next call.
 *   Structs without `struct_bytes` never change.
 * - The functions of the writer (mcc_encode…) and of documents (mcc_convert…, mcc_decode_glb,
 *   mcc_document…) are in those libraries; the reader's library has the rest.
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
  MCC_ERROR_UNSUPPORTED_VERSION = 3, /**< a version of the format this reader does not know */
  MCC_ERROR_BAD_CHECKSUM = 4,        /**< the CRC-32 does not match: the payload is damaged */
  MCC_ERROR_BAD_HEADER = 5,          /**< a header field has a value the format does not assign */
  MCC_ERROR_BAD_CONNECTIVITY = 6, /**< an operation that no mesh collapse code can contain here */
  MCC_ERROR_BAD_STITCH = 7,       /**< a reference to a vertex group that does not exist */
  MCC_ERROR_BAD_ATTRIBUTE = 8,    /**< an attribute stream that no writer produces */
  MCC_ERROR_TRAILING_BYTES = 9,   /**< bytes are left over after the last stream */
  MCC_ERROR_LIMIT = 10,           /**< a count above the caller's limits or the format's own */
  MCC_ERROR_OUT_OF_MEMORY = 11,   /**< the allocator returned null */
  MCC_ERROR_BAD_ARGUMENT = 12,    /**< the arguments contradict each other */
  MCC_ERROR_CANCELLED = 13,       /**< the progress callback asked to stop */
  MCC_ERROR_DOCUMENT = 64         /**< a document was refused: mcc_document_message() says why */
};

/** The offset of a status that has no known place in the payload. */
#define MCC_NO_OFFSET UINT64_MAX

/** Result of every fallible function. */
typedef struct mcc_status {
  int32_t error;         /**< MCC_OK or one of MCC_ERROR_… */
  const char* what;      /**< plain English, a constant, never freed; "" when all went well */
  uint64_t offset_bytes; /**< place in the payload, or MCC_NO_OFFSET */
} mcc_status;

/** Returns the version of the library, such as "1.2.3", as a string that is never freed. */
MCC_API const char* mcc_version(void);

/**
 * Writes a status as one line, such as "the checksum does not match (byte 4)", with a terminating
 * zero. The line is cut when it does not fit.
 * @param text  memory of text_bytes bytes; null: nothing is written
 * @return the length of the whole line without the zero, as snprintf() does
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

/** Type of one attribute. The components of an element are tightly packed, also in matrices. */
typedef struct mcc_attribute_format {
  uint32_t semantic; /**< MCC_POSITION … MCC_CUSTOM */
  /** n of TEXCOORD_n; for MCC_CUSTOM the low 8 bits of the CRC-32 of the name */
  uint32_t set_index;
  uint32_t component_type;  /**< MCC_INT8 … MCC_FLOAT32 */
  uint32_t component_count; /**< 1 to 4, 9 or 16 */
  uint32_t normalized;      /**< 1: integers stand for fractions */
  uint32_t morph_target;    /**< 0: the base mesh; k: deltas of morph target k - 1 */
} mcc_attribute_format;

/** Returns the bytes of one element, or 0 when the format is not valid. */
MCC_API size_t mcc_element_bytes(const mcc_attribute_format* format);

/** Regular grid of a quantised float attribute: value = float(float(q * step) + origin). */
typedef struct mcc_lattice {
  float origin[4];
  float step;
} mcc_lattice;

/** Where memory comes from: both functions, or neither for malloc() and free(). */
typedef struct mcc_allocator {
  void* (*allocate)(void* user, size_t bytes); /**< may return null */
  void (*release)(void* user, void* memory, size_t bytes);
  void* user;
} mcc_allocator;

/**
 * Calls job(job_user, 0) … job(job_user, count - 1), in any order and possibly at the same time,
 * and returns when all have ended. It calls every job exactly once. Jobs may call the function
 * again, also at the same time.
 */
typedef void (*mcc_run_jobs)(void* user, size_t count, void (*job)(void* job_user, size_t index),
                             void* job_user);

/* ---------------------------------------------------------------- reader */

/** An opened payload: its parsed and checked header. */
typedef struct mcc_payload mcc_payload;

/** Bounds that are checked before anything is allocated, see mcc::Limits. */
typedef struct mcc_open_options {
  size_t struct_bytes;
  uint64_t max_vertices;  /**< default 2^28 */
  uint64_t max_triangles; /**< default 2^28 */
  uint64_t max_elements;  /**< bounds the work, see mcc::Limits; no bound by default */
  /** bounds the bytes of all attributes and of indices of 32 bits; no bound by default */
  uint64_t max_output_bytes;
  uint32_t max_attributes; /**< default 1024 */
  uint32_t max_pieces;     /**< default 65536 */
  mcc_allocator allocator; /**< for the payload object and its parsed header */
} mcc_open_options;

/** Sets `struct_bytes`, which the caller passes as sizeof(mcc_open_options), and the defaults. */
MCC_API void mcc_open_options_init(mcc_open_options* options, size_t struct_bytes);

/**
 * Parses and checks a payload: the header, the checksum, and all counts against the limits. Takes
 * time O(byte_count). Safe for untrusted input. Tests: tests/c_api.
 * @param bytes    exactly the bytes of the buffer view; they must outlive the payload
 * @param payload  receives the object, or null on an error; release it by mcc_payload_close()
 * @return MCC_ERROR_TRUNCATED, _BAD_MAGIC, _UNSUPPORTED_VERSION, _BAD_CHECKSUM, _BAD_HEADER,
 *   _TRAILING_BYTES, _LIMIT, _OUT_OF_MEMORY, _BAD_ARGUMENT
 */
MCC_API mcc_status mcc_payload_open(const void* bytes, size_t byte_count,
                                    const mcc_open_options* options, mcc_payload** payload);

/**
 * Opens a payload of which only the beginning is there yet, see mcc::Payload::openPrefix(). Works
 * like mcc_payload_open(). MCC_ERROR_TRUNCATED says that the header, or a payload without blocks,
 * is not complete yet: call it again with more bytes.
 * @param bytes          must outlive the payload, or the next mcc_payload_extend()
 * @param payload_bytes  the size of the whole payload, which is that of the buffer view
 */
MCC_API mcc_status mcc_payload_open_prefix(const void* bytes, size_t byte_count,
                                           uint64_t payload_bytes, const mcc_open_options* options,
                                           mcc_payload** payload);

/**
 * Tells an open payload that more of its bytes are there; they may be in another place in memory.
 * Must not run during other calls.
 * @return MCC_ERROR_BAD_ARGUMENT when there are fewer bytes than before, or more than the payload
 *   has
 */
MCC_API mcc_status mcc_payload_extend(mcc_payload* payload, const void* bytes, size_t byte_count);

/** Returns for how many blocks, from the first on, all bytes are there. */
MCC_API uint32_t mcc_payload_loaded_block_count(const mcc_payload* payload);

/** Releases a payload; null is accepted. */
MCC_API void mcc_payload_close(mcc_payload* payload);

/**
 * Counts of one piece: a set of wedges (glTF vertices) with their attributes and triangle lists.
 */
typedef struct mcc_piece_info {
  size_t struct_bytes;  /**< sizeof(mcc_piece_info), set by the caller */
  uint32_t wedge_count; /**< accessor.count of every attribute */
  /** before stitching: a position at a cut, or at the borders of blocks, counts repeatedly */
  uint32_t vertex_count;
  uint32_t attribute_count; /**< 0: the payload has only the triangles */
  uint32_t part_count;      /**< triangle lists; each is one glTF primitive */
} mcc_piece_info;

/** How an attribute is coded, see mcc::AttributeCoding. */
enum {
  MCC_CODING_LATTICE = 0,
  MCC_CODING_INTEGER = 1,
  MCC_CODING_EXACT_FLOAT = 2,
  MCC_CODING_OCTAHEDRAL = 3,
  MCC_CODING_TANGENT_ANGLE = 4,
  MCC_CODING_ALIAS = 5,
  MCC_CODING_GRID = 6
};

/** The type of an attribute, and how it is stored. */
typedef struct mcc_attribute_info {
  size_t struct_bytes; /**< sizeof(mcc_attribute_info), set by the caller */
  mcc_attribute_format format;
  uint32_t coding; /**< MCC_CODING_LATTICE … MCC_CODING_GRID */
  uint32_t bits;   /**< 0 for integers, exact floats and aliases */
  /** of MCC_CODING_LATTICE: values are off by at most half a step, weights by at most one step */
  mcc_lattice lattice;
} mcc_attribute_info;

/** Returns the number of pieces, or 0 for null. */
MCC_API uint32_t mcc_payload_piece_count(const mcc_payload* payload);
/**
 * Reads the counts of a piece.
 * @param info  its `struct_bytes` must be set
 * @return MCC_ERROR_BAD_ARGUMENT when there is no such piece or `struct_bytes` is not set
 */
MCC_API mcc_status mcc_payload_piece(const mcc_payload* payload, uint32_t piece,
                                     mcc_piece_info* info);
/**
 * Reads the type and the coding of an attribute.
 * @param info  its `struct_bytes` must be set
 * @return MCC_ERROR_BAD_ARGUMENT when there is no such piece or attribute, or `struct_bytes` is not
 *   set
 */
MCC_API mcc_status mcc_payload_attribute(const mcc_payload* payload, uint32_t piece,
                                         uint32_t attribute, mcc_attribute_info* info);
/**
 * Reads the number of triangles of a part.
 * @return MCC_ERROR_BAD_ARGUMENT when there is no such piece or part
 */
MCC_API mcc_status mcc_payload_part(const mcc_payload* payload, uint32_t piece, uint32_t part,
                                    uint32_t* triangle_count);

/**
 * A block: a part of a large surface, see mcc::BlockInfo. A payload with blocks has one piece.
 */
typedef struct mcc_block_info {
  size_t struct_bytes;     /**< sizeof(mcc_block_info), set by the caller */
  uint32_t wedge_count;    /**< of the block alone */
  uint32_t repeated_count; /**< how many of them blocks before this one have too */
  uint32_t triangle_count;
  uint64_t offset_bytes; /**< where its streams begin in the payload */
  uint64_t stream_bytes;
  float low[3]; /**< the smallest box of its positions, in the units of the accessor */
  float high[3];
} mcc_block_info;

/** Returns the number of blocks, or 0 for null and for payloads without blocks. */
MCC_API uint32_t mcc_payload_block_count(const mcc_payload* payload);
/**
 * Reads what the header says of a block.
 * @param info  its `struct_bytes` must be set
 * @return MCC_ERROR_BAD_ARGUMENT when there is no such block or `struct_bytes` is not set
 */
MCC_API mcc_status mcc_payload_block(const mcc_payload* payload, uint32_t block,
                                     mcc_block_info* info);
/**
 * Reads the number of triangles that a block has of a part.
 * @return MCC_ERROR_BAD_ARGUMENT when there is no such block or part
 */
MCC_API mcc_status mcc_payload_block_part(const mcc_payload* payload, uint32_t block, uint32_t part,
                                          uint32_t* triangle_count);

/** Where one attribute goes. */
typedef struct mcc_attribute_target {
  void* data;          /**< wedge_count elements; null: the attribute is decoded and dropped */
  size_t stride_bytes; /**< from one element to the next, at least mcc_element_bytes() */
} mcc_attribute_target;

/** Where the triangles of one part go. */
typedef struct mcc_part_target {
  void* indices; /**< 3 * triangle_count indices; null: the triangles are decoded and dropped */
  /** 1, 2 or 4 for uint8_t, uint16_t or uint32_t; wedge_count - 1 must fit into the type */
  uint32_t index_bytes;
} mcc_part_target;

/** Where a piece goes: one entry per attribute and per part, in the payload's order. */
typedef struct mcc_piece_target {
  const mcc_attribute_target* attributes;
  size_t attribute_count;
  const mcc_part_target* parts;
  size_t part_count;
} mcc_piece_target;

/** The resources and callbacks of mcc_payload_decode(). */
typedef struct mcc_decode_options {
  size_t struct_bytes;
  mcc_allocator allocator; /**< for the working memory */
  /**
   * Called after every stage with the share of the work that is done, which rises to 1, on the
   * calling thread; with run_jobs on any of its threads, one call at a time. Returning 0 cancels.
   * May be null.
   */
  int (*progress)(void* user, double done);
  void* progress_user;
  mcc_run_jobs run_jobs; /**< decodes blocks on several threads; may be null */
  void* run_jobs_user;
} mcc_decode_options;

/** Sets `struct_bytes`, which the caller passes as sizeof(mcc_decode_options), and the defaults. */
MCC_API void mcc_decode_options_init(mcc_decode_options* options, size_t struct_bytes);

/**
 * Decodes all pieces into memory of the caller. After an error this memory holds unspecified bytes,
 * and nothing was written outside it. Safe for untrusted input. Work and memory are linear in the
 * counts. The result is the same on every platform. Several payloads may be decoded at the same
 * time. Inverse: mcc_encode(). Tests: tests/c_api.
 * @param targets  one entry per piece
 * @return MCC_ERROR_TRUNCATED, _BAD_CHECKSUM (of a block), _BAD_CONNECTIVITY, _BAD_STITCH,
 *   _BAD_ATTRIBUTE, _TRAILING_BYTES, _LIMIT, _OUT_OF_MEMORY, _BAD_ARGUMENT, _CANCELLED
 */
MCC_API mcc_status mcc_payload_decode(const mcc_payload* payload, const mcc_piece_target* targets,
                                      size_t target_count, const mcc_decode_options* options);

/**
 * Decodes block 0 and keeps the models with which all other blocks begin. Must not run during other
 * calls.
 * @param target  where to store the block, with its own counts, or null
 * @return as mcc_payload_decode_block()
 */
MCC_API mcc_status mcc_payload_prime(mcc_payload* payload, const mcc_piece_target* target,
                                     const mcc_decode_options* options);

/**
 * Decodes one block for itself, see mcc::Payload::decodeBlock(): its wedges have their own numbers,
 * and those that it shares with other blocks are included. Every block except 0 needs
 * mcc_payload_prime() first. May be called by several threads.
 * @param target  like that of a piece, with the counts of mcc_block_info
 * @return the errors of mcc_payload_decode(), and MCC_ERROR_BAD_CHECKSUM when the block is damaged,
 *   _TRUNCATED when its bytes are not all there
 */
MCC_API mcc_status mcc_payload_decode_block(const mcc_payload* payload, uint32_t block,
                                            const mcc_piece_target* target,
                                            const mcc_decode_options* options);

/** Where a meshlet is in the arrays of an mcc_meshlet_target. Has the layout of meshopt_Meshlet. */
typedef struct mcc_meshlet {
  uint32_t vertex_offset;
  uint32_t triangle_offset; /**< a multiple of 4 */
  uint32_t vertex_count;
  uint32_t triangle_count;
} mcc_meshlet;

/** Which triangles go into a meshlet, see mcc::MeshletShape. */
enum { MCC_MESHLETS_ROUND = 0, MCC_MESHLETS_IN_ORDER = 1 };

/** How large meshlets may be. */
typedef struct mcc_meshlet_options {
  size_t struct_bytes;
  uint32_t max_vertices;   /**< 3..256; default 64 */
  uint32_t max_triangles;  /**< 1..512; default 124 */
  uint32_t shape;          /**< MCC_MESHLETS_… */
  mcc_allocator allocator; /**< for the working memory */
} mcc_meshlet_options;

/**
 * Sets `struct_bytes`, which the caller passes as sizeof(mcc_meshlet_options), and the defaults.
 */
MCC_API void mcc_meshlet_options_init(mcc_meshlet_options* options, size_t struct_bytes);

/** Numbers of elements in the arrays of an mcc_meshlet_target. */
typedef struct mcc_meshlet_sizes {
  size_t meshlet_count;
  size_t vertex_count;
  size_t triangle_bytes;
} mcc_meshlet_sizes;

/** Memory of the caller that mcc_build_meshlets() fills, of at least mcc_meshlet_bound(). */
typedef struct mcc_meshlet_target {
  mcc_meshlet* meshlets;
  uint32_t* vertices;      /**< for each meshlet its vertices, as the indices have them */
  uint8_t* triangles;      /**< for each triangle the numbers of its corners among these */
  mcc_meshlet_sizes sizes; /**< of the three arrays */
} mcc_meshlet_target;

/** Triangles as mcc_payload_decode() makes them for a part. */
typedef struct mcc_triangle_list {
  const void* indices;  /**< 3 * triangle_count, aligned for their type */
  uint32_t index_bytes; /**< 1, 2 or 4 */
  uint32_t triangle_count;
  uint32_t vertex_count; /**< each index is below it: mcc_piece_info::wedge_count */
} mcc_triangle_list;

/**
 * Returns how large the arrays of an mcc_meshlet_target have to be for any list of so many
 * triangles; at most 2^28, and zeros when mcc_build_meshlets() refuses the numbers.
 */
MCC_API mcc_meshlet_sizes mcc_meshlet_bound(uint32_t triangle_count,
                                            const mcc_meshlet_options* options);

/**
 * Divides a triangle list into meshlets, see mcc::buildMeshlets(). Each triangle is in one of them,
 * with its corners in their order. Safe for untrusted indices. Takes linear time. Deterministic.
 * Tests: tests/c_api.
 * @param used  receives how much of the arrays is in use, or zeros on an error
 * @return MCC_ERROR_BAD_ARGUMENT (options out of range, an index that is no vertex, arrays that are
 *   null or too small), _LIMIT, _OUT_OF_MEMORY
 */
MCC_API mcc_status mcc_build_meshlets(const mcc_triangle_list* list,
                                      const mcc_meshlet_target* target, mcc_meshlet_sizes* used,
                                      const mcc_meshlet_options* options);

/* ---------------------------------------------------------------- writer */

/** One vertex attribute in the caller's memory. */
typedef struct mcc_attribute_view {
  mcc_attribute_format format;
  const void* data;    /**< wedge_count elements */
  size_t stride_bytes; /**< at least mcc_element_bytes() */
  /** bits per component: 1..24 for floats, 2..16 for normals and tangents; 0: every bit is kept */
  uint32_t quantization_bits;
  /** used instead of a lattice over the bounding box of the values; null: the bounding box */
  const mcc_lattice* lattice;
} mcc_attribute_view;

/** A triangle list: three indices per triangle, each below wedge_count. */
typedef struct mcc_part_view {
  const uint32_t* indices;
  size_t index_count;
} mcc_part_view;

/**
 * A set of wedges with attributes and triangle lists. attributes[0] is POSITION of 3 components.
 */
typedef struct mcc_piece_view {
  uint32_t wedge_count;
  const mcc_attribute_view* attributes;
  size_t attribute_count;
  const mcc_part_view* parts;
  size_t part_count;
} mcc_piece_view;

/** How the writer weighs fewer bytes against faster decoding, see mcc::Preference. */
enum { MCC_PREFER_BALANCED = 0, MCC_PREFER_SIZE = 1, MCC_PREFER_SPEED = 2 };

/** Lets `prefer` decide whether surfaces are cut into blocks. */
#define MCC_BLOCKS_BY_PREFERENCE 0xffffffffu

/** How mcc_encode() encodes. */
typedef struct mcc_encode_options {
  size_t struct_bytes;
  uint32_t keep_vertex_order; /**< 1: decoded wedges come in the order of the view */
  /** 1: decoded triangles come in the order of the view, each with its own first corner */
  uint32_t keep_triangle_order;
  uint32_t prefer; /**< MCC_PREFER_… */
  /** triangles of a block, see mcc::EncodeOptions; 0: no blocks; default MCC_BLOCKS_BY_PREFERENCE
   */
  uint32_t block_triangles;
  mcc_run_jobs run_jobs; /**< encodes on several threads; the bytes do not depend on it */
  void* run_jobs_user;
} mcc_encode_options;

/** Sets `struct_bytes`, which the caller passes as sizeof(mcc_encode_options), and the defaults. */
MCC_API void mcc_encode_options_init(mcc_encode_options* options, size_t struct_bytes);

/** A finished payload and its source wedges. */
typedef struct mcc_encoding mcc_encoding;

/**
 * Compresses pieces into one payload. Deterministic: the same input gives the same bytes on every
 * machine. Takes time O(n log n). Inverse: mcc_payload_decode(). Tests: tests/c_api.
 * @param encoding  receives the object, or null on an error; release it by mcc_encoding_release()
 * @return MCC_ERROR_BAD_ARGUMENT (an index is not below wedge_count, POSITION is missing, bits,
 *   flags or enumerators are out of range, data is null, or a stride or count leads beyond all
 *   memory), _LIMIT, _OUT_OF_MEMORY
 */
MCC_API mcc_status mcc_encode(const mcc_piece_view* pieces, size_t piece_count,
                              const mcc_encode_options* options, mcc_encoding** encoding);
/** Returns the payload, which is owned by the encoding. */
MCC_API const uint8_t* mcc_encoding_payload(const mcc_encoding* encoding, size_t* byte_count);
/**
 * Returns an array in which entry i is the wedge of the view that decoded wedge i carries. The
 * array is owned by the encoding. Returns null when there is no such piece.
 */
MCC_API const uint32_t* mcc_encoding_source_wedges(const mcc_encoding* encoding, size_t piece,
                                                   size_t* wedge_count);
/** Releases an encoding; null is accepted. */
MCC_API void mcc_encoding_release(mcc_encoding* encoding);

/* ---------------------------------------------------------------- documents */

/** A GLB or a text that was made, or the message that says why it could not be. */
typedef struct mcc_document mcc_document;

/** Which primitives share a lattice of positions; no cracks can open between those that do. */
enum { MCC_GRID_MESH = 0, MCC_GRID_SCENE = 1, MCC_GRID_PRIMITIVE = 2 };

/** A value of mcc_convert_options::preview_triangles. */
#define MCC_PREVIEWS_BY_SHARE 0xffffffffu

/** Options of mcc_convert_glb(), see mcc::gltf::ConvertOptions. */
typedef struct mcc_convert_options {
  size_t struct_bytes;
  uint32_t position_bits;       /**< default 14; 0 keeps every bit, here and below */
  uint32_t normal_bits;         /**< default 10 */
  uint32_t texcoord_bits;       /**< default 12 */
  uint32_t color_bits;          /**< default 8 */
  uint32_t tangent_bits;        /**< default 12 */
  uint32_t weight_bits;         /**< default 12 */
  uint32_t lossless;            /**< 1: every float keeps every bit */
  uint32_t grid;                /**< MCC_GRID_… */
  double max_position_error;    /**< not 0: bounds how far positions move, replaces position_bits */
  uint32_t is_error_relative;   /**< 1: the error is a fraction of the largest side of the box */
  uint32_t indices_only;        /**< 1: only the triangles are compressed */
  uint32_t keep_vertex_order;   /**< 1: decoded vertices come in the order of the source */
  uint32_t keep_triangle_order; /**< 1: decoded triangles come in the order of the source */
  uint32_t thread_count;        /**< the result does not depend on it */
  const mcc_lattice* position_lattice; /**< the lattice of all positions, for tiles; null: none */
  uint32_t prefer;                     /**< MCC_PREFER_… */
  /** bounds what a compressed source may decode to; 0: the default of mcc_decode_glb_options */
  uint64_t max_decoded_bytes;
  uint32_t drop_unused; /**< 1: vertices that no triangle uses are left out */
  /** triangles of a block, see mcc_encode_options */
  uint32_t block_triangles;
  /** not 0: positions are on the lattice of this step through the origin; a power of two from
   * 2^-126 to 2^127, see mcc::gltf::ConvertOptions */
  double step;
  /** not 0: how large a mesh is drawn, 16 to 1048576 pixels, from which all bits follow; see
   * mcc::gltf::ConvertOptions */
  double quality;
  /** 2, 3, or 0: 2 unless the GLB has more than 4 GiB; 3 is that of the draft of glTF 2.1 */
  uint32_t glb_version;
  /** about how many triangles the coarse versions have that large primitives get in front of
   * everything else; 0: none, MCC_PREVIEWS_BY_SHARE: 2 % of those of the primitive */
  uint32_t preview_triangles;
  uint32_t allow_larger; /**< 1: compresses even where that makes the file larger */
} mcc_convert_options;

/**
 * Sets `struct_bytes`, which the caller passes as sizeof(mcc_convert_options), and the defaults.
 */
MCC_API void mcc_convert_options_init(mcc_convert_options* options, size_t struct_bytes);

/**
 * Compresses the meshes of a GLB. The result is decoded and compared with the source before the
 * call returns; where compression gains nothing, the result is the source. Safe for untrusted
 * input. Deterministic. Inverse: mcc_decode_glb(). Tests: tests/c_api.
 * @param document  receives an object, on an error too, so that mcc_document_message() can give the
 *   reason; null only when memory ran out. Release it by mcc_document_release()
 * @return MCC_ERROR_DOCUMENT, _BAD_ARGUMENT, _OUT_OF_MEMORY
 */
MCC_API mcc_status mcc_convert_glb(const void* glb, size_t byte_count,
                                   const mcc_convert_options* options, mcc_document** document);

/** What quantised attributes become: integers need KHR_mesh_quantization. */
enum { MCC_DECODE_TO_FLOATS = 0, MCC_DECODE_TO_INTEGERS = 1 };

/** Options of mcc_decode_glb(). */
typedef struct mcc_decode_glb_options {
  size_t struct_bytes;
  uint32_t decode_to;    /**< MCC_DECODE_TO_… */
  uint32_t thread_count; /**< the result does not depend on it */
  /**
   * A GLB that asks for more bytes of decoded geometry is refused before memory is taken. 0, the
   * default, allows 1024 bytes for each byte of the GLB, but at least 256 MiB and at most 4 GiB.
   */
  uint64_t max_decoded_bytes;
  uint32_t glb_version; /**< as in mcc_convert_options */
} mcc_decode_glb_options;

/**
 * Sets `struct_bytes`, which the caller passes as sizeof(mcc_decode_glb_options), and the defaults.
 */
MCC_API void mcc_decode_glb_options_init(mcc_decode_glb_options* options, size_t struct_bytes);

/**
 * Turns the compressed primitives of a GLB into ordinary accessors again. Ownership, errors and
 * safety are those of mcc_convert_glb(), whose inverse it is.
 */
MCC_API mcc_status mcc_decode_glb(const void* glb, size_t byte_count,
                                  const mcc_decode_glb_options* options, mcc_document** document);

/**
 * Describes the payloads of a GLB as JSON, with the members of `gltf-mcc inspect --format json`: a
 * text in UTF-8, without a terminating zero, that mcc_document_bytes() returns. All payloads are
 * decoded, to count their codes. Ownership, errors and safety are those of mcc_convert_glb().
 * @param name  what the text calls the GLB; null: "". Bytes that are not UTF-8 become U+FFFD
 */
MCC_API mcc_status mcc_inspect_glb(const void* glb, size_t byte_count, const char* name,
                                   mcc_document** document);

/** Returns the GLB or the text, which is owned by the document; null after an error. */
MCC_API const uint8_t* mcc_document_bytes(const mcc_document* document, size_t* byte_count);
/**
 * Returns why there is no GLB, such as "/meshes/0/primitives/1: what is wrong", or "" when there is
 * one. The string is owned by the document.
 */
MCC_API const char* mcc_document_message(const mcc_document* document);
/** Releases a document; null is accepted. */
MCC_API void mcc_document_release(mcc_document* document);

#ifdef __cplusplus
}
#endif

#endif /* MCC_C_API_H_ */
