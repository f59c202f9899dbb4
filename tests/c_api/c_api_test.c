/* Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
 *
 * The C API from C99: c_api_test GLB. Prints what failed; status 0 when nothing did. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "arguments_test.h"
#include "mcc/c_api.h"

static int failure_count = 0;

static void expect(int condition, const char* text, int line) {
  if (condition) return;
  ++failure_count;
  fprintf(stderr, "line %d: %s\n", line, text);
}
#define EXPECT(condition) expect((condition), #condition, __LINE__)

/* A sheet of triangles with float positions and bytes of colours, interleaved. */
enum { kSide = 21, kWedges = kSide * kSide, kTriangles = 2 * (kSide - 1) * (kSide - 1) };

typedef struct vertex {
  float position[3];
  uint8_t color[4];
} vertex;

static vertex vertices[kWedges];
static uint32_t indices[3 * kTriangles];

static void make_sheet(void) {
  uint32_t* to = indices;
  uint32_t x;
  uint32_t y;
  for (y = 0; y < kSide; ++y) {
    for (x = 0; x < kSide; ++x) {
      const vertex v = {{(float)x, (float)y, (float)(x * y % 7)}, {(uint8_t)x, (uint8_t)y, 0, 255}};
      const uint32_t i = y * kSide + x;
      vertices[i] = v;
      if (x + 1 == kSide || y + 1 == kSide) continue;
      *to++ = i, *to++ = i + 1, *to++ = i + kSide;
      *to++ = i + 1, *to++ = i + kSide + 1, *to++ = i + kSide;
    }
  }
}

static mcc_status encode_sheet(const mcc_encode_options* options, mcc_encoding** encoding) {
  const mcc_attribute_format position = {MCC_POSITION, 0, MCC_FLOAT32, 3, 0, 0};
  const mcc_attribute_format color = {MCC_COLOR, 0, MCC_UINT8, 4, 1, 0};
  mcc_attribute_view attributes[2];
  const mcc_part_view part = {indices, 3 * kTriangles};
  mcc_piece_view piece;
  memset(attributes, 0, sizeof attributes);
  attributes[0].format = position;
  attributes[0].data = vertices[0].position;
  attributes[0].stride_bytes = sizeof(vertex);
  attributes[1].format = color;
  attributes[1].data = vertices[0].color;
  attributes[1].stride_bytes = sizeof(vertex);
  piece.wedge_count = kWedges;
  piece.attributes = attributes;
  piece.attribute_count = 2;
  piece.parts = &part;
  piece.part_count = 1;
  return mcc_encode(&piece, 1, options, encoding);
}

/* An allocator that counts memory and can run out of it. */
typedef struct purse {
  size_t used;
  size_t most;
} purse;

static void* take(void* user, size_t bytes) {
  purse* from = (purse*)user;
  if (from->used + bytes > from->most) return NULL;
  from->used += bytes;
  return malloc(bytes);
}

static void give_back(void* user, void* memory, size_t bytes) {
  ((purse*)user)->used -= bytes;
  free(memory);
}

static int stop_at_once(void* user, double done) {
  *(double*)user = done;
  return 0;
}

static vertex decoded[kWedges];

/* Decodes into `decoded` and `target_indices`, which may be null. */
static mcc_status decode_sheet(const mcc_payload* payload, void* target_indices,
                               uint32_t index_bytes, const mcc_decode_options* options) {
  mcc_attribute_target attributes[2];
  mcc_part_target part;
  mcc_piece_target piece;
  attributes[0].data = decoded[0].position;
  attributes[1].data = decoded[0].color;
  attributes[0].stride_bytes = attributes[1].stride_bytes = sizeof(vertex);
  part.indices = target_indices;
  part.index_bytes = index_bytes;
  piece.attributes = attributes;
  piece.attribute_count = 2;
  piece.parts = &part;
  piece.part_count = 1;
  return mcc_payload_decode(payload, &piece, 1, options);
}

