/* Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
 *
 * Wrong arguments, by the hundreds: each must be refused with the error that the header names, and
 * nothing may be read, written or kept for it. Valgrind runs this test, too (tools/check/valgrind).
 */
#include "arguments_test.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "mcc/c_api.h"

static int failure_count = 0;
static int case_count = 0;

/* Counts a case. The details say which row of a table it was. */
static void expect(int condition, const char* text, int line, const char* name, double value) {
  ++case_count;
  if (condition) return;
  ++failure_count;
  fprintf(stderr, "arguments_test.c:%d: %s; %s = %.17g\n", line, text, name, value);
}
#define EXPECT_OF(condition, name, value) \
  expect((condition), #condition, __LINE__, (name), (double)(value))
#define EXPECT(condition) EXPECT_OF(condition, "case", 0)
#define COUNT_OF(array) (sizeof(array) / sizeof *(array))

/* A member of a struct that is a number, and the largest that it may be. */
typedef struct member {
  const char* name;
  size_t offset;
  uint32_t most;
} member;

static const uint32_t kWild[] = {1,   2,   3,     7,     8,          16,         17,
                                 24,  25,  63,    64,    255,        256,        257,
                                 300, 512, 65535, 65536, 0x7fffffff, 0x80000000, 0xffffffff};

/* Sizes that lead beyond all memory, if what they count has at least 4 bytes. */
static const size_t kBeyond[] = {SIZE_MAX,     SIZE_MAX - 1,     SIZE_MAX - 2,    SIZE_MAX - 15,
                                 SIZE_MAX / 2, SIZE_MAX / 2 + 1, SIZE_MAX / 3,    SIZE_MAX / 3 + 1,
                                 SIZE_MAX / 4, SIZE_MAX / 4 + 1, SIZE_MAX / 8 + 3};

static void set(void* memory, size_t offset, uint32_t value) {
  memcpy((uint8_t*)memory + offset, &value, sizeof value);
}

/* A sheet of triangles with positions, normals and colours. */
enum { kSide = 6, kWedges = kSide * kSide, kTriangles = 2 * (kSide - 1) * (kSide - 1) };
enum { kPosition, kNormal, kColor, kAttributes };

static float positions[kWedges][3];
static float normals[kWedges][3];
static uint8_t colors[kWedges][4];
static uint32_t indices[3 * kTriangles];

typedef struct sheet {
  mcc_attribute_view attributes[kAttributes];
  mcc_part_view part;
  mcc_piece_view piece;
} sheet;

static void make_arrays(void) {
  uint32_t* to = indices;
  uint32_t i;
  for (i = 0; i < kWedges; ++i) {
    const uint32_t x = i % kSide;
    const uint32_t y = i / kSide;
    positions[i][0] = (float)x, positions[i][1] = (float)y, positions[i][2] = (float)(x * y % 3);
    normals[i][2] = 1;
    colors[i][0] = (uint8_t)i, colors[i][3] = 255;
    if (x + 1 == kSide || y + 1 == kSide) continue;
    *to++ = i, *to++ = i + 1, *to++ = i + kSide;
    *to++ = i + 1, *to++ = i + kSide + 1, *to++ = i + kSide;
  }
}

static void make_sheet(sheet* s) {
  const mcc_attribute_format position = {MCC_POSITION, 0, MCC_FLOAT32, 3, 0, 0};
  const mcc_attribute_format normal = {MCC_NORMAL, 0, MCC_FLOAT32, 3, 0, 0};
  const mcc_attribute_format color = {MCC_COLOR, 0, MCC_UINT8, 4, 1, 0};
  memset(s, 0, sizeof *s);
  s->attributes[kPosition].format = position;
  s->attributes[kPosition].data = positions;
  s->attributes[kPosition].stride_bytes = sizeof positions[0];
  s->attributes[kPosition].quantization_bits = 12;
  s->attributes[kNormal].format = normal;
  s->attributes[kNormal].data = normals;
  s->attributes[kNormal].stride_bytes = sizeof normals[0];
  s->attributes[kNormal].quantization_bits = 8;
  s->attributes[kColor].format = color;
  s->attributes[kColor].data = colors;
  s->attributes[kColor].stride_bytes = sizeof colors[0];
  s->part.indices = indices;
  s->part.index_count = 3 * kTriangles;
  s->piece.wedge_count = kWedges;
  s->piece.attributes = s->attributes;
  s->piece.attribute_count = kAttributes;
  s->piece.parts = &s->part;
  s->piece.part_count = 1;
}

/* Returns the error of encoding, and releases what was made. On an error nothing may be made. */
static int32_t error_of(const sheet* s, const mcc_encode_options* options) {
  mcc_encoding* encoding = (mcc_encoding*)(void*)indices;
  const mcc_status status = mcc_encode(&s->piece, 1, options, &encoding);
  if ((encoding == NULL) != (status.error != MCC_OK) || status.what == NULL) return -1;
  mcc_encoding_release(encoding);
  return status.error;
}

static void test_numbers_of_attributes(void) {
  static const member kMembers[] = {
      {"semantic", offsetof(mcc_attribute_view, format.semantic), MCC_CUSTOM},
      {"set_index", offsetof(mcc_attribute_view, format.set_index), 255},
      {"component_type", offsetof(mcc_attribute_view, format.component_type), MCC_FLOAT32},
      {"component_count", offsetof(mcc_attribute_view, format.component_count), 16},
      {"normalized", offsetof(mcc_attribute_view, format.normalized), 1},
      {"morph_target", offsetof(mcc_attribute_view, format.morph_target), 65535},
  };
  sheet s;
  size_t m;
  size_t i;
  make_sheet(&s);
  EXPECT(error_of(&s, NULL) == MCC_OK);
  for (m = 0; m < COUNT_OF(kMembers); ++m) {
    for (i = 0; i < COUNT_OF(kWild); ++i) {
      if (kWild[i] <= kMembers[m].most) continue;
      make_sheet(&s);
      set(&s.attributes[kColor], kMembers[m].offset, kWild[i]);
      EXPECT_OF(error_of(&s, NULL) == MCC_ERROR_BAD_ARGUMENT, kMembers[m].name, kWild[i]);
      EXPECT_OF(mcc_element_bytes(&s.attributes[kColor].format) == 0, kMembers[m].name, kWild[i]);
    }
  }
  for (i = 0; i <= 18; ++i) { /* components: 1 to 4, 9 or 16 */
    const int is_count = (i >= 1 && i <= 4) || i == 9 || i == 16;
    make_sheet(&s);
    s.attributes[kColor].format.component_count = (uint32_t)i;
    EXPECT_OF((mcc_element_bytes(&s.attributes[kColor].format) != 0) == is_count, "count", i);
    if (!is_count) EXPECT_OF(error_of(&s, NULL) == MCC_ERROR_BAD_ARGUMENT, "component_count", i);
  }
  for (i = 0; i < COUNT_OF(kWild); ++i) {
    make_sheet(&s);
    s.attributes[kPosition].quantization_bits = kWild[i];
    EXPECT_OF(error_of(&s, NULL) == (kWild[i] <= 24 ? MCC_OK : MCC_ERROR_BAD_ARGUMENT),
              "bits of positions", kWild[i]);
    make_sheet(&s);
    s.attributes[kNormal].quantization_bits = kWild[i];
    EXPECT_OF(
        error_of(&s, NULL) == (kWild[i] >= 2 && kWild[i] <= 16 ? MCC_OK : MCC_ERROR_BAD_ARGUMENT),
        "bits of normals", kWild[i]);
  }
}

/* Strides and counts that overflow, and null where something is counted. */
static void test_memory_of_pieces(void) {
  sheet s;
  mcc_encoding* encoding = NULL;
  size_t a;
  size_t i;
  for (a = 0; a < kAttributes; ++a) {
    for (i = 0; i < COUNT_OF(kBeyond); ++i) {
      make_sheet(&s);
      s.attributes[a].stride_bytes = kBeyond[i];
      EXPECT_OF(error_of(&s, NULL) == MCC_ERROR_BAD_ARGUMENT, "stride", i);
    }
    for (i = 0; i < 4; ++i) { /* smaller than an element */
      make_sheet(&s);
      s.attributes[a].stride_bytes = i;
      EXPECT_OF(error_of(&s, NULL) == MCC_ERROR_BAD_ARGUMENT, "stride", i);
    }
    make_sheet(&s);
    s.attributes[a].stride_bytes = (size_t)PTRDIFF_MAX / (kWedges - 1) + 1;
    EXPECT_OF(error_of(&s, NULL) == MCC_ERROR_BAD_ARGUMENT, "stride", PTRDIFF_MAX / (kWedges - 1));
    make_sheet(&s);
    s.attributes[a].data = NULL;
    EXPECT_OF(error_of(&s, NULL) == MCC_ERROR_BAD_ARGUMENT, "null", a);
    make_sheet(&s); /* the stride from a single element leads nowhere */
    s.attributes[a].stride_bytes = SIZE_MAX;
    s.piece.wedge_count = 1;
    s.part.index_count = 0;
    s.piece.attribute_count = a + 1;
    EXPECT_OF(a != 0 || error_of(&s, NULL) == MCC_OK, "one wedge", a);
  }
  for (i = 0; i < COUNT_OF(kBeyond); ++i) {
    make_sheet(&s);
    s.piece.attribute_count = kBeyond[i];
    EXPECT_OF(error_of(&s, NULL) == MCC_ERROR_BAD_ARGUMENT, "attribute_count", i);
    make_sheet(&s);
    s.piece.part_count = kBeyond[i];
    EXPECT_OF(error_of(&s, NULL) == MCC_ERROR_BAD_ARGUMENT, "part_count", i);
    make_sheet(&s);
    s.part.index_count = kBeyond[i];
    EXPECT_OF(error_of(&s, NULL) != MCC_OK, "index_count", i);
    make_sheet(&s);
    s.part.indices = NULL;
    s.part.index_count = kBeyond[i];
    EXPECT_OF(error_of(&s, NULL) != MCC_OK, "index_count", i);
    make_sheet(&s);
    EXPECT_OF(mcc_encode(&s.piece, kBeyond[i], NULL, &encoding).error == MCC_ERROR_BAD_ARGUMENT,
              "piece_count", i);
    EXPECT_OF(mcc_encode(NULL, kBeyond[i], NULL, &encoding).error == MCC_ERROR_BAD_ARGUMENT,
              "piece_count", i);
    EXPECT(encoding == NULL);
  }
  for (i = 1; i < 9; ++i) {
    make_sheet(&s);
    s.part.index_count = 3 * kTriangles - i;
    EXPECT_OF(error_of(&s, NULL) == (i % 3 == 0 ? MCC_OK : MCC_ERROR_BAD_ARGUMENT), "indices", i);
  }
  /* What a piece cannot have is refused before it is read: it is not there. */
  for (i = 0; i < 3; ++i) {
    static const uint32_t kMuch[] = {1u << 28, (1u << 28) + 1, UINT32_MAX};
    make_sheet(&s);
    s.piece.wedge_count = kMuch[i];
    EXPECT_OF(error_of(&s, NULL) == MCC_ERROR_LIMIT, "wedge_count", kMuch[i]);
    make_sheet(&s);
    s.part.index_count = 3 * (size_t)kMuch[i];
    EXPECT_OF(error_of(&s, NULL) == MCC_ERROR_LIMIT, "index_count", kMuch[i]);
  }
  make_sheet(&s);
  s.piece.attributes = NULL;
  EXPECT(error_of(&s, NULL) == MCC_ERROR_BAD_ARGUMENT);
  make_sheet(&s);
  s.piece.parts = NULL;
  EXPECT(error_of(&s, NULL) == MCC_ERROR_BAD_ARGUMENT);
  make_sheet(&s);
  s.piece.part_count = 0;
  EXPECT(error_of(&s, NULL) == MCC_ERROR_BAD_ARGUMENT);
  make_sheet(&s);
  s.piece.attribute_count = 0;
  EXPECT(error_of(&s, NULL) == MCC_ERROR_BAD_ARGUMENT);
  EXPECT(mcc_encode(&s.piece, 0, NULL, &encoding).error == MCC_ERROR_BAD_ARGUMENT);
  EXPECT(mcc_encode(&s.piece, 1, NULL, NULL).error == MCC_ERROR_BAD_ARGUMENT);
}

/* Options of every length. They come from programs of other versions, whose structs end after a
 * whole member, so a length within one is refused. */
#define EXPECT_LENGTHS(Type, init, call)                                           \
  do {                                                                             \
    union {                                                                        \
      Type options;                                                                \
      uint8_t bytes[sizeof(Type) + 32];                                            \
    } u;                                                                           \
    size_t known;                                                                  \
    for (known = 0; known <= sizeof u; ++known) {                                  \
      const int fits = known >= sizeof(size_t) && known % sizeof(void*) == 0;      \
      size_t i;                                                                    \
      memset(&u, 0xa5, sizeof u);                                                  \
      init(&u.options, known);                                                     \
      i = known < sizeof(Type) ? known : sizeof(Type);                             \
      while (i < sizeof u && u.bytes[i] == 0xa5) ++i;                              \
      EXPECT_OF(i == sizeof u, #init, known);                                      \
      u.options.struct_bytes = known;                                              \
      EXPECT_OF((call) == (fits ? MCC_OK : MCC_ERROR_BAD_ARGUMENT), #init, known); \
    }                                                                              \
    u.options.struct_bytes = SIZE_MAX;                                             \
    EXPECT_OF((call) == MCC_ERROR_BAD_ARGUMENT, #init, known);                     \
    init(NULL, sizeof u.options);                                                  \
  } while (0)

static void test_options_of_the_writer(void) {
  static const member kMembers[] = {
      {"keep_vertex_order", offsetof(mcc_encode_options, keep_vertex_order), 1},
      {"keep_triangle_order", offsetof(mcc_encode_options, keep_triangle_order), 1},
      {"prefer", offsetof(mcc_encode_options, prefer), MCC_PREFER_SPEED},
  };
  mcc_encode_options options;
  sheet s;
  size_t m;
  size_t i;
  make_sheet(&s);
  for (m = 0; m < COUNT_OF(kMembers); ++m) {
    for (i = 0; i < COUNT_OF(kWild); ++i) {
      mcc_encode_options_init(&options, sizeof options);
      set(&options, kMembers[m].offset, kWild[i]);
      EXPECT_OF(error_of(&s, &options) ==
                    (kWild[i] <= kMembers[m].most ? MCC_OK : MCC_ERROR_BAD_ARGUMENT),
                kMembers[m].name, kWild[i]);
    }
  }
  for (i = 0; i < COUNT_OF(kWild); ++i) { /* any number is one of triangles */
    mcc_encode_options_init(&options, sizeof options);
    options.block_triangles = kWild[i];
    EXPECT_OF(error_of(&s, &options) == MCC_OK, "block_triangles", kWild[i]);
  }
  EXPECT_LENGTHS(mcc_encode_options, mcc_encode_options_init, error_of(&s, &u.options));
}

static void* take(void* user, size_t bytes) {
  (void)user;
  return malloc(bytes);
}
static void give_back(void* user, void* memory, size_t bytes) {
  (void)user;
  (void)bytes;
  free(memory);
}

static int32_t error_of_open(const void* bytes, size_t byte_count, uint64_t payload_bytes,
                             const mcc_open_options* options) {
  mcc_payload* payload = (mcc_payload*)(void*)indices;
  const mcc_status status =
      mcc_payload_open_prefix(bytes, byte_count, payload_bytes, options, &payload);
  if ((payload == NULL) != (status.error != MCC_OK)) return -1;
  mcc_payload_close(payload);
  return status.error;
}

static void test_opening(const uint8_t* bytes, size_t byte_count) {
  mcc_open_options options;
  mcc_payload* payload = NULL;
  size_t i;
  EXPECT(error_of_open(bytes, byte_count, byte_count, NULL) == MCC_OK);
  for (i = 0; i < COUNT_OF(kBeyond); ++i) {
    EXPECT_OF(error_of_open(NULL, kBeyond[i], byte_count, NULL) == MCC_ERROR_BAD_ARGUMENT, "null",
              i);
    EXPECT_OF(error_of_open(bytes, SIZE_MAX - (i << 40), UINT64_MAX, NULL) != MCC_OK, "bytes", i);
    EXPECT_OF(error_of_open(bytes, byte_count, kBeyond[i], NULL) != MCC_OK, "payload_bytes", i);
    EXPECT_OF(error_of_open(bytes, byte_count, i, NULL) != MCC_OK, "payload_bytes", i);
  }
  EXPECT(error_of_open(NULL, 0, 0, NULL) == MCC_ERROR_BAD_MAGIC);
  EXPECT(error_of_open(bytes, 0, 0, NULL) == MCC_ERROR_BAD_MAGIC);
  EXPECT(mcc_payload_open(bytes, byte_count, NULL, NULL).error == MCC_ERROR_BAD_ARGUMENT);
  EXPECT_LENGTHS(mcc_open_options, mcc_open_options_init,
                 error_of_open(bytes, byte_count, byte_count, &u.options));
  for (i = 0; i < 4; ++i) { /* one function of an allocator, both or none */
    mcc_open_options_init(&options, sizeof options);
    options.allocator.allocate = (i & 1) != 0 ? take : NULL;
    options.allocator.release = (i & 2) != 0 ? give_back : NULL;
    EXPECT_OF(error_of_open(bytes, byte_count, byte_count, &options) ==
                  (i == 0 || i == 3 ? MCC_OK : MCC_ERROR_BAD_ARGUMENT),
              "allocator", i);
  }
  for (i = 0; i < 6; ++i) { /* limits of 0 */
    mcc_open_options_init(&options, sizeof options);
    if (i == 0) options.max_vertices = 0;
    if (i == 1) options.max_triangles = 0;
    if (i == 2) options.max_elements = 0;
    if (i == 3) options.max_output_bytes = 0;
    if (i == 4) options.max_attributes = 0;
    if (i == 5) options.max_pieces = 0;
    EXPECT_OF(error_of_open(bytes, byte_count, byte_count, &options) == MCC_ERROR_LIMIT, "limit",
              i);
  }
  EXPECT(mcc_payload_open(bytes, byte_count, NULL, &payload).error == MCC_OK);
  EXPECT(mcc_payload_extend(NULL, bytes, byte_count).error == MCC_ERROR_BAD_ARGUMENT);
  EXPECT(mcc_payload_extend(payload, NULL, 1).error == MCC_ERROR_BAD_ARGUMENT);
  EXPECT(mcc_payload_extend(payload, bytes, SIZE_MAX).error == MCC_ERROR_BAD_ARGUMENT);
  mcc_payload_close(payload);
}

typedef struct target {
  mcc_attribute_target attributes[kAttributes];
  mcc_part_target part;
  mcc_piece_target piece;
} target;

static uint8_t room[kAttributes + 1][4096];

static void make_target(target* t) {
  size_t a;
  for (a = 0; a < kAttributes; ++a) {
    t->attributes[a].data = room[a];
    t->attributes[a].stride_bytes = 16;
  }
  t->part.indices = room[kAttributes];
  t->part.index_bytes = 4;
  t->piece.attributes = t->attributes;
  t->piece.attribute_count = kAttributes;
  t->piece.parts = &t->part;
  t->piece.part_count = 1;
}

static void test_decoding(const mcc_payload* payload) {
  static const uint32_t kIndexBytes[] = {0, 3, 5, 6, 8, 255, 256, 257, 258, 260, UINT32_MAX};
  mcc_decode_options options;
  target t;
  size_t a;
  size_t i;
  const int32_t bad = MCC_ERROR_BAD_ARGUMENT;
  make_target(&t);
  EXPECT(mcc_payload_decode(payload, &t.piece, 1, NULL).error == MCC_OK);
  for (i = 0; i < COUNT_OF(kBeyond); ++i) {
    for (a = 0; a < kAttributes; ++a) {
      make_target(&t);
      t.attributes[a].stride_bytes = kBeyond[i];
      EXPECT_OF(mcc_payload_decode(payload, &t.piece, 1, NULL).error == bad, "stride", i);
      t.attributes[a].data = NULL; /* nothing is stored there */
      EXPECT_OF(mcc_payload_decode(payload, &t.piece, 1, NULL).error == MCC_OK, "no data", i);
      make_target(&t);
      t.attributes[a].stride_bytes = i % 4;
      EXPECT_OF(mcc_payload_decode(payload, &t.piece, 1, NULL).error == bad, "stride", i);
      make_target(&t);
      t.attributes[a].data = (void*)(UINTPTR_MAX - 16 * i);
      EXPECT_OF(mcc_payload_decode(payload, &t.piece, 1, NULL).error == bad, "address", i);
    }
    make_target(&t);
    t.piece.attribute_count = kBeyond[i];
    EXPECT_OF(mcc_payload_decode(payload, &t.piece, 1, NULL).error == bad, "attribute_count", i);
    make_target(&t);
    t.piece.part_count = kBeyond[i];
    EXPECT_OF(mcc_payload_decode(payload, &t.piece, 1, NULL).error == bad, "part_count", i);
    make_target(&t);
    EXPECT_OF(mcc_payload_decode(payload, &t.piece, kBeyond[i], NULL).error == bad, "targets", i);
    EXPECT_OF(mcc_payload_decode(payload, NULL, kBeyond[i], NULL).error == bad, "targets", i);
    t.part.indices = (void*)(UINTPTR_MAX - 4 * i);
    EXPECT_OF(mcc_payload_decode(payload, &t.piece, 1, NULL).error == bad, "address", i);
  }
  for (i = 0; i < COUNT_OF(kIndexBytes); ++i) {
    make_target(&t);
    t.part.index_bytes = kIndexBytes[i];
    EXPECT_OF(mcc_payload_decode(payload, &t.piece, 1, NULL).error == bad, "index_bytes",
              kIndexBytes[i]);
  }
  make_target(&t);
  t.piece.attributes = NULL;
  EXPECT(mcc_payload_decode(payload, &t.piece, 1, NULL).error == bad);
  make_target(&t);
  t.piece.parts = NULL;
  EXPECT(mcc_payload_decode(payload, &t.piece, 1, NULL).error == bad);
  make_target(&t);
  EXPECT(mcc_payload_decode(payload, &t.piece, 0, NULL).error == bad);
  EXPECT(mcc_payload_decode(NULL, &t.piece, 1, NULL).error == bad);
  EXPECT_LENGTHS(mcc_decode_options, mcc_decode_options_init,
                 mcc_payload_decode(payload, &t.piece, 1, &u.options).error);
  for (i = 1; i < 3; ++i) {
    mcc_decode_options_init(&options, sizeof options);
    options.allocator.allocate = i == 1 ? take : NULL;
    options.allocator.release = i == 2 ? give_back : NULL;
    EXPECT_OF(mcc_payload_decode(payload, &t.piece, 1, &options).error == bad, "allocator", i);
  }
}

/* Questions about what is not there. The payload has one piece of one part, and no blocks. */
static void test_questions(mcc_payload* payload) {
  static const uint32_t kNumbers[] = {0, 1, 2, 3, 255, 256, 65536, 0x7fffffff, UINT32_MAX};
  mcc_piece_info piece = {sizeof piece, 0, 0, 0, 0};
  mcc_attribute_info attribute;
  mcc_block_info block;
  target t;
  uint32_t count = 0;
  size_t i;
  size_t k;
  const int32_t bad = MCC_ERROR_BAD_ARGUMENT;
  attribute.struct_bytes = sizeof attribute;
  block.struct_bytes = sizeof block;
  make_target(&t);
  for (i = 0; i < COUNT_OF(kNumbers); ++i) {
    const uint32_t n = kNumbers[i];
    EXPECT_OF((mcc_payload_piece(payload, n, &piece).error == bad) == (n >= 1), "piece", n);
    EXPECT_OF(mcc_payload_piece(NULL, n, &piece).error == bad, "piece", n);
    EXPECT_OF(mcc_payload_piece(payload, n, NULL).error == bad, "piece", n);
    for (k = 0; k < COUNT_OF(kNumbers); ++k) {
      const uint32_t j = kNumbers[k];
      EXPECT_OF((mcc_payload_attribute(payload, n, j, &attribute).error == bad) ==
                    (n >= 1 || j >= kAttributes),
                "attribute", j);
      EXPECT_OF((mcc_payload_part(payload, n, j, &count).error == bad) == (n >= 1 || j >= 1),
                "part", j);
      EXPECT_OF(mcc_payload_block_part(payload, n, j, &count).error == bad, "block_part", j);
    }
    EXPECT_OF(mcc_payload_attribute(payload, 0, n, NULL).error == bad, "attribute", n);
    EXPECT_OF(mcc_payload_attribute(NULL, 0, n, &attribute).error == bad, "attribute", n);
    EXPECT_OF(mcc_payload_part(payload, 0, n, NULL).error == bad, "part", n);
    EXPECT_OF(mcc_payload_part(NULL, 0, n, &count).error == bad, "part", n);
    EXPECT_OF(mcc_payload_block(payload, n, &block).error == bad, "block", n);
    EXPECT_OF(mcc_payload_block(NULL, n, &block).error == bad, "block", n);
    EXPECT_OF(mcc_payload_block(payload, n, NULL).error == bad, "block", n);
    EXPECT_OF(mcc_payload_decode_block(payload, n, &t.piece, NULL).error == bad, "block", n);
    EXPECT_OF(mcc_payload_decode_block(payload, n, NULL, NULL).error == bad, "block", n);
    EXPECT_OF(mcc_payload_decode_block(NULL, n, &t.piece, NULL).error == bad, "block", n);
    EXPECT_OF(mcc_encoding_source_wedges(NULL, n, NULL) == NULL, "encoding", n);
  }
  EXPECT(mcc_payload_prime(payload, NULL, NULL).error == bad);
  EXPECT(mcc_payload_prime(payload, &t.piece, NULL).error == bad);
  EXPECT(mcc_payload_prime(NULL, &t.piece, NULL).error == bad);
  EXPECT(mcc_payload_block_count(payload) == 0 && mcc_payload_block_count(NULL) == 0);
  EXPECT(mcc_payload_loaded_block_count(NULL) == 0 && mcc_payload_piece_count(NULL) == 0);
  EXPECT(mcc_encoding_payload(NULL, NULL) == NULL && mcc_element_bytes(NULL) == 0);
  mcc_payload_close(NULL);
  mcc_encoding_release(NULL);
}

/* Every status has a text, whatever is in it. */
/* Limits, shapes and sizes that cannot be; arrays that are null or shorter than the bound. */
static void test_meshlets(void) {
  static mcc_meshlet meshlets[kTriangles];
  static uint32_t vertices[3 * kTriangles];
  static uint8_t triangles[6 * kTriangles];
  const mcc_triangle_list good_list = {indices, 4, kTriangles, kWedges};
  const mcc_meshlet_target good = {meshlets, vertices, triangles,
                                   mcc_meshlet_bound(kTriangles, NULL)};
  mcc_triangle_list list = good_list;
  mcc_meshlet_target target = good;
  mcc_meshlet_sizes used;
  mcc_meshlet_options options;
  size_t i;
  EXPECT(mcc_build_meshlets(&list, &target, &used, NULL).error == MCC_OK);
  EXPECT(used.meshlet_count != 0);
  EXPECT(mcc_build_meshlets(NULL, &target, &used, NULL).error == MCC_ERROR_BAD_ARGUMENT);
  EXPECT(mcc_build_meshlets(&list, NULL, &used, NULL).error == MCC_ERROR_BAD_ARGUMENT);
  EXPECT(mcc_build_meshlets(&list, &target, NULL, NULL).error == MCC_ERROR_BAD_ARGUMENT);
  for (i = 0; i < COUNT_OF(kWild); ++i) {
    const uint32_t n = kWild[i];
    mcc_status status;
    mcc_meshlet_options_init(&options, sizeof options);
    options.max_vertices = n;
    target.sizes = good.sizes;
    status = mcc_build_meshlets(&list, &target, &used, &options);
    EXPECT_OF((status.error == MCC_OK) == (n >= 63 && n <= 256), "max_vertices", n);
    mcc_meshlet_options_init(&options, sizeof options);
    options.shape = n;
    status = mcc_build_meshlets(&list, &target, &used, &options);
    EXPECT_OF((status.error == MCC_OK) == (n == 1), "shape", n);
    list.index_bytes = n;
    status = mcc_build_meshlets(&list, &target, &used, NULL);
    if (n > 2) EXPECT_OF(status.error == MCC_ERROR_BAD_ARGUMENT, "index_bytes", n);
    list = good_list;
    list.vertex_count = n;
    status = n < kWedges ? mcc_build_meshlets(&list, &target, &used, NULL) : status;
    if (n < kWedges) EXPECT_OF(status.error == MCC_ERROR_BAD_ARGUMENT, "vertex_count", n);
    list = good_list;
  }
  for (i = 0; i < COUNT_OF(kBeyond); ++i) {
    target.sizes.vertex_count = kBeyond[i];
    EXPECT_OF(mcc_build_meshlets(&list, &target, &used, NULL).error == MCC_ERROR_BAD_ARGUMENT,
              "vertices beyond memory", i);
    EXPECT(used.meshlet_count == 0);
    target = good;
  }
  target.triangles = NULL;
  EXPECT(mcc_build_meshlets(&list, &target, &used, NULL).error == MCC_ERROR_BAD_ARGUMENT);
  target = good;
  --target.sizes.meshlet_count;
  EXPECT(mcc_build_meshlets(&list, &target, &used, NULL).error == MCC_ERROR_BAD_ARGUMENT);
  list.triangle_count = 0x10000001;
  EXPECT(mcc_build_meshlets(&list, &good, &used, NULL).error == MCC_ERROR_LIMIT);
  mcc_meshlet_options_init(&options, sizeof options);
  options.allocator.allocate = take;
  EXPECT(mcc_build_meshlets(&good_list, &good, &used, &options).error == MCC_ERROR_BAD_ARGUMENT);
}

static void test_texts(void) {
  static const int32_t kErrors[] = {-1, 0, 4, 14, 64, 65, INT32_MAX, INT32_MIN};
  char text[8];
  size_t i;
  for (i = 0; i < COUNT_OF(kErrors); ++i) {
    const mcc_status nothing = {kErrors[i], NULL, MCC_NO_OFFSET};
    const mcc_status empty = {kErrors[i], "", UINT64_MAX - 1};
    const mcc_status much = {kErrors[i], "%s%n%s%n", 0};
    EXPECT_OF(mcc_status_text(nothing, text, sizeof text) > 0, "text", kErrors[i]);
    EXPECT_OF(mcc_status_text(empty, NULL, SIZE_MAX) > 0, "text", kErrors[i]);
    EXPECT_OF(mcc_status_text(much, text, 0) == strlen("%s%n%s%n (byte 0)"), "text", kErrors[i]);
    EXPECT_OF(mcc_status_text(much, text, sizeof text) > 8 && strcmp(text, "%s%n%s%") == 0, "text",
              kErrors[i]);
  }
}

/* Returns the error of a conversion, and releases what was made. */
static int32_t error_of_convert(const void* glb, size_t glb_bytes,
                                const mcc_convert_options* options) {
  mcc_document* document = (mcc_document*)(void*)indices;
  const mcc_status status = mcc_convert_glb(glb, glb_bytes, options, &document);
  const int is_kept = status.error == MCC_OK || status.error == MCC_ERROR_DOCUMENT;
  if ((document != NULL) != is_kept) return -1;
  mcc_document_release(document);
  return status.what != NULL && (status.error == MCC_OK) == (*status.what == 0) ? status.error : -1;
}

static void test_options_of_documents(const uint8_t* glb, size_t glb_bytes) {
  static const member kMembers[] = {
      {"position_bits", offsetof(mcc_convert_options, position_bits), 24},
      {"normal_bits", offsetof(mcc_convert_options, normal_bits), 16},
      {"texcoord_bits", offsetof(mcc_convert_options, texcoord_bits), 24},
      {"color_bits", offsetof(mcc_convert_options, color_bits), 24},
      {"tangent_bits", offsetof(mcc_convert_options, tangent_bits), 16},
      {"weight_bits", offsetof(mcc_convert_options, weight_bits), 24},
      {"lossless", offsetof(mcc_convert_options, lossless), 1},
      {"grid", offsetof(mcc_convert_options, grid), MCC_GRID_PRIMITIVE},
      {"is_error_relative", offsetof(mcc_convert_options, is_error_relative), 1},
      {"indices_only", offsetof(mcc_convert_options, indices_only), 1},
      {"keep_vertex_order", offsetof(mcc_convert_options, keep_vertex_order), 1},
      {"keep_triangle_order", offsetof(mcc_convert_options, keep_triangle_order), 1},
      {"prefer", offsetof(mcc_convert_options, prefer), MCC_PREFER_SPEED},
      {"drop_unused", offsetof(mcc_convert_options, drop_unused), 1},
      {"glb_version", offsetof(mcc_convert_options, glb_version), 3},
      {"allow_larger", offsetof(mcc_convert_options, allow_larger), 1},
  };
  const double kErrors[] = {NAN, INFINITY, -INFINITY, -1, -DBL_MIN, -DBL_MAX};
  static const float kSteps[] = {0.0f, -0.0f, -1.0f, (float)NAN, (float)INFINITY, (float)-INFINITY};
  const int32_t bad = MCC_ERROR_BAD_ARGUMENT;
  mcc_convert_options options;
  mcc_decode_glb_options decode;
  mcc_document* document = NULL;
  mcc_lattice lattice = {{0, 0, 0, 0}, 0.25f};
  size_t m;
  size_t i;
  for (m = 0; m < COUNT_OF(kMembers); ++m) {
    for (i = 0; i < COUNT_OF(kWild); ++i) {
      if (kWild[i] <= kMembers[m].most) continue;
      mcc_convert_options_init(&options, sizeof options);
      set(&options, kMembers[m].offset, kWild[i]);
      EXPECT_OF(error_of_convert(glb, glb_bytes, &options) == bad, kMembers[m].name, kWild[i]);
    }
  }
  mcc_convert_options_init(&options, sizeof options);
  options.normal_bits = 1;
  EXPECT(error_of_convert(glb, glb_bytes, &options) == bad);
  mcc_convert_options_init(&options, sizeof options);
  options.tangent_bits = 1;
  EXPECT(error_of_convert(glb, glb_bytes, &options) == bad);
  mcc_convert_options_init(&options, sizeof options);
  options.indices_only = options.drop_unused = 1;
  EXPECT(error_of_convert(glb, glb_bytes, &options) == bad);
  mcc_convert_options_init(&options, sizeof options);
  options.indices_only = options.preview_triangles = 1;
  EXPECT(error_of_convert(glb, glb_bytes, &options) == bad);
  options.indices_only = 0;
  EXPECT(error_of_convert(glb, glb_bytes, &options) == MCC_OK);
  for (i = 0; i < COUNT_OF(kErrors); ++i) {
    mcc_convert_options_init(&options, sizeof options);
    options.max_position_error = kErrors[i];
    EXPECT_OF(error_of_convert(glb, glb_bytes, &options) == bad, "max_position_error", i);
  }
  for (i = 0; i < COUNT_OF(kErrors); ++i) {
    mcc_convert_options_init(&options, sizeof options);
    options.step = kErrors[i];
    EXPECT_OF(error_of_convert(glb, glb_bytes, &options) == bad, "step", i);
  }
  for (i = 0; i < COUNT_OF(kErrors); ++i) {
    mcc_convert_options_init(&options, sizeof options);
    options.quality = kErrors[i];
    EXPECT_OF(error_of_convert(glb, glb_bytes, &options) == bad, "quality", i);
  }
  mcc_convert_options_init(&options, sizeof options);
  options.quality = 4096;
  EXPECT(error_of_convert(glb, glb_bytes, &options) == 0);
  options.step = 1;
  EXPECT(error_of_convert(glb, glb_bytes, &options) == bad);
  mcc_convert_options_init(&options, sizeof options);
  options.step = 0.3;
  EXPECT(error_of_convert(glb, glb_bytes, &options) == bad);
  options.step = 0.25;
  EXPECT(error_of_convert(glb, glb_bytes, &options) == 0);
  for (i = 0; i < COUNT_OF(kSteps); ++i) {
    mcc_convert_options_init(&options, sizeof options);
    options.position_lattice = &lattice;
    lattice.step = kSteps[i];
    EXPECT_OF(error_of_convert(glb, glb_bytes, &options) == bad, "step", i);
    lattice.step = 0.25f;
    lattice.origin[i % 3] = kSteps[3 + i % 3];
    EXPECT_OF(error_of_convert(glb, glb_bytes, &options) == bad, "origin", i);
    lattice.origin[i % 3] = 0;
  }
  for (i = 0; i < COUNT_OF(kWild); ++i) {
    if (kWild[i] <= 1) continue;
    mcc_decode_glb_options_init(&decode, sizeof decode);
    decode.decode_to = kWild[i];
    EXPECT_OF(mcc_decode_glb(glb, glb_bytes, &decode, &document).error == bad, "to integers",
              kWild[i]);
    EXPECT(document == NULL);
  }
  for (i = 0; i < 2; ++i) { /* any number is one of threads */
    mcc_convert_options_init(&options, sizeof options);
    options.thread_count = i == 0 ? 0 : UINT32_MAX;
    EXPECT_OF(error_of_convert(glb, glb_bytes, &options) == MCC_OK, "threads", i);
  }
}

static int32_t error_of_decode(const void* glb, size_t glb_bytes,
                               const mcc_decode_glb_options* options) {
  mcc_document* document = NULL;
  const mcc_status status = mcc_decode_glb(glb, glb_bytes, options, &document);
  mcc_document_release(document);
  return status.error;
}

/* The lengths of options with a document that is refused at once, since converting takes long
 * under valgrind; a length that is accepted is seen by the other error. */
static int32_t ok_if_document(int32_t error) {
  return error == MCC_ERROR_DOCUMENT ? MCC_OK : error;
}

static void test_documents(const uint8_t* glb, size_t glb_bytes) {
  static const char* const kNames[] = {
      "", "\xff", "\xc3", "a\x80z", "\xed\xa0\x80", "\xf0\x9f\x98", "\xc0\x80", "\"\\\n\x01"};
  const int32_t bad = MCC_ERROR_BAD_ARGUMENT;
  mcc_document* document = NULL;
  mcc_document* small = NULL;
  mcc_status status;
  const uint8_t* bytes;
  size_t byte_count = 1;
  size_t i;
  EXPECT_LENGTHS(mcc_convert_options, mcc_convert_options_init,
                 ok_if_document(error_of_convert("none", 4, &u.options)));
  EXPECT_LENGTHS(mcc_decode_glb_options, mcc_decode_glb_options_init,
                 ok_if_document(error_of_decode("none", 4, &u.options)));
  for (i = 0; i < COUNT_OF(kBeyond); ++i) {
    EXPECT_OF(error_of_convert(NULL, kBeyond[i], NULL) == bad, "null", i);
    EXPECT_OF(error_of_decode(NULL, kBeyond[i], NULL) == bad, "null", i);
    EXPECT_OF(mcc_inspect_glb(NULL, kBeyond[i], "", &document).error == bad, "null", i);
    EXPECT_OF(error_of_convert(glb, SIZE_MAX - (i << 40), NULL) == bad, "bytes", i);
    EXPECT_OF(error_of_decode(glb, SIZE_MAX - (i << 40), NULL) == bad, "bytes", i);
    EXPECT_OF(mcc_inspect_glb(glb, SIZE_MAX - (i << 40), "", &document).error == bad, "bytes", i);
  }
  EXPECT(mcc_convert_glb(glb, glb_bytes, NULL, NULL).error == bad);
  EXPECT(mcc_decode_glb(glb, glb_bytes, NULL, NULL).error == bad);
  EXPECT(mcc_inspect_glb(glb, glb_bytes, NULL, NULL).error == bad);
  EXPECT(error_of_convert(NULL, 0, NULL) == MCC_ERROR_DOCUMENT);
  EXPECT(error_of_decode(glb, 0, NULL) == MCC_ERROR_DOCUMENT);
  EXPECT(mcc_convert_glb(glb, glb_bytes, NULL, &small).error == MCC_OK);
  bytes = mcc_document_bytes(small, &byte_count);
  for (i = 0; i < COUNT_OF(kNames); ++i) { /* bytes that are not UTF-8 become U+FFFD */
    const char* text;
    size_t text_bytes = 0;
    size_t k;
    int is_text = 1;
    EXPECT_OF(mcc_inspect_glb(bytes, byte_count, kNames[i], &document).error == MCC_OK, "name", i);
    text = (const char*)mcc_document_bytes(document, &text_bytes);
    EXPECT_OF(text != NULL && text_bytes > 2 && text[0] == '{' && text[text_bytes - 1] == '}',
              "name", i);
    for (k = 0; k < text_bytes; ++k) is_text &= (uint8_t)text[k] < 0xf0 && text[k] != 1;
    EXPECT_OF(is_text, "name", i);
    mcc_document_release(document);
  }
  mcc_document_release(small);
  /* What a status says outlives the document, the reason does not. */
  status = mcc_decode_glb("no GLB", 6, NULL, &document);
  EXPECT(status.error == MCC_ERROR_DOCUMENT && strstr(mcc_document_message(document), "glTF"));
  mcc_document_release(document);
  EXPECT(strcmp(status.what, "the document was refused; mcc_document_message() says why") == 0);
  EXPECT(mcc_document_bytes(NULL, &byte_count) == NULL && byte_count == 0);
  EXPECT(mcc_document_bytes(NULL, NULL) == NULL && *mcc_document_message(NULL) != 0);
  mcc_document_release(NULL);
}

int test_arguments(const uint8_t* glb, size_t glb_bytes) {
  mcc_encoding* encoding = NULL;
  mcc_payload* payload = NULL;
  const uint8_t* bytes;
  size_t byte_count = 0;
  sheet s;
  make_arrays();
  make_sheet(&s);
  test_numbers_of_attributes();
  test_memory_of_pieces();
  test_options_of_the_writer();
  EXPECT(mcc_encode(&s.piece, 1, NULL, &encoding).error == MCC_OK);
  bytes = mcc_encoding_payload(encoding, &byte_count);
  test_opening(bytes, byte_count);
  EXPECT(mcc_payload_open(bytes, byte_count, NULL, &payload).error == MCC_OK);
  test_decoding(payload);
  test_questions(payload);
  mcc_payload_close(payload);
  mcc_encoding_release(encoding);
  test_meshlets();
  test_texts();
  test_options_of_documents(glb, glb_bytes);
  test_documents(glb, glb_bytes);
  printf("%d calls with arguments of all kinds, %d with a wrong outcome\n", case_count,
         failure_count);
  return failure_count;
}
