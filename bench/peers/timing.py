"""Shared timing of the benchmarks of peers."""

import time


def best_of(runs, body):
    """The shortest time of several runs, in seconds, and the result of the last run."""
    times = []
    for _ in range(runs):
        start = time.perf_counter()
        value = body()
        times.append(time.perf_counter() - start)
    return min(times), value