/* Meshlets of a list are its triangles again: each once, with its corners in their order. */
static void test_meshlets(const uint32_t* list) {
  enum { kMost = kTriangles };
  static mcc_meshlet meshlets[kMost];
  static uint32_t meshlet_vertices[3 * kTriangles];
  static uint8_t meshlet_triangles[6 * kTriangles];
  static uint8_t seen[kTriangles];
  const mcc_triangle_list triangles = {list, 4, kTriangles, kWedges};
  const mcc_meshlet_sizes sizes = mcc_meshlet_bound(kTriangles, NULL);
  const mcc_meshlet_target target = {meshlets, meshlet_vertices, meshlet_triangles, sizes};
  mcc_meshlet_sizes used;
  size_t found = 0;
  size_t i;
  uint32_t t;
  uint32_t u;
  EXPECT(sizes.meshlet_count <= kMost && sizes.triangle_bytes <= sizeof meshlet_triangles);
  EXPECT(mcc_build_meshlets(&triangles, &target, &used, NULL).error == MCC_OK);
  EXPECT(used.meshlet_count >= kTriangles / 124 && used.meshlet_count < kTriangles / 60);
  memset(seen, 0, sizeof seen);
  for (i = 0; i < used.meshlet_count; ++i) {
    const uint32_t* corners = meshlet_vertices + meshlets[i].vertex_offset;
    const uint8_t* local = meshlet_triangles + meshlets[i].triangle_offset;
    EXPECT(meshlets[i].vertex_count <= 64 && meshlets[i].triangle_count <= 124);
    for (t = 0; t < meshlets[i].triangle_count; ++t, local += 3) {
      for (u = 0; u < kTriangles; ++u) {
        if (list[3 * u] == corners[local[0]] && list[3 * u + 1] == corners[local[1]] &&
            list[3 * u + 2] == corners[local[2]] && !seen[u]) {
          seen[u] = 1;
          ++found;
        }
      }
    }
  }
  EXPECT(found == kTriangles);
}

static void test_round_trip(const mcc_encoding* encoding) {
  size_t byte_count = 0;
  size_t wedge_count = 0;
  const uint8_t* bytes = mcc_encoding_payload(encoding, &byte_count);
  const uint32_t* source = mcc_encoding_source_wedges(encoding, 0, &wedge_count);
  static uint16_t short_indices[3 * kTriangles];
  static uint32_t long_indices[3 * kTriangles];
  mcc_payload* payload = NULL;
  mcc_piece_info piece;
  mcc_attribute_info attribute;
  uint32_t triangle_count = 0;
  size_t i;
  EXPECT(wedge_count == kWedges);
  EXPECT(mcc_encoding_source_wedges(encoding, 1, &wedge_count) == NULL && wedge_count == 0);
  EXPECT(mcc_payload_open(bytes, byte_count, NULL, &payload).error == MCC_OK);
  EXPECT(mcc_payload_piece_count(payload) == 1);
  piece.struct_bytes = sizeof piece;
  attribute.struct_bytes = sizeof attribute;
  EXPECT(mcc_payload_piece(payload, 0, &piece).error == MCC_OK);
  EXPECT(mcc_payload_piece(payload, 1, &piece).error == MCC_ERROR_BAD_ARGUMENT);
  EXPECT(piece.wedge_count == kWedges && piece.attribute_count == 2 && piece.part_count == 1);
  EXPECT(mcc_payload_attribute(payload, 0, 1, &attribute).error == MCC_OK);
  EXPECT(attribute.format.semantic == MCC_COLOR && attribute.format.normalized == 1);
  EXPECT(mcc_element_bytes(&attribute.format) == 4 && attribute.coding == MCC_CODING_INTEGER);
  EXPECT(mcc_payload_attribute(payload, 0, 2, &attribute).error == MCC_ERROR_BAD_ARGUMENT);
  EXPECT(mcc_payload_part(payload, 0, 0, &triangle_count).error == MCC_OK);
  EXPECT(triangle_count == kTriangles);
  EXPECT(mcc_payload_part(payload, 0, 1, &triangle_count).error == MCC_ERROR_BAD_ARGUMENT);

  EXPECT(decode_sheet(payload, long_indices, 4, NULL).error == MCC_OK);
  for (i = 0; i < kWedges; ++i)
    EXPECT(memcmp(&decoded[i], &vertices[source[i]], sizeof(vertex)) == 0);
  test_meshlets(long_indices);
  EXPECT(decode_sheet(payload, short_indices, 2, NULL).error == MCC_OK);
  for (i = 0; i < 3 * kTriangles; ++i) EXPECT(short_indices[i] == long_indices[i]);
  EXPECT(decode_sheet(payload, short_indices, 1, NULL).error == MCC_ERROR_BAD_ARGUMENT);
  EXPECT(decode_sheet(payload, short_indices, 3, NULL).error == MCC_ERROR_BAD_ARGUMENT);
  EXPECT(decode_sheet(payload, NULL, 4, NULL).error == MCC_OK);
  EXPECT(mcc_payload_decode(payload, NULL, 0, NULL).error == MCC_ERROR_BAD_ARGUMENT);
  EXPECT(mcc_payload_decode(NULL, NULL, 0, NULL).error == MCC_ERROR_BAD_ARGUMENT);
  mcc_payload_close(payload);
}

