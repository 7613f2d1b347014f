"""Times Blum's medial axis or centreline of an image against thinning by other programs on the same image.

    python3 bench/peers/skeleton_peers.py [--side 512] [--shape bumpy] [--verb medial] [--json FILE]
        [--peers scikit-image,scikit-image-radii,kimimaro,itk]

Requires NumPy, SciPy, the blum tool (BLUM_CLI, or below build/) and the peers: `pip install scikit-image kimimaro
itk-thickness3d`. A missing peer is left out and reported. --json FILE writes the figures.

Shapes occupy a fifth of the voxels: `bumpy`, one smooth body; `organs`, a few thick ones; `pores`, many thin ones.

scikit-image and ITK thin to curves, on one thread. kimimaro traces trees, on all threads. Blum's axis (theta 60) has
surfaces, curves, radii and footprints. `--verb centreline` times Blum's graph of curves with radii instead.
`scikit-image-radii` is thinning and SciPy's distance transform, from which its users take radii.

Reading, writing and Blum's certificate are not timed. Blum's row lists the seconds of the certificate. Blum's CPU
seconds cover the whole run.
"""

import argparse
import json
import multiprocessing
import os
import pathlib
import resource
import subprocess
import sys
import tempfile
import time

import numpy

ROOT = pathlib.Path(__file__).resolve().parents[2]
NOT_TIMED = ("read", "write", "certificate")


def blum_tool():
    named = os.environ.get("BLUM_CLI")
    if named:
        return named
    found = sorted(ROOT.glob("build/*/bin/blum"), key=os.path.getmtime)
    if not found:
        sys.exit("blum is not built; build it or set BLUM_CLI")
    return str(found[-1])


