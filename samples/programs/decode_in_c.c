/* Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
 *
 * decode_in_c IN.mcc: decodes the positions and triangles of a payload's first piece, in C99. */
#include <stdio.h>
#include <stdlib.h>

#include "mcc/c_api.h"

static int failed(mcc_status status) {
  char text[200];
  mcc_status_text(status, text, sizeof text);
  fprintf(stderr, "%s\n", text);
  return 1;
}

int main(int argument_count, char** arguments) {
  static unsigned char bytes[1 << 20];
  FILE* file = argument_count == 2 ? fopen(arguments[1], "rb") : NULL;
  const size_t byte_count = file != NULL ? fread(bytes, 1, sizeof bytes, file) : 0;
  if (file != NULL) fclose(file);

  mcc_payload* payload = NULL;
  mcc_status status = mcc_payload_open(bytes, byte_count, NULL, &payload);
  if (status.error != MCC_OK) return failed(status);

  mcc_piece_info piece = {.struct_bytes = sizeof piece};
  uint32_t triangle_count = 0;
  mcc_payload_piece(payload, 0, &piece);
  mcc_payload_part(payload, 0, 0, &triangle_count);

  /* Zeros drop an attribute or a part. Attribute 0, if there is one, is POSITION. */
  mcc_attribute_target* attributes = calloc(piece.attribute_count + 1, sizeof *attributes);
  mcc_part_target* parts = calloc(piece.part_count, sizeof *parts);
  float* positions = calloc(piece.wedge_count, 3 * sizeof(float));
  uint32_t* indices = calloc(triangle_count, 3 * sizeof(uint32_t));
  if (!attributes || !parts || !positions || !indices) return 1;
  attributes[0].data = positions;
  attributes[0].stride_bytes = 3 * sizeof(float);
  for (uint32_t i = 0; i < piece.part_count; ++i) parts[i].index_bytes = 4;
  parts[0].indices = indices;
  const mcc_piece_target target = {attributes, piece.attribute_count, parts, piece.part_count};
  status = mcc_payload_decode(payload, &target, 1, NULL); /* one target per piece */
  if (status.error != MCC_OK) return failed(status);
  const float* first = positions + 3 * (size_t)indices[0];
  printf("%u vertices, %u triangles, the first at (%.3f, %.3f, %.3f)\n", piece.wedge_count,
         triangle_count, first[0], first[1], first[2]);

  mcc_payload_close(payload);
  free(indices);
  free(positions);
  free(parts);
  free(attributes);
  return 0;
}
