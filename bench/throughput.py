#!/usr/bin/env python3
"""throughput.py MIMIK FOLDER [--subjects N] [--expressions 12,1,4] [--parts matrix,methods,estimators]

What an experiment of Bosphorus' size costs, from a measured 1 %, and what each method and estimator adds. Prints Markdown.

FOLDER is made and kept: a synthetic database of N subjects (default 14) and its workspace, FOLDER/work (150 x 150
vertices a face). Where FOLDER/work is there already it is taken as it is; --subjects says how many it has.
The matrix is 105 targets x 104 sources x 9 expressions = 98,280 transfers; 14 subjects on each other with 6 expressions
are 1,092 of them, 1.1 %. Three runs tell what an expression costs once for each who shows it, a target, and a transfer:
all targets with all sources, all targets with one source, one target with one source. Seconds are processor time of
the program (user and system) on one thread.
"""
import argparse
import os
import pathlib
import resource
import subprocess

MATRIX = {"subjects": 105, "expressions": 9}
ESTIMATORS = ["point-to-surface", "point-to-point", "signed", "normal-angle", "curvature", "along-normal", "registered",
              "true", "reverse", "hausdorff", "landmarks/point-to-surface", "stable-region/point-to-surface"]


class Bench:
    def __init__(self, arguments):
        self.mimik, self.folder, self.subjects = arguments.mimik, arguments.folder, arguments.subjects
        self.expressions = arguments.expressions.split(",")

    def make(self):
        if (self.folder / "work" / "workspace.json").exists():
            return
        self.folder.mkdir(parents=True, exist_ok=True)
        database = self.folder / "db"
        for words in (["synthesize", database, "--subjects", self.subjects, "--expressions", ",".join(self.expressions)],
                      ["preprocess", database, "-o", self.folder / "work"]):
            subprocess.run([str(word) for word in [self.mimik, *words, "--quiet"]], check=True, stdout=subprocess.DEVNULL)

    def seconds(self, methods, expressions, targets, sources, estimators=()):
        """Processor seconds of an experiment."""
        quoted = lambda words: "[" + ", ".join(f'"{word}"' for word in words) + "]"
        lines = ["schema = 1", 'workspace = "work"', f"expressions = {quoted(expressions)}", f"methods = {quoted(methods)}",
                 "[subjects]", f"targets = {quoted(f'bs{k:03}' for k in range(targets))}",
                 f"sources = {{ next = {sources} }}", "[evaluation]", "reference = false"]
        if estimators:
            lines.append(f"estimators = {quoted(estimators)}")
        lines += ["[statistics]", "resamples = 100"]
        file = self.folder / "bench.toml"
        file.write_text("\n".join(lines) + "\n")
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        subprocess.run([str(word) for word in [self.mimik, "run", file, "-o", self.folder / "out", "--anew", "--quiet",
                                               "--threads", 1]], check=True, stdout=subprocess.DEVNULL)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime

    def matrix(self):
        n, e = self.subjects, len(self.expressions)
        print("| measured by | transfers measured | one who shows an expression, ms | a target, ms | a transfer, ms |"
              " 98,280 transfers, core hours |\n| --- | ---: | ---: | ---: | ---: | ---: |")
        for title, estimators in (("the rows of every experiment", ()),
                                  ("those, and the other direction (`reverse`)", ("reverse",))):
            whole = self.seconds(["default"], self.expressions, n, n - 1, estimators)
            few = self.seconds(["default"], self.expressions, n, 1, estimators)
            least = self.seconds(["default"], self.expressions, 1, 1, estimators)
            transfer = (whole - few) / (e * n * (n - 2))
            target = (few - least) / (e * (n - 1)) - transfer
            shown = (least / e - target - transfer) / n
            subjects = MATRIX["subjects"]
            hours = MATRIX["expressions"] * subjects * (shown + target + (subjects - 1) * transfer) / 3600
            print(f"| {title} | {e * n * (n - 1)} | {1000 * shown:.0f} | {1000 * target:.0f} | {1000 * transfer:.1f} |"
                  f" {hours:.2f} |", flush=True)

    def costs(self, kind, names, cases, options):
        """What one more method or estimator adds to a case over the default alone."""
        targets, sources = 4, min(8, self.subjects - 1)
        measure = lambda **more: (self.seconds(**more, expressions=self.expressions[:1], targets=targets, sources=sources)
                                  - self.seconds(**more, expressions=self.expressions[:1], targets=1, sources=sources))
        base = measure(methods=["default"])
        print(f"\n| {kind} | ms a case |\n| --- | ---: |")
        for name in names:
            added = measure(**{"methods": ["default"], **options(name)}) - base
            print(f"| `{name}` | {1000 * added / (targets - 1) / cases(name, sources):.1f} |", flush=True)

    def names(self, topic, keep):
        text = subprocess.run([str(self.mimik), "help", topic], check=True, capture_output=True, text=True).stdout
        return [line.split()[0] for line in text.splitlines() if line.startswith("  ") and keep(line)]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("mimik", type=lambda name: pathlib.Path(name).resolve())
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--subjects", type=int, default=14)
    parser.add_argument("--expressions", default="12,1,4,14,15,17")
    parser.add_argument("--parts", default="matrix,methods,estimators")
    arguments = parser.parse_args()
    bench = Bench(arguments)
    bench.make()
    print(f"{os.cpu_count()} processors, load {os.getloadavg()[0]:.1f} at the start, {bench.subjects} subjects\n")
    parts = arguments.parts.split(",")
    if "matrix" in parts:
        bench.matrix()
    if "methods" in parts:
        means = set(bench.names("methods", lambda line: " mean " in line[:40]))
        bench.costs("method", bench.names("methods", lambda line: line.split()[0] != "default"),
                    lambda name, sources: 1 if name in means else sources, lambda name: {"methods": ["default", name]})
    if "estimators" in parts:
        # Doing nothing is a case, too.
        bench.costs("estimator", ESTIMATORS, lambda name, sources: sources + 1, lambda name: {"estimators": [name]})
    print(f"\nload {os.getloadavg()[0]:.1f} at the end")


if __name__ == "__main__":
    main()
