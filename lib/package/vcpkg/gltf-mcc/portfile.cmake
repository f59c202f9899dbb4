# Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#
# vcpkg install gltf-mcc --overlay-ports=lib/package/vcpkg, with the environment variable
# GLTF_MCC_TARBALL: the path of a tarball of the sources (git archive), which
# --keep-env-vars=GLTF_MCC_TARBALL lets through.
vcpkg_extract_source_archive(SOURCE_PATH ARCHIVE "$ENV{GLTF_MCC_TARBALL}")
vcpkg_check_features(OUT_FEATURE_OPTIONS features INVERTED_FEATURES gltf MCC_READER_ONLY)
vcpkg_cmake_configure(SOURCE_PATH "${SOURCE_PATH}"
                      OPTIONS ${features} -DMCC_INSTALL=ON -DMCC_TOOLS=OFF -DMCC_TESTS=OFF -DMCC_FOREIGN=OFF)
vcpkg_cmake_install()
vcpkg_cmake_config_fixup(CONFIG_PATH lib/cmake/gltf-mcc)
vcpkg_fixup_pkgconfig()
file(REMOVE_RECURSE "${CURRENT_PACKAGES_DIR}/debug/include" "${CURRENT_PACKAGES_DIR}/debug/share")
vcpkg_install_copyright(FILE_LIST "${SOURCE_PATH}/LICENSE")
