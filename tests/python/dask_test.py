# Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
"""Runs the README's recipe for many machines: dask_test.py GLTF_MCC README SAMPLES. One of two workers is killed after
the first models; in the end every model is there once, with the program's bytes. A second run does the rest. The same
for the recipe for tilesets, with samples/city."""
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

PROGRAM, README, SAMPLES = (Path(argument) for argument in sys.argv[1:])
COPIES = 6
PATH = f"{PROGRAM.resolve().parent}{os.pathsep}{os.environ['PATH']}"  # where the recipe for tilesets finds the program
ENVIRONMENT = dict(os.environ, DASK_DISTRIBUTED__DASHBOARD__LINK="", PATH=PATH)


def start(log, *command):
    return subprocess.Popen([sys.executable, *command], env=ENVIRONMENT, stdout=log, stderr=log)


def wait_until(is_so, what, seconds=120):
    for _ in range(seconds * 20):
        if is_so():
            return
        time.sleep(0.05)
    raise SystemExit(f"dask_test: {what} did not happen within {seconds} s")


def make_models(folder):
    """Copies the samples into folders of their own, and adds a file that is no GLB."""
    for k in range(COPIES):
        for sample in SAMPLES.glob("*.glb"):
            target = folder / f"set {k}" / sample.name
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(sample, target)
    (folder / "broken.glb").write_bytes(b"no GLB")


def converted(folder):
    """Returns the program's bytes for every sample, by name."""
    expected = {}
    for sample in SAMPLES.glob("*.glb"):
        subprocess.run([PROGRAM, "convert", sample, folder / sample.name], check=True, stdout=subprocess.DEVNULL)
        expected[sample.name] = (folder / sample.name).read_bytes()
    return expected


def run_recipe(recipe, address, source, target, *more, **options):
    return subprocess.Popen([sys.executable, recipe, address, source, target, *more], env=ENVIRONMENT, text=True, **options)


def files_of(folder):
    """Returns the bytes of all files in a folder and below, without the program's records."""
    paths = [path for path in folder.rglob("*") if path.is_file() and not path.name.startswith(".gltf-mcc-tiles.")]
    return {path.relative_to(folder): path.read_bytes() for path in paths}


def check_tiles(folder, address, running, start_worker):
    """Runs the recipe for tilesets; one of two workers is killed after the first files."""
    source, target = SAMPLES / "city" / "tileset.json", folder / "city-small"
    subprocess.run([PROGRAM, "tiles", "-q", source, folder / "city-plain"], check=True)
    expected = files_of(folder / "city-plain")
    recipe = folder / "compress_tileset.py"
    recipe.write_text(re.search(r"```python\n(import subprocess\n.*?)```", README.read_text(), re.DOTALL).group(1))
    worker = start_worker()
    job = run_recipe(recipe, address, source, target, "40", stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    running.append(job)
    wait_until(lambda: target.exists() and len(files_of(target)) >= 3, "the first tiles")
    worker.kill()
    killed_after = len(files_of(target))
    out, err = job.communicate(timeout=200)
    assert job.returncode == 0 and "failed: none" in out, (out, err)
    assert files_of(target) == expected
    assert killed_after < len(expected), "the worker was killed too late to prove anything"
    print(f"dask: a tileset of {len(expected)} files in 40 parts, one worker killed after {killed_after} files")


def address_in(path):
    """The scheduler's address, or nothing as long as its file is missing or not yet written to its end."""
    found = re.search(r'"address": "([^"]+)"', path.read_text()) if path.exists() else None
    return found and found.group(1)


def main(folder):
    source, target, plain = folder / "models", folder / "models-small", folder / "plain"
    plain.mkdir()
    make_models(source)
    expected = converted(plain)
    recipe = folder / "compress_folder.py"
    recipe.write_text(re.search(r"```python\n(import os\n.*?)```", README.read_text(), re.DOTALL).group(1))
    running = []
    log = open(folder / "dask.log", "w+")
    try:
        # The scheduler writes its address, with a port that was free, into a file.
        running.append(start(log, "-m", "distributed.cli.dask_scheduler", "--host", "127.0.0.1", "--port", "0",
                             "--no-dashboard", "--no-show", "--scheduler-file", str(folder / "scheduler.json")))
        address_file = folder / "scheduler.json"
        wait_until(lambda: address_in(address_file), "the scheduler's start")
        address = address_in(address_file)

        def start_worker():
            running.append(start(log, "-m", "distributed.cli.dask_worker", address, "--nthreads", "1", "--no-nanny",
                                 "--no-dashboard", "--local-directory", str(folder)))
            return running[-1]

        for _ in range(2):
            start_worker()
        job = run_recipe(recipe, address, source, target, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        running.append(job)
        wait_until(lambda: len(list(target.rglob("*.glb"))) >= 3, "the first models")
        running[1].kill()
        killed_after = len(list(target.rglob("*.glb")))
        out, err = job.communicate(timeout=200)
        check(out, err, job.returncode, source, target, expected)
        assert killed_after < len(expected) * COPIES, "the worker was killed too late to prove anything"
        # A run that was stopped goes on where it ended.
        lost = next(target.rglob("*.glb"))
        lost.unlink()
        times = {path: path.stat().st_mtime_ns for path in target.rglob("*.glb")}
        job = run_recipe(recipe, address, source, target, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        running.append(job)
        out, err = job.communicate(timeout=200)
        check(out, err, job.returncode, source, target, expected)
        assert all(path.stat().st_mtime_ns == changed for path, changed in times.items())
        print(f"dask: {len(times) + 1} models, one worker killed after {killed_after}")
        check_tiles(folder, address, running, start_worker)
    except BaseException:
        log.seek(0)
        sys.stderr.write(log.read()[-4000:])
        raise
    finally:
        for process in reversed(running):
            process.kill()
            process.wait()


def check(out, err, status, source, target, expected):
    assert status == 1, (status, out, err)  # one file is no GLB
    assert "1 failed" in out and "broken.glb: " in err and "neither a GLB nor JSON" in err, (out, err)
    made = {path.relative_to(target) for path in target.rglob("*.glb")}
    wanted = {path.relative_to(source) for path in source.rglob("*.glb")} - {Path("broken.glb")}
    assert made == wanted, made ^ wanted
    for path in made:
        assert (target / path).read_bytes() == expected[path.name], path


with tempfile.TemporaryDirectory() as scratch:
    main(Path(scratch))
