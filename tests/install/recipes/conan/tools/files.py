# Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
import os
import shutil
import tarfile


def unzip(recipe, filename, destination, strip_root=False):
    with tarfile.open(filename) as archive:
        for member in archive.getmembers():
            if strip_root:
                member.name = "/".join(member.name.split("/")[1:])
            archive.extract(member, destination)


def copy(recipe, pattern, source, destination):
    os.makedirs(destination, exist_ok=True)
    shutil.copy(os.path.join(source, pattern), destination)


def rmdir(recipe, folder):
    shutil.rmtree(folder, ignore_errors=True)
