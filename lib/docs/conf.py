# Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
"""Settings of Sphinx for the site that tools/docs makes."""
import logging
import os
import re
import sys

root = os.environ["MCC_ROOT"]
sys.path.insert(0, os.path.join(root, "lib/python"))

project = "gltf-mcc"
copyright = "2026 The gltf-mcc authors"
version = release = os.environ["MCC_VERSION"]
html_theme = "furo"
html_title = f"gltf-mcc {version}"
html_show_sphinx = False
html_copy_source = False
extensions = ["myst_parser", "breathe", "sphinx.ext.autodoc"]
myst_heading_anchors = 6  # as links from page to page have them
breathe_projects = {"gltf-mcc": os.path.join(root, "build/docs/xml")}
breathe_default_project = "gltf-mcc"
breathe_domain_by_extension = {"h": "cpp"}
breathe_domain_by_file_pattern = {"*/c_api.h": "c"}
autodoc_mock_imports = ["gltf_mcc._library"]  # it loads the shared library
autodoc_typehints = "description"
suppress_warnings = ["misc.highlighting_failure"]  # JSON with "..." in it is not coloured


class KnownDuplicates(logging.Filter):
    """Breathe declares a namespace on the page of each header that opens it, and Sphinx warns of the second one."""

    def filter(self, record):
        return not re.search(r"Duplicate C\+\+ declaration.*'\.\. cpp:type:: mcc(::\w+)*'", record.getMessage(), re.DOTALL)


logging.getLogger("sphinx.sphinx.domains.cpp").addFilter(KnownDuplicates())