def smooth_noise(side, length):
    """The voxels with the largest fifth of the values of a periodic random field, smooth over `length` voxels."""
    from scipy import ndimage

    step = 4 if length >= 32 else 1
    noise = numpy.random.default_rng(2).standard_normal((side // step,) * 3, dtype=numpy.float32)
    field = ndimage.gaussian_filter(noise, length / step, mode="wrap")
    if step > 1:
        field = ndimage.zoom(field, step, order=3)
    return field > numpy.quantile(field[::2, ::2, ::2], 0.8)


def make_image(side, shape):
    if shape == "organs":
        return smooth_noise(side, side / 16)
    if shape == "pores":
        return smooth_noise(side, side / 64)
    mask = numpy.empty((side, side, side), dtype=bool)
    centre = (numpy.arange(side) + 0.5) / side - 0.5
    y, x = numpy.meshgrid(centre, centre, indexing="ij")
    for k, z in enumerate(centre):
        surface = 0.355 + 0.03 * numpy.sin(11 * x) * numpy.sin(13 * y + 1) + 0.05 * numpy.sin(7 * z)
        mask[k] = numpy.sqrt(x * x + y * y + z * z) < surface
    return mask


def thin(peer, mask, threads):
    """Wall-clock and CPU seconds, and the number of remaining voxels or vertices."""
    if peer == "scikit-image":
        from skimage.morphology import skeletonize

        work = lambda: int(skeletonize(mask).sum())
    elif peer == "scikit-image-radii":
        from scipy import ndimage
        from skimage.morphology import skeletonize

        work = lambda: len(ndimage.distance_transform_edt(mask)[skeletonize(mask)])
    elif peer == "kimimaro":
        import kimimaro

        labels = mask.astype(numpy.uint8)
        work = lambda: sum(
            len(skeleton.vertices)
            for skeleton in kimimaro.skeletonize(labels, dust_threshold=0, progress=False, parallel=threads).values()
        )
    else:
        import itk

        image = itk.image_from_array(mask.astype(numpy.uint8))
        work = lambda: int(itk.array_from_image(itk.binary_thinning_image_filter3_d(image)).astype(bool).sum())
    wall, cpu = time.perf_counter(), time.process_time()
    left = work()
    return time.perf_counter() - wall, time.process_time() - cpu, left


def in_child(connection, peer, path, threads):
    try:
        figures = thin(peer, numpy.load(path), threads)
    except ImportError:
        connection.send(None)
        return
    connection.send((*figures, resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024))


def run_peer(peer, path, threads):
    """Runs a peer in its own process, so that peak memory covers only this run; None if it is not installed."""
    context = multiprocessing.get_context("spawn")
    here, there = context.Pipe()
    process = context.Process(target=in_child, args=(there, peer, path, threads))
    process.start()
    there.close()
    try:
        return here.recv()
    finally:
        process.join()


def run_blum(path, folder, threads, verb):
    command = [blum_tool(), verb, path, "-o", os.path.join(folder, "axis.npz"), "--json", "-"]
    if verb == "medial":
        command += ["--theta", "60"]
    process = subprocess.Popen([*command, "--threads", str(threads)], stdout=subprocess.PIPE, text=True)
    summary = json.loads(process.stdout.read())
    _, status, usage = os.wait4(process.pid, 0)
    if status != 0:
        sys.exit(f"blum {verb} failed")
    seconds = summary["seconds"]
    if verb == "medial":
        left = summary["solids"][0]["axes"][0]["counts"]["vertices"]
    else:
        left = sum(label["branches"] for label in summary["labels"])
    return {
        "seconds": sum(value for phase, value in seconds.items() if phase not in NOT_TIMED),
        "cpu_seconds": usage.ru_utime + usage.ru_stime,
        "certificate_seconds": seconds.get("certificate", 0),
        "phases": seconds,
        "left": left,
        "peak_mib": usage.ru_maxrss / 1024,
        "certified": summary.get("certified"),
    }


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--side", type=int, default=512)
    parser.add_argument("--shape", choices=["bumpy", "organs", "pores"], default="bumpy")
    parser.add_argument("--verb", choices=["medial", "centreline"], default="medial")
    parser.add_argument("--peers", default="scikit-image,kimimaro,itk")
    parser.add_argument("--threads", type=int, default=len(os.sched_getaffinity(0)))
    parser.add_argument("--json")
    arguments = parser.parse_args()

    mask = make_image(arguments.side, arguments.shape)
    report = {
        "side": arguments.side,
        "shape": arguments.shape,
        "verb": arguments.verb,
        "selected": int(mask.sum()),
        "threads": arguments.threads,
        "load_before": os.getloadavg()[0],
        "programs": {},
    }
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "image.npy")
        numpy.save(path, mask.astype(numpy.uint8))
        report["programs"]["blum"] = ours = run_blum(path, folder, arguments.threads, arguments.verb)
        for peer in filter(None, arguments.peers.split(",")):
            figures = run_peer(peer, path, arguments.threads)
            if figures is None:
                print(f"  {peer}: not installed")
                continue
            wall, cpu, left, peak = figures
            report["programs"][peer] = {
                "seconds": wall,
                "cpu_seconds": cpu,
                "left": left,
                "peak_mib": peak,
                "ratio": wall / ours["seconds"],
            }
    report["load_after"] = os.getloadavg()[0]

    share = 100 * report["selected"] / mask.size
    print(
        f"{arguments.shape} {arguments.side}^3, {share:.1f} % of the voxels, {arguments.threads} threads, "
        f"load {report['load_before']:.1f}"
    )
    for name, figures in report["programs"].items():
        ratio = f"{figures['ratio']:6.2f} x blum" if "ratio" in figures else f"certificate {figures['certificate_seconds']:.2f} s"
        print(
            f"  {name:14s} {figures['seconds']:9.3f} s  CPU {figures['cpu_seconds']:9.3f} s  {ratio}"
            f"  {figures['left']} left  peak {figures['peak_mib']:.0f} MiB"
        )
    if arguments.json:
        pathlib.Path(arguments.json).write_text(json.dumps(report, indent=2) + "\n")


if __name__ == "__main__":
    main()
