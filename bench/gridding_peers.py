#!/usr/bin/python3
"""Times SciPy's griddata on the work of bench_gridding (one scan of about 35,000 points to 150 x 150).

Prints JSON in the shape of Google Benchmark: {"benchmarks": [{"name": ..., "cpu_time": milliseconds}, ...]}.
One thread: set OMP_NUM_THREADS and OPENBLAS_NUM_THREADS to 1. Needs numpy and scipy.
"""
import json
import time

import numpy as np
from scipy.interpolate import griddata


def face_height(x, y):
    def bump(cx, cy, wx, wy):
        return np.exp(-0.5 * (((x - cx) / wx) ** 2 + ((y - cy) / wy) ** 2))

    return (90 * bump(0, 0, 60, 90) + 22 * bump(0, -5, 9, 16) - 9 * (bump(-32, 28, 12, 9) + bump(32, 28, 12, 9))
            + 4 * (bump(0, -38, 18, 4) + bump(0, -48, 16, 4)))


def scan(jitter_mm):
    random = np.random.default_rng(1)
    x, y = np.meshgrid(0.82 * (np.arange(180) - 89.5), 0.82 * (np.arange(256) - 127.5))
    x = (x + jitter_mm * random.uniform(-1, 1, x.shape)).ravel()
    y = (y + jitter_mm * random.uniform(-1, 1, y.shape)).ravel()

    def inside(cx, cy, rx, ry):
        return np.hypot((x - cx) / rx, (y - cy) / ry) < 1

    hole = inside(-30, 28, 5, 2.5) | inside(30, 28, 5, 2.5) | inside(-5, -16, 2, 2) | inside(5, -16, 2, 2)
    kept = inside(0, 0, 73, 104) & ~hole
    z = face_height(x, y) + 0.2 * random.uniform(-1, 1, x.shape)
    return x[kept], y[kept], z[kept]


def median_ms(call, least_s=1.0, least_rounds=5):
    rounds = []
    started = time.perf_counter()
    while len(rounds) < least_rounds or time.perf_counter() - started < least_s:
        before = time.process_time()
        call()
        rounds.append(time.process_time() - before)
    return 1e3 * sorted(rounds)[len(rounds) // 2]


def main():
    results = []
    for name, jitter_mm in (("general", 0.08), ("lattice", 0.0)):
        x, y, z = scan(jitter_mm)
        gx, gy = np.meshgrid(np.linspace(x.min(), x.max(), 150), np.linspace(y.min(), y.max(), 150))
        milliseconds = median_ms(lambda: griddata((x, y), z, (gx, gy), method="linear"))
        results.append({"name": f"scipy_gridding/{name}", "cpu_time": milliseconds, "time_unit": "ms"})
    print(json.dumps({"benchmarks": results}, indent=1))


if __name__ == "__main__":
    main()