static void test_options(const mcc_encoding* encoding) {
  size_t byte_count = 0;
  const uint8_t* bytes = mcc_encoding_payload(encoding, &byte_count);
  purse memory = {0, 1u << 20};
  double done = 0;
  mcc_payload* payload = NULL;
  mcc_open_options open;
  mcc_decode_options decode;
  mcc_open_options_init(&open, sizeof open);
  EXPECT(open.struct_bytes == sizeof open && open.max_vertices == (uint64_t)1 << 28);
  open.allocator.allocate = take;
  open.allocator.release = give_back;
  open.allocator.user = &memory;
  open.max_triangles = kTriangles - 1;
  EXPECT(mcc_payload_open(bytes, byte_count, &open, &payload).error == MCC_ERROR_LIMIT);
  EXPECT(payload == NULL && memory.used == 0);
  open.max_triangles = kTriangles;
  EXPECT(mcc_payload_open(bytes, byte_count, &open, &payload).error == MCC_OK);
  EXPECT(memory.used != 0);

  mcc_decode_options_init(&decode, sizeof decode);
  decode.allocator = open.allocator;
  decode.progress = stop_at_once;
  decode.progress_user = &done;
  EXPECT(decode_sheet(payload, NULL, 4, &decode).error == MCC_ERROR_CANCELLED);
  EXPECT(done > 0 && done < 1);
  decode.progress = NULL;
  EXPECT(decode_sheet(payload, NULL, 4, &decode).error == MCC_OK);
  memory.most = memory.used + 16;
  EXPECT(decode_sheet(payload, NULL, 4, &decode).error == MCC_ERROR_OUT_OF_MEMORY);
  mcc_payload_close(payload);
  EXPECT(memory.used == 0);
}

/* Programs compiled against another version pass shorter or longer structures. */
static void test_structures_grow(const mcc_encoding* encoding) {
  size_t byte_count = 0;
  const uint8_t* bytes = mcc_encoding_payload(encoding, &byte_count);
  mcc_payload* payload = NULL;
  struct {
    mcc_open_options options;
    uint64_t later;
  } longer;
  struct {
    size_t struct_bytes;
    uint64_t max_vertices;
  } shorter;
  longer.later = 42;
  mcc_open_options_init(&longer.options, sizeof longer);
  EXPECT(longer.later == 42 && longer.options.struct_bytes == sizeof longer);
  EXPECT(mcc_payload_open(bytes, byte_count, &longer.options, &payload).error == MCC_OK);
  mcc_payload_close(payload);
  mcc_open_options_init((mcc_open_options*)(void*)&shorter, sizeof shorter);
  EXPECT(shorter.struct_bytes == sizeof shorter && shorter.max_vertices == (uint64_t)1 << 28);
  EXPECT(mcc_payload_open(bytes, byte_count, (mcc_open_options*)(void*)&shorter, &payload).error ==
         MCC_OK);
  mcc_payload_close(payload);
  longer.options.struct_bytes = 0;
  EXPECT(mcc_payload_open(bytes, byte_count, &longer.options, &payload).error ==
         MCC_ERROR_BAD_ARGUMENT);
}

/* Whether all bytes from `from` on are still those that memset() put there. */
enum { kUntouched = 0xa5 };
static int is_untouched(const void* memory, size_t from, size_t to) {
  const uint8_t* bytes = (const uint8_t*)memory;
  for (; from < to; ++from) {
    if (bytes[from] != kUntouched) return 0;
  }
  return 1;
}

/* Whether what follows struct_bytes is what the whole structure holds, as far as `to`. */
static int is_filled(const void* memory, const void* whole, size_t to) {
  const size_t from = sizeof(size_t);
  return memcmp((const uint8_t*)memory + from, (const uint8_t*)whole + from, to - from) == 0;
}

