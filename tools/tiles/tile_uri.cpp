// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#include "tiles/tile_uri.h"

#include "gltf/document/package.h"
#include "host/result.h"
#include "host/text.h"
#include "tiles/file_table.h"

namespace mcc::tiles {

gltf::Result resolveTileUri(const std::string& base, std::string uri, std::string& path,
                            bool& is_remote) {
  const size_t scheme = uri.find(':');
  is_remote =
      (scheme != std::string::npos && scheme < uri.find_first_of("/?#")) || uri.starts_with("//");
  if (is_remote) return {};
  uri = uri.substr(0, uri.find_first_of("?#"));
  if (uri.empty()) return gltf::error("", "is empty");
  if (uri.starts_with('/')) return gltf::error("", "is absolute; use a relative one");
  const size_t slash = base.rfind('/');
  std::string folder;
  if (slash != std::string::npos) {
    for (const char c : base.substr(0, slash + 1)) {
      folder += c == '/' ? "/" : gltf::uriOf(std::string(1, c));
    }
  }
  std::string joined;
  MCC_GLTF_TRY(gltf::relativePathOf(folder + uri, "", joined));
  path = genericText(gltf::pathOf(joined).lexically_normal());
  return {};
}

}  // namespace mcc::tiles
