# Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
"""What tools/release says about the packages that it makes. In a tree where all of them were built:

inventory.py notices BUILD         the licences of others whose code or headers what was built in BUILD was made of
inventory.py files PACKAGE...      the files inside of packages
inventory.py spdx NAME PACKAGE...  an SPDX document of packages and of what of others they hold or are linked to

Whose code that is, is not written down here but found: headers by ninja's record of what was read, shared libraries by the programs'
own lists, and both by the Debian packages that they come from. Only licences are listed here; without one, there is no release.
"""
import datetime
import hashlib
import json
import os
import re
import subprocess
import sys
import tarfile
import tempfile
import zipfile
from pathlib import Path

# By Debian's name of the source, as far as it gets into programs: /usr/share/doc/*/copyright has the texts.
LICENCES = {
    "brotli": "MIT",
    "cli11": "BSD-3-Clause",
    "draco": "Apache-2.0",
    "fmtlib": "MIT",
    "gcc-12": "GPL-3.0-or-later WITH GCC-exception-3.1",
    "glibc": "LGPL-2.1-or-later",
    "libzstd": "BSD-3-Clause OR GPL-2.0-only",
    "llvm-toolchain-14": "Apache-2.0 WITH LLVM-exception",
    "meshoptimizer": "MIT",
    "nlohmann-json3": "MIT",
    "tinygltf": "MIT",
    "wasi-libc": "(Apache-2.0 WITH LLVM-exception OR Apache-2.0 OR MIT) AND MIT AND BSD-2-Clause AND CC0-1.0",
}
# Their headers declare what the system has. The exception of gcc's library allows what is compiled of it into programs.
SYSTEM = {"gcc-12", "glibc", "linux"}
OURS = "Apache-2.0"
# A library that the compiler links by itself leaves no trace among the headers: WebAssembly has the compiler's.
LINKED_TO_WEB = "/usr/lib/llvm-14/lib/clang/14.0.6/lib/wasi/libclang_rt.builtins-wasm32.a"


def output_of(*command):
    return subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True).stdout


def owners(files):
    """Returns (Debian package, its source, version of the source) of those that files come from."""
    packages, left = set(), set(files)
    for spelled in (os.path.realpath, str):  # dpkg knows some by a link
        if not left:
            break
        known = {spelled(file): file for file in left}
        found = subprocess.run(["dpkg", "-S", *known], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True).stdout
        for package, file in re.findall(r"^(.*?)(?:, .*)?: (/.*)$", found, re.M):
            packages.add(package)
            left.discard(known[file])
    if left:
        sys.exit(f"tools/release: no package of Debian has {min(left)}, so its licence is not known")
    form = "${Package} ${source:Package} ${source:Version}\n"
    return {tuple(line.split()) for line in output_of("dpkg-query", "-W", "-f", form, *packages).splitlines()} if packages else set()


def compiled_in(build, folders=""):
    """Returns the owners of the headers of others that objects in these folders of a build were made of."""
    headers = set()
    for record in output_of("ninja", "-C", build, "-t", "deps").split("\n\n"):
        if re.match(folders, record):
            headers.update(line.strip() for line in record.split("\n")[1:] if line.startswith("    /usr/"))
    if "wasi" in "".join(headers):
        headers.add(LINKED_TO_WEB)
    return sorted(entry for entry in owners(headers) if entry[1] not in SYSTEM)


def notices(build):
    """Returns the texts of the licences of what is compiled in, one for each source."""
    sources = {source: (package, version) for package, source, version in compiled_in(build)}
    return "".join(f"\n{'=' * 80}\nMade with code or headers of {source} {version}:\n\n"
                   + Path(f"/usr/share/doc/{package}/copyright").read_text()
                   for source, (package, version) in sorted(sources.items()))


def unpacked(package, folder):
    """Unpacks a package of any kind into a folder and returns its files, sorted."""
    if package.suffix == ".deb":
        subprocess.run(["dpkg-deb", "-x", package, folder], check=True)
    elif package.suffix in (".whl", ".zip"):
        zipfile.ZipFile(package).extractall(folder)
    else:
        tarfile.open(package).extractall(folder)
    return sorted(path for path in Path(folder).rglob("*") if not path.is_dir())


def linked_to(files):
    """Returns the owners of the shared libraries of others that these files name."""
    names = set()
    for file in files:
        if file.is_symlink() or file.open("rb").read(4) != b"\x7fELF":
            continue
        names.update(re.findall(r"\(NEEDED\).*\[(.*)\]", output_of("readelf", "-d", file)))
    known = dict(reversed(re.findall(r"^\s(\S+) .* => (\S+)$", output_of("/sbin/ldconfig", "-p"), re.M)))
    return owners(known[name] for name in names if not name.startswith("libgltf-mcc"))