/* Information goes into structures of every length, and nothing beyond it is written. */
static void test_information_grows(const mcc_encoding* encoding) {
  size_t byte_count = 0;
  const uint8_t* bytes = mcc_encoding_payload(encoding, &byte_count);
  mcc_payload* payload = NULL;
  mcc_piece_info whole_piece = {sizeof whole_piece, 0, 0, 0, 0};
  mcc_attribute_info whole_attribute;
  union {
    mcc_piece_info info;
    uint8_t bytes[sizeof(mcc_piece_info) + 16];
  } piece;
  union {
    mcc_attribute_info info;
    uint8_t bytes[sizeof(mcc_attribute_info) + 16];
  } attribute;
  size_t known; /* what the program knows */
  /* Padding comes after the members. */
  const size_t members = offsetof(mcc_attribute_info, lattice) + sizeof(mcc_lattice);
  EXPECT(mcc_payload_open(bytes, byte_count, NULL, &payload).error == MCC_OK);
  EXPECT(mcc_payload_piece(payload, 0, &whole_piece).error == MCC_OK);
  EXPECT(whole_piece.struct_bytes == sizeof whole_piece && whole_piece.part_count == 1);
  for (known = 0; known <= sizeof piece; ++known) {
    const size_t written = known < sizeof piece.info ? known : sizeof piece.info;
    const int is_set = known >= sizeof known;
    memset(&piece, kUntouched, sizeof piece);
    piece.info.struct_bytes = known;
    EXPECT(mcc_payload_piece(payload, 0, &piece.info).error ==
           (is_set ? MCC_OK : MCC_ERROR_BAD_ARGUMENT));
    EXPECT(piece.info.struct_bytes == known);
    EXPECT(is_untouched(&piece, is_set ? written : sizeof known, sizeof piece));
    EXPECT(!is_set || is_filled(&piece, &whole_piece, written));
  }
  memset(&whole_attribute, 0, sizeof whole_attribute);
  whole_attribute.struct_bytes = sizeof whole_attribute;
  EXPECT(mcc_payload_attribute(payload, 0, 0, &whole_attribute).error == MCC_OK);
  EXPECT(whole_attribute.struct_bytes == sizeof whole_attribute &&
         whole_attribute.format.component_count == 3);
  for (known = 0; known <= sizeof attribute; ++known) {
    const size_t written = known < sizeof attribute.info ? known : sizeof attribute.info;
    const int is_set = known >= sizeof known;
    memset(&attribute, kUntouched, sizeof attribute);
    attribute.info.struct_bytes = known;
    EXPECT(mcc_payload_attribute(payload, 0, 0, &attribute.info).error ==
           (is_set ? MCC_OK : MCC_ERROR_BAD_ARGUMENT));
    EXPECT(attribute.info.struct_bytes == known);
    EXPECT(is_untouched(&attribute, is_set ? written : sizeof known, sizeof attribute));
    EXPECT(!is_set ||
           is_filled(&attribute, &whole_attribute, written < members ? written : members));
  }
  mcc_payload_close(payload);
}

static void test_damage(const mcc_encoding* encoding) {
  size_t byte_count = 0;
  const uint8_t* bytes = mcc_encoding_payload(encoding, &byte_count);
  uint8_t* copy = (uint8_t*)malloc(byte_count);
  char text[64];
  mcc_payload* payload = NULL;
  mcc_status status;
  memcpy(copy, bytes, byte_count);
  copy[byte_count / 2] ^= 1;
  status = mcc_payload_open(copy, byte_count, NULL, &payload);
  EXPECT(status.error == MCC_ERROR_BAD_CHECKSUM && payload == NULL);
  EXPECT(mcc_status_text(status, NULL, 0) == mcc_status_text(status, text, sizeof text));
  EXPECT(strstr(text, "checksum") != NULL);
  EXPECT(mcc_status_text(status, NULL, 5) == strlen(text));
  EXPECT(mcc_status_text(status, text, 1) > 1 && text[0] == 0);
  EXPECT(mcc_payload_open(bytes, 5, NULL, &payload).error == MCC_ERROR_TRUNCATED);
  EXPECT(mcc_payload_open(bytes, byte_count, NULL, NULL).error == MCC_ERROR_BAD_ARGUMENT);
  mcc_payload_close(NULL);
  free(copy);
}

