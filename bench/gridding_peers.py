#!/usr/bin/python3
"""Times SciPy's griddata on the work of bench_gridding (one scan of about 35,000 points to 150 x 150).

peer_timing.py says what is printed and what is needed.
"""
import numpy as np
from scipy.interpolate import griddata

from peer_timing import face_height, tell, timed


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


def main():
    results = []
    for name, jitter_mm in (("general", 0.08), ("lattice", 0.0)):
        x, y, z = scan(jitter_mm)
        gx, gy = np.meshgrid(np.linspace(x.min(), x.max(), 150), np.linspace(y.min(), y.max(), 150))
        results.append(timed(f"scipy_gridding/{name}", lambda: griddata((x, y), z, (gx, gy), method="linear"),
                             least_s=1.0))
    tell(results)


if __name__ == "__main__":
    main()
