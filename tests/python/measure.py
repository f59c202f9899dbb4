# Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
"""measure.py GLTF_MCC FILE.glb...: prints, for each file, its bytes and those of the compressed one, and the seconds that
gltf_mcc.convert() and gltf_mcc.decode() take on one thread, the best of five, next to those of the program; as a table in
Markdown. Run it with PYTHONPATH=lib/python and GLTF_MCC_LIBRARY=build/release/lib/libgltf-mcc.so."""
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import gltf_mcc

RUNS = 5


def seconds(work):
    def once():
        begin = time.perf_counter()
        work()
        return time.perf_counter() - begin
    return min(once() for _ in range(RUNS))


def run(program, *arguments):
    subprocess.run([program, *map(str, arguments)], check=True, stdout=subprocess.DEVNULL)


program, *files = sys.argv[1:]
print("| model | bytes | compressed | `convert()`, s | the program, s | `decode()`, s | the program, s |\n|---|---:|---:|---:|---:|---:|---:|")
for path in map(Path, files):
    small = gltf_mcc.convert(path)
    with tempfile.TemporaryDirectory() as folder:
        out, back = Path(folder, "out.glb"), Path(folder, "back.glb")
        times = [seconds(lambda: gltf_mcc.convert(path)), seconds(lambda: run(program, "convert", "-q", path, out)),
                 seconds(lambda: gltf_mcc.decode(small)), seconds(lambda: run(program, "decode", "-q", out, back))]
    print(f"| {path.stem} | {path.stat().st_size:,} | {len(small):,} | " + " | ".join(f"{t:.3f}" for t in times) + " |")