static void test_encoder_refuses(void) {
  mcc_encoding* encoding = NULL;
  mcc_encode_options options;
  const uint32_t kept = indices[0];
  indices[0] = kWedges;
  EXPECT(encode_sheet(NULL, &encoding).error == MCC_ERROR_BAD_ARGUMENT && encoding == NULL);
  indices[0] = kept;
  mcc_encode_options_init(&options, sizeof options);
  options.prefer = MCC_PREFER_SPEED + 1;
  EXPECT(encode_sheet(&options, &encoding).error == MCC_ERROR_BAD_ARGUMENT);
  options.prefer = MCC_PREFER_SPEED;
  EXPECT(encode_sheet(&options, &encoding).error == MCC_OK);
  mcc_encoding_release(encoding);
  EXPECT(mcc_encode(NULL, 1, NULL, &encoding).error == MCC_ERROR_BAD_ARGUMENT);
  mcc_encoding_release(NULL);
}

/* Steps and origins that no lattice has. */
static const float kOdd[] = {0.0f, -1.0f, -0.0f, (float)NAN, (float)INFINITY, (float)-INFINITY};
enum { kOddCount = sizeof kOdd / sizeof kOdd[0], kOddSteps = kOddCount, kOddOriginsFrom = 3 };

static mcc_status encode_on(const mcc_lattice* lattice, mcc_encoding** encoding) {
  const mcc_attribute_format position = {MCC_POSITION, 0, MCC_FLOAT32, 3, 0, 0};
  mcc_attribute_view attribute;
  const mcc_part_view part = {indices, 3 * kTriangles};
  const mcc_piece_view piece = {kWedges, &attribute, 1, &part, 1};
  memset(&attribute, 0, sizeof attribute);
  attribute.format = position;
  attribute.data = vertices[0].position;
  attribute.stride_bytes = sizeof(vertex);
  attribute.quantization_bits = 14;
  attribute.lattice = lattice;
  return mcc_encode(&piece, 1, NULL, encoding);
}

static void test_lattices(const uint8_t* glb, size_t glb_bytes) {
  mcc_convert_options options;
  mcc_encoding* encoding = NULL;
  mcc_document* document = NULL;
  mcc_lattice lattice = {{0, 0, 0, 0}, 0.25f};
  size_t i;
  EXPECT(encode_on(&lattice, &encoding).error == MCC_OK);
  mcc_encoding_release(encoding);
  mcc_convert_options_init(&options, sizeof options);
  options.position_lattice = &lattice;
  for (i = 0; i < kOddSteps; ++i) {
    lattice.step = kOdd[i];
    EXPECT(encode_on(&lattice, &encoding).error == MCC_ERROR_BAD_ARGUMENT && encoding == NULL);
    EXPECT(mcc_convert_glb(glb, glb_bytes, &options, &document).error == MCC_ERROR_BAD_ARGUMENT);
  }
  lattice.step = 0.25f;
  for (i = kOddOriginsFrom; i < kOddCount; ++i) {
    lattice.origin[i % 3] = kOdd[i];
    EXPECT(encode_on(&lattice, &encoding).error == MCC_ERROR_BAD_ARGUMENT && encoding == NULL);
    EXPECT(mcc_convert_glb(glb, glb_bytes, &options, &document).error == MCC_ERROR_BAD_ARGUMENT);
    lattice.origin[i % 3] = 0;
  }
}

/* Null pointers, and counts that do not match the payload: the arrays must not be read. */
static void test_wrong_targets(const mcc_encoding* encoding) {
  size_t byte_count = 0;
  const uint8_t* bytes = mcc_encoding_payload(encoding, &byte_count);
  mcc_payload* payload = NULL;
  mcc_piece_target target = {NULL, 2, NULL, 1};
  EXPECT(mcc_payload_open(bytes, byte_count, NULL, &payload).error == MCC_OK);
  EXPECT(mcc_payload_decode(payload, NULL, 1, NULL).error == MCC_ERROR_BAD_ARGUMENT);
  EXPECT(mcc_payload_decode(payload, &target, 1, NULL).error == MCC_ERROR_BAD_ARGUMENT);
  target.attributes = (const mcc_attribute_target*)(const void*)bytes;
  target.attribute_count = (size_t)-1;
  EXPECT(mcc_payload_decode(payload, &target, 1, NULL).error == MCC_ERROR_BAD_ARGUMENT);
  EXPECT(mcc_payload_decode(payload, &target, (size_t)-1, NULL).error == MCC_ERROR_BAD_ARGUMENT);
  EXPECT(mcc_payload_decode(NULL, &target, 1, NULL).error == MCC_ERROR_BAD_ARGUMENT);
  EXPECT(mcc_payload_piece(payload, 0, NULL).error == MCC_ERROR_BAD_ARGUMENT);
  EXPECT(mcc_payload_attribute(payload, 0, 0, NULL).error == MCC_ERROR_BAD_ARGUMENT);
  EXPECT(mcc_payload_part(payload, 0, 0, NULL).error == MCC_ERROR_BAD_ARGUMENT);
  EXPECT(mcc_payload_piece_count(NULL) == 0 && mcc_element_bytes(NULL) == 0);
  mcc_payload_close(payload);
}