def files_of(packages):
    text = ""
    for package in map(Path, packages):
        with tempfile.TemporaryDirectory() as folder:
            files = unpacked(package, folder)
            text += f"{package.name}: {len(files)} files\n"
            for file in files:
                size = f"-> {os.readlink(file)}" if file.is_symlink() else file.stat().st_size
                text += f"  {file.relative_to(folder)} {size}\n"
    return text


def holds(package):
    """Returns the owners of what is compiled into a package of ours."""
    if package.suffix == ".tgz":
        return compiled_in("build/web")
    if package.name.startswith("gltf-mcc_"):
        return compiled_in("build/release")
    return [] if package.name.endswith(".tar.gz") else compiled_in("build/release", "lib/")


def described(identifier, name, version, licence, **more):
    """Returns a package as SPDX describes it."""
    return {"SPDXID": identifier, "name": name, "versionInfo": version, "downloadLocation": "NOASSERTION", "filesAnalyzed": False,
            "licenseDeclared": licence, "licenseConcluded": licence, "copyrightText": "NOASSERTION", **more}


def relations_of(package):
    """Returns how a package of ours is related to others: their sources, versions, and the word of SPDX."""
    if package.name.endswith(".tar.gz"):
        return {}
    with tempfile.TemporaryDirectory() as folder:
        linked = linked_to(unpacked(package, folder))
    relations = {**{entry[1:]: "STATIC_LINK" for entry in holds(package)}, **{entry[1:]: "DYNAMIC_LINK" for entry in linked}}
    unknown = sorted({source for source, _ in relations} - set(LICENCES))
    if unknown:
        sys.exit(f"tools/release: tools/release.d/inventory.py lacks the licence of {', '.join(unknown)}")
    return relations


def spdx(name, packages):
    version = name[len("gltf-mcc-"):]
    time = datetime.datetime.fromtimestamp(int(os.environ["SOURCE_DATE_EPOCH"]), datetime.timezone.utc)
    listed, others, relations = [], {}, []
    for package in map(Path, packages):
        identifier = f"SPDXRef-{re.sub('[^A-Za-z0-9.]', '-', package.name)}"
        licences = {f"{OURS} AND CC-BY-4.0" if package.name.endswith(".tar.gz") else OURS}
        relations.append(("SPDXRef-DOCUMENT", "DESCRIBES", identifier))
        for (source, source_version), relation in relations_of(package).items():
            other = f"SPDXRef-Debian-{source}"
            others[other] = source, source_version
            relations.append((identifier, relation, other))
            if relation == "STATIC_LINK":
                licences.add(LICENCES[source])
        listed.append(described(
            identifier, package.name, version, " AND ".join(sorted(licences)), packageFileName=package.name,
            supplier="Organization: The gltf-mcc authors",
            checksums=[{"algorithm": "SHA256", "checksumValue": hashlib.sha256(package.read_bytes()).hexdigest()}]))
    for identifier, (source, source_version) in sorted(others.items()):
        url = f"pkg:deb/debian/{source}@{source_version.replace(':', '%3A').replace('+', '%2B')}?arch=source&distro=bookworm"
        listed.append(described(identifier, source, source_version, LICENCES[source], externalRefs=[
            {"referenceCategory": "PACKAGE-MANAGER", "referenceType": "purl", "referenceLocator": url}]))
    return json.dumps({
        "spdxVersion": "SPDX-2.3", "dataLicense": "CC0-1.0", "SPDXID": "SPDXRef-DOCUMENT", "name": name,
        # Unique, as it has to be: the same name stands for the same packages only.
        "documentNamespace": f"urn:gltf-mcc:spdx:{hashlib.sha256(str(listed).encode()).hexdigest()}",
        "creationInfo": {"created": time.strftime("%Y-%m-%dT%H:%M:%SZ"),
                         "creators": ["Organization: The gltf-mcc authors", f"Tool: gltf-mcc-tools/release-{version}"]},
        "packages": listed,
        "relationships": [{"spdxElementId": a, "relationshipType": kind, "relatedSpdxElement": b} for a, kind, b in sorted(relations)],
    }, indent=1) + "\n"


what, *arguments = sys.argv[1:]
if what == "notices":
    print(notices(*arguments), end="")
elif what == "files":
    print(files_of(arguments), end="")
else:
    print(spdx(arguments[0], arguments[1:]), end="")
