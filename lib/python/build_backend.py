# Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
"""Makes the wheel of gltf_mcc: for pip, which calls the hooks of PEP 517 and gets the package alone, and for
tools/build-wheel, which adds the shared libraries: build_backend.py FOLDER LIBRARY... prints the path of the wheel. The
same input gives the same bytes.
"""
import base64
import hashlib
import io
import platform
import runpy
import sys
import sysconfig
import tarfile
import zipfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
VERSION = runpy.run_path(str(HERE / "gltf_mcc/_version.py"))["VERSION"]
NAME = f"gltf_mcc-{VERSION}"
METADATA = f"""Metadata-Version: 2.1
Name: gltf-mcc
Version: {VERSION}
Summary: Compresses and decompresses glTF meshes with KHR_mesh_collapse_compression
Keywords: glTF,mesh,compression
License: Apache-2.0
Requires-Python: >=3.8
Provides-Extra: numpy
Requires-Dist: numpy; extra == "numpy"
Description-Content-Type: text/markdown

"""


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    return write_wheel(Path(wheel_directory), package_files(), "any")


def build_editable(wheel_directory, config_settings=None, metadata_directory=None):
    return write_wheel(Path(wheel_directory), {"gltf_mcc.pth": f"{HERE}\n".encode()}, "any")


def build_sdist(sdist_directory, config_settings=None):
    files = {**package_files(), "PKG-INFO": metadata()}
    files.update((name, (HERE / name).read_bytes()) for name in ("README.md", "build_backend.py", "pyproject.toml"))
    files.update(licence())
    with tarfile.open(Path(sdist_directory, f"{NAME}.tar.gz"), "w:gz", format=tarfile.PAX_FORMAT) as archive:
        for name, content in sorted(files.items()):
            entry = tarfile.TarInfo(f"{NAME}/{name}")
            entry.size = len(content)
            archive.addfile(entry, io.BytesIO(content))
    return f"{NAME}.tar.gz"


def package_files():
    """Returns the contents of the package's files by their names in a wheel."""
    paths = [*HERE.glob("gltf_mcc/*.py"), HERE / "gltf_mcc/py.typed"]
    return {path.relative_to(HERE).as_posix(): path.read_bytes() for path in paths}


def metadata():
    return METADATA.encode() + (HERE / "README.md").read_bytes()


def licence():
    """Returns the licence by its name: of the tree, or of what build_sdist() made of this folder."""
    paths = [path for path in (HERE / "LICENSE", HERE.parent.parent / "LICENSE") if path.exists()]
    return {"LICENSE": paths[0].read_bytes()} if paths else {}


def platform_tag():
    """Returns the tag of the systems that run what was built on this one: those whose C library is not older, since a
    library asks for no newer symbols than there were where it was linked."""
    tag = sysconfig.get_platform().replace("-", "_").replace(".", "_")
    libc, version = platform.libc_ver()
    if tag.startswith("linux_") and libc == "glibc":
        major, minor = version.split(".")[:2]
        return f"manylinux_{major}_{minor}_{tag[len('linux_'):]}"
    return tag


def write_wheel(folder, files, platform_name):
    """Writes a wheel, and returns its name."""
    tag = f"py3-none-{platform_name}"
    info = f"{NAME}.dist-info"
    is_pure = "true" if platform_name == "any" else "false"
    files = dict(sorted(files.items()))
    files[f"{info}/METADATA"] = metadata()
    files[f"{info}/WHEEL"] = (f"Wheel-Version: 1.0\nGenerator: gltf-mcc\nRoot-Is-Purelib: {is_pure}\n"
                              f"Tag: {tag}\n").encode()
    files.update((f"{info}/{name}", content) for name, content in licence().items())
    record = "".join(f"{name},sha256={digest(content)},{len(content)}\n" for name, content in files.items())
    files[f"{info}/RECORD"] = f"{record}{info}/RECORD,,\n".encode()
    wheel = f"{NAME}-{tag}.whl"
    with zipfile.ZipFile(folder / wheel, "w") as archive:
        for name, content in files.items():
            entry = zipfile.ZipInfo(name, (2026, 1, 1, 0, 0, 0))
            entry.external_attr = 0o100644 << 16
            archive.writestr(entry, content, zipfile.ZIP_DEFLATED)
    return wheel


def digest(content):
    return base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode()


def main(folder, *libraries):
    files = package_files()
    files.update((f"gltf_mcc/{Path(library).name}", Path(library).read_bytes()) for library in libraries)
    Path(folder).mkdir(parents=True, exist_ok=True)
    print(Path(folder, write_wheel(Path(folder), files, platform_tag())))


if __name__ == "__main__":
    main(*sys.argv[1:])