static void test_documents(const char* path) {
  FILE* file = fopen(path, "rb");
  static uint8_t glb[1 << 20];
  const size_t glb_bytes = file == NULL ? 0 : fread(glb, 1, sizeof glb, file);
  size_t small_bytes = 0;
  size_t back_bytes = 0;
  mcc_convert_options options;
  mcc_decode_glb_options decode_options;
  mcc_document* small = NULL;
  mcc_document* back = NULL;
  const uint8_t* bytes;
  const char* text;
  if (file != NULL) fclose(file);
  EXPECT(glb_bytes != 0);
  failure_count += test_arguments(glb, glb_bytes);
  test_lattices(glb, glb_bytes);
  mcc_convert_options_init(&options, sizeof options);
  EXPECT(options.position_bits == 14);
  options.normal_bits = 1;
  EXPECT(mcc_convert_glb(glb, glb_bytes, &options, &small).error == MCC_ERROR_BAD_ARGUMENT);
  options.normal_bits = 8;
  options.prefer = MCC_PREFER_SPEED + 1;
  EXPECT(mcc_convert_glb(glb, glb_bytes, &options, &small).error == MCC_ERROR_BAD_ARGUMENT);
  options.prefer = MCC_PREFER_SIZE;
  EXPECT(mcc_convert_glb(glb, glb_bytes, &options, &small).error == MCC_OK);
  EXPECT(strcmp(mcc_document_message(small), "") == 0);
  bytes = mcc_document_bytes(small, &small_bytes);
  EXPECT(bytes != NULL && small_bytes < glb_bytes / 2);
  mcc_decode_glb_options_init(&decode_options, sizeof decode_options);
  decode_options.thread_count = 2;
  EXPECT(mcc_decode_glb(bytes, small_bytes, &decode_options, &back).error == MCC_OK);
  EXPECT(mcc_document_bytes(back, &back_bytes) != NULL && back_bytes > small_bytes);
  mcc_document_release(back);
  decode_options.max_decoded_bytes = 1;
  EXPECT(mcc_decode_glb(bytes, small_bytes, &decode_options, &back).error == MCC_ERROR_DOCUMENT);
  EXPECT(strstr(mcc_document_message(back), "max_decoded_bytes") != NULL);
  mcc_document_release(back);
  mcc_convert_options_init(&options, sizeof options);
  options.max_decoded_bytes = 1;
  EXPECT(mcc_convert_glb(bytes, small_bytes, &options, &back).error == MCC_ERROR_DOCUMENT);
  mcc_document_release(back);
  EXPECT(mcc_inspect_glb(bytes, small_bytes, "a name", &back).error == MCC_OK);
  text = (const char*)mcc_document_bytes(back, &back_bytes);
  EXPECT(text != NULL && text[0] == '{' && text[back_bytes - 1] == '}');
  mcc_document_release(back);
  EXPECT(mcc_inspect_glb("no GLB", 6, NULL, &back).error == MCC_ERROR_DOCUMENT);
  EXPECT(mcc_document_bytes(back, &back_bytes) == NULL && strlen(mcc_document_message(back)) > 10);
  mcc_document_release(back);
  mcc_document_release(small);
  EXPECT(mcc_decode_glb("no GLB", 6, NULL, &back).error == MCC_ERROR_DOCUMENT);
  EXPECT(mcc_document_bytes(back, &back_bytes) == NULL && strlen(mcc_document_message(back)) > 10);
  mcc_document_release(back);
}

int main(int argument_count, char** arguments) {
  mcc_encoding* encoding = NULL;
  make_sheet();
  EXPECT(argument_count == 2 && strlen(mcc_version()) >= 5);
  EXPECT(encode_sheet(NULL, &encoding).error == MCC_OK);
  test_round_trip(encoding);
  test_options(encoding);
  test_structures_grow(encoding);
  test_information_grows(encoding);
  test_damage(encoding);
  test_encoder_refuses();
  test_wrong_targets(encoding);
  mcc_encoding_release(encoding);
  test_documents(arguments[1]);
  return failure_count == 0 ? 0 : 1;
}
