"""What the Python peers share: the face in closed form, the clock, and the shape of their answer.

Each prints JSON in the shape of Google Benchmark: {"benchmarks": [{"name": ..., "cpu_time": milliseconds}, ...]}.
One thread: set OMP_NUM_THREADS and OPENBLAS_NUM_THREADS to 1. Needs numpy and scipy.
"""
import json
import time

import numpy as np


def face_height(x, y):
    def bump(cx, cy, wx, wy):
        return np.exp(-0.5 * (((x - cx) / wx) ** 2 + ((y - cy) / wy) ** 2))

    return (90 * bump(0, 0, 60, 90) + 22 * bump(0, -5, 9, 16) - 9 * (bump(-32, 28, 12, 9) + bump(32, 28, 12, 9))
            + 4 * (bump(0, -38, 18, 4) + bump(0, -48, 16, 4)))


def median_ms(call, least_s, least_rounds=5):
    rounds = []
    started = time.perf_counter()
    while len(rounds) < least_rounds or time.perf_counter() - started < least_s:
        before = time.process_time()
        call()
        rounds.append(time.process_time() - before)
    return 1e3 * sorted(rounds)[len(rounds) // 2]


def timed(name, call, least_s=0.5):
    return {"name": name, "cpu_time": median_ms(call, least_s), "time_unit": "ms"}


def tell(results):
    print(json.dumps({"benchmarks": results}, indent=1))
