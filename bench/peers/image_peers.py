"""Times Blum, SciPy and seung-lab's edt on the same image. Prints the ratios, and writes JSON if requested.

    python3 bench/peers/image_peers.py [--side 512] [--shape shell] [--repeat 3] [--json FILE] [--skip-scipy]

Needs NumPy, SciPy, `pip install edt`, and distance_transform_sample (BLUM_DISTANCE_TRANSFORM_SAMPLE, or below build/).
SciPy computes distances and indices, on its only thread. edt computes squared distances without indices. Blum computes
distances and closest voxels. Reading and writing of files are not timed. Peak memory is that of the whole process,
including the image.
"""

import argparse
import json
import multiprocessing
import os
import pathlib
import resource
import statistics
import subprocess
import sys
import tempfile
import time

import numpy

ROOT = pathlib.Path(__file__).resolve().parents[2]


def sample_program():
    named = os.environ.get("BLUM_DISTANCE_TRANSFORM_SAMPLE")
    if named:
        return named
    found = sorted(ROOT.glob("build/*/bin/distance_transform_sample"), key=os.path.getmtime)
    if not found:
        sys.exit("distance_transform_sample is not built; build it or set BLUM_DISTANCE_TRANSFORM_SAMPLE")
    return str(found[-1])


def make_image(side, shape):
    """The shapes of bench/distance_transform_bench.cpp, with another random generator."""
    mask = numpy.empty((side, side, side), dtype=bool)
    centre = (numpy.arange(side) + 0.5) / side - 0.5
    y, x = numpy.meshgrid(centre, centre, indexing="ij")
    random = numpy.random.default_rng(1)
    for k, z in enumerate(centre):
        radius = numpy.sqrt(x * x + y * y + z * z)
        if shape == "shell":
            surface = 0.33 + 0.03 * numpy.sin(11 * x) * numpy.sin(13 * y + 1) + 0.05 * numpy.sin(7 * z)
            mask[k] = numpy.abs(radius - surface) < 0.8 / side
        elif shape == "ball":
            mask[k] = radius < 0.3628
        else:
            mask[k] = random.random((side, side)) < {"random1": 0.01, "random50": 0.5}[shape]
    return mask


def measure(function):
    """Wall-clock and CPU seconds of a call."""
    wall, cpu = time.perf_counter(), time.process_time()
    function()
    return time.perf_counter() - wall, time.process_time() - cpu


def in_child(connection, peer, path, threads):
    mask = numpy.load(path)
    if peer == "scipy":
        from scipy import ndimage

        background = ~mask
        result = measure(lambda: ndimage.distance_transform_edt(background, return_indices=True))
    else:
        import edt

        background = numpy.ascontiguousarray(~mask)
        result = measure(lambda: edt.edtsq(background, black_border=False, order="C", parallel=threads))
    connection.send((*result, resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024))


def run_peer(peer, path, threads):
    """Runs a peer in its own process, so that peak memory covers only this run."""
    context = multiprocessing.get_context("spawn")
    here, there = context.Pipe()
    process = context.Process(target=in_child, args=(there, peer, path, threads))
    process.start()
    there.close()
    try:
        return here.recv()
    finally:
        process.join()


def run_blum(mask, folder, threads, mode):
    source = os.path.join(folder, "in.raw")
    mask.view(numpy.uint8).tofile(source)
    size = [str(n) for n in mask.shape[::-1]]
    command = [sample_program(), source, *size, "1", "1", "1", mode, str(threads), os.devnull]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
    seconds = float(process.stdout.read())
    _, status, usage = os.wait4(process.pid, 0)
    if status != 0:
        sys.exit("distance_transform_sample failed")
    return seconds, None, usage.ru_maxrss / 1024


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--side", type=int, default=512)
    parser.add_argument("--shape", choices=["shell", "ball", "random1", "random50"], default="shell")
    parser.add_argument("--repeat", type=int, default=3)
    parser.add_argument("--threads", type=int, default=len(os.sched_getaffinity(0)))
    parser.add_argument("--json")
    parser.add_argument("--skip-scipy", action="store_true", help="SciPy takes 40 s and 7 GB at side 512")
    arguments = parser.parse_args()

    mask = make_image(arguments.side, arguments.shape)
    report = {
        "side": arguments.side,
        "shape": arguments.shape,
        "selected": int(mask.sum()),
        "threads": arguments.threads,
        "load_before": os.getloadavg()[0],
        "programs": {},
    }
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "image.npy")
        numpy.save(path, mask)
        programs = {
            "blum unsigned": lambda: run_blum(mask, folder, arguments.threads, "unsigned"),
            "blum signed": lambda: run_blum(mask, folder, arguments.threads, "signed"),
            "edt, no indices": lambda: run_peer("edt", path, arguments.threads),
        }
        if not arguments.skip_scipy:
            programs["scipy with indices"] = lambda: run_peer("scipy", path, 1)
        for name, run in programs.items():
            runs = [run() for _ in range(1 if name.startswith("scipy") else arguments.repeat)]
            report["programs"][name] = {
                "seconds": statistics.median(r[0] for r in runs),
                "runs": [r[0] for r in runs],
                "cpu_seconds": None if runs[0][1] is None else statistics.median(r[1] for r in runs),
                "peak_mib": max(r[2] for r in runs),
            }
    report["load_after"] = os.getloadavg()[0]

    ours = report["programs"]["blum unsigned"]["seconds"]
    print(f"{arguments.shape} {arguments.side}^3, {arguments.threads} threads, load {report['load_before']:.1f}")
    for name, figures in report["programs"].items():
        figures["ratio"] = figures["seconds"] / ours
        print(
            f"  {name:20s} {figures['seconds']:8.3f} s  {mask.size / figures['seconds'] / 1e6:8.1f} Mvoxel/s"
            f"  {figures['ratio']:6.2f} x blum unsigned  peak {figures['peak_mib']:.0f} MiB"
        )
    if arguments.json:
        pathlib.Path(arguments.json).write_text(json.dumps(report, indent=2) + "\n")


if __name__ == "__main__":
    main()
