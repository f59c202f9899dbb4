/* Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
 *
 * decode_for_an_engine IN.mcc: what an engine's importer does with the bytes of a buffer view, in
 * C99: it limits what an untrusted file may ask for, counts its memory, decodes all attributes of a
 * primitive into one interleaved buffer, its triangles into indices of the smallest type, and these
 * into meshlets. The JSON, which says which view, `piece` and `part`, is the engine's part. */
#include <stdio.h>
#include <stdlib.h>

#include "mcc/c_api.h"

/* The engine's heap: counts, and gives no more than `most` bytes. One for each thread that imports.
 */
typedef struct heap {
  size_t used;
  size_t most;
} heap;

static void* take(void* user, size_t bytes) {
  heap* from = (heap*)user;
  if (bytes > from->most - from->used) return NULL;
  from->used += bytes;
  return malloc(bytes);
}

static void give_back(void* user, void* memory, size_t bytes) {
  ((heap*)user)->used -= bytes;
  free(memory);
}

/* A primitive as engines upload it. */
typedef struct mesh {
  uint32_t vertex_count;
  uint32_t triangle_count;
  uint32_t index_bytes;    /* 2 or 4 */
  size_t stride_bytes;     /* of a vertex */
  unsigned char* vertices; /* all attributes of a vertex, each at a multiple of 4 */
  void* indices;
  mcc_meshlet* meshlets;
  uint32_t* meshlet_vertices;
  uint8_t* meshlet_triangles;
  size_t meshlet_count;
} mesh;

static void release_mesh(mesh* m) {
  free(m->vertices);
  free(m->indices);
  free(m->meshlets);
  free(m->meshlet_vertices);
  free(m->meshlet_triangles);
}

static const mcc_status kNoMemory = {MCC_ERROR_OUT_OF_MEMORY, "no memory for a mesh",
                                     MCC_NO_OFFSET};

/* Lays the attributes out in a vertex; `offsets` has one for each. An importer would also store the
 * type, and find the attribute's name by the JSON. */
static mcc_status lay_out(const mcc_payload* payload, uint32_t piece, uint32_t count,
                          size_t* offsets, size_t* stride_bytes) {
  mcc_attribute_info info = {.struct_bytes = sizeof info};
  mcc_status status = {MCC_OK, "", MCC_NO_OFFSET};
  *stride_bytes = 0;
  for (uint32_t i = 0; i < count && status.error == MCC_OK; ++i) {
    status = mcc_payload_attribute(payload, piece, i, &info);
    offsets[i] = *stride_bytes;
    *stride_bytes += (mcc_element_bytes(&info.format) + 3) / 4 * 4;
  }
  return status;
}

/* Decodes piece 0 and its part 0; null targets drop other parts. */
static mcc_status decode_mesh(const mcc_payload* payload, heap* memory, mesh* m) {
  mcc_piece_info piece = {.struct_bytes = sizeof piece};
  mcc_decode_options options;
  mcc_status status = mcc_payload_piece(payload, 0, &piece);
  if (status.error != MCC_OK) return status;
  status = mcc_payload_part(payload, 0, 0, &m->triangle_count);
  if (status.error != MCC_OK) return status;
  m->vertex_count = piece.wedge_count;
  m->index_bytes = piece.wedge_count <= 65535 ? 2 : 4;

  size_t* offsets = calloc(piece.attribute_count + (size_t)1, sizeof *offsets);
  mcc_attribute_target* attributes = calloc(piece.attribute_count + (size_t)1, sizeof *attributes);
  mcc_part_target* parts = calloc(piece.part_count + (size_t)1, sizeof *parts);
  if (offsets != NULL && attributes != NULL && parts != NULL) {
    status = lay_out(payload, 0, piece.attribute_count, offsets, &m->stride_bytes);
    m->vertices = calloc(m->vertex_count + (size_t)1, m->stride_bytes + 1);
    m->indices = calloc(m->triangle_count + (size_t)1, 3 * (size_t)m->index_bytes);
  }
  if (m->vertices == NULL || m->indices == NULL) {
    status = status.error == MCC_OK ? kNoMemory : status;
  } else if (status.error == MCC_OK) {
    for (uint32_t i = 0; i < piece.attribute_count; ++i) {
      attributes[i].data = m->vertices + offsets[i];
      attributes[i].stride_bytes = m->stride_bytes;
    }
    for (uint32_t i = 0; i < piece.part_count; ++i) parts[i].index_bytes = m->index_bytes;
    parts[0].indices = m->indices;
    const mcc_piece_target target = {attributes, piece.attribute_count, parts, piece.part_count};
    mcc_decode_options_init(&options, sizeof options);
    options.allocator.allocate = take;
    options.allocator.release = give_back;
    options.allocator.user = memory;
    /* With options.run_jobs, blocks of a large mesh are decoded on the engine's job system. */
    status = mcc_payload_decode(payload, &target, 1, &options);
  }
  free(parts);
  free(attributes);
  free(offsets);
  return status;
}

/* Meshlets of 64 vertices and 124 triangles, the defaults. */
static mcc_status make_meshlets(mesh* m) {
  const mcc_meshlet_sizes most = mcc_meshlet_bound(m->triangle_count, NULL);
  const mcc_triangle_list list = {m->indices, m->index_bytes, m->triangle_count, m->vertex_count};
  mcc_meshlet_sizes used;
  m->meshlets = calloc(most.meshlet_count + 1, sizeof *m->meshlets);
  m->meshlet_vertices = calloc(most.vertex_count + 1, sizeof *m->meshlet_vertices);
  m->meshlet_triangles = calloc(most.triangle_bytes + 1, 1);
  if (!m->meshlets || !m->meshlet_vertices || !m->meshlet_triangles) return kNoMemory;
  const mcc_meshlet_target target = {m->meshlets, m->meshlet_vertices, m->meshlet_triangles, most};
  const mcc_status status = mcc_build_meshlets(&list, &target, &used, NULL);
  m->meshlet_count = used.meshlet_count;
  return status;
}

int main(int argument_count, char** arguments) {
  static unsigned char bytes[1 << 20];
  FILE* file = argument_count == 2 ? fopen(arguments[1], "rb") : NULL;
  const size_t byte_count = file != NULL ? fread(bytes, 1, sizeof bytes, file) : 0;
  heap memory = {0, (size_t)256 << 20};
  mesh m = {0};
  mcc_open_options options;
  mcc_payload* payload = NULL;
  char text[200];
  if (file != NULL) fclose(file);

  mcc_open_options_init(&options, sizeof options);
  options.max_output_bytes = (uint64_t)64 << 20; /* checked before any memory is taken */
  mcc_status status = mcc_payload_open(bytes, byte_count, &options, &payload);
  if (status.error == MCC_OK) status = decode_mesh(payload, &memory, &m);
  mcc_payload_close(payload);
  if (status.error == MCC_OK) status = make_meshlets(&m);
  if (status.error == MCC_OK) {
    printf("%u vertices of %zu bytes, %u triangles, %zu meshlets\n", m.vertex_count, m.stride_bytes,
           m.triangle_count, m.meshlet_count);
  } else {
    mcc_status_text(status, text, sizeof text);
    fprintf(stderr, "%s\n", text);
  }
  release_mesh(&m);
  return status.error == MCC_OK && memory.used == 0 ? 0 : 1;
}
