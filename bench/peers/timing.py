"""Timing that the benchmarks of peers share."""

import time


def best_of(runs, body):
    """The shortest time of several runs, in seconds, and what the last one returned."""
    times = []
    for _ in range(runs):
        start = time.perf_counter()
        value = body()
        times.append(time.perf_counter() - start)
    return min(times), value
