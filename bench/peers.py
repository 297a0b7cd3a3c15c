#!/usr/bin/python3
"""Times the Python rivals of the thin-plate spline (SciPy, cache-blocked NumPy) on the work of bench_thin_plate_spline.

peer_timing.py says what is printed and what is needed.
"""
import numpy as np
from scipy.interpolate import RBFInterpolator
from scipy.linalg import solve

from peer_timing import face_height, tell, timed


def grid():
    x, y = np.meshgrid(0.94 * (np.arange(150) - 74.5), 1.35 * (np.arange(150) - 74.5))
    noise = np.random.default_rng(1).uniform(-0.15, 0.15, x.shape)
    return np.column_stack([x.ravel(), y.ravel(), (face_height(x, y) + noise).ravel()])


def numpy_fit(source, target):
    """The dense system in raw coordinates, r^2 ln r^2."""
    n = len(source)
    squared = ((source[:, None] - source[None]) ** 2).sum(2)
    system = np.zeros((n + 4, n + 4))
    system[:n, :n] = squared * np.log(np.where(squared > 0, squared, 1))
    system[:n, n] = 1
    system[:n, n + 1:] = source
    system[n:, :n] = system[:n, n:].T
    solution = solve(system, np.vstack([target, np.zeros((4, 3))]), assume_a="sym")
    return solution[:n], solution[n:]


def numpy_evaluate(points, source, weights, affine, block=128):
    """Blocks that fit the cache, squared distances by one product, everything in place."""
    moved = np.empty_like(points)
    source_squared = (source ** 2).sum(1)
    for start in range(0, len(points), block):
        part = points[start:start + block]
        squared = part @ (-2 * source.T)
        squared += (part ** 2).sum(1)[:, None]
        squared += source_squared
        np.maximum(squared, 1e-300, out=squared)
        squared *= np.log(squared)
        moved[start:start + block] = squared @ weights + part @ affine[1:] + affine[0]
    return moved


def main():
    points = grid()
    results = []

    def add(name, call):
        results.append(timed(name, call))

    for n in (22, 40, 100, 500):
        source = points[(np.arange(n) * 7919 + 1000) % len(points)]
        target = source + np.random.default_rng(n).uniform(-5, 5, source.shape)
        weights, affine = numpy_fit(source, target)
        spline = RBFInterpolator(source, target, kernel="thin_plate_spline", degree=1)
        difference = np.abs(spline(points) - numpy_evaluate(points, source, weights, affine)).max()
        if not difference < 1e-6:
            raise SystemExit(f"SciPy and NumPy differ by {difference} mm at {n} controls")
        add(f"scipy_spline_fit/{n}",
            lambda: RBFInterpolator(source, target, kernel="thin_plate_spline", degree=1))
        add(f"scipy_spline_evaluate/{n}", lambda: spline(points))
        add(f"numpy_spline_evaluate/{n}", lambda: numpy_evaluate(points, source, weights, affine))
    tell(results)


if __name__ == "__main__":
    main()
