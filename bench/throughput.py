#!/usr/bin/env python3
"""throughput.py MIMIK FOLDER [--subjects N] [--parts matrix,methods,estimators]

What an experiment of Bosphorus' size costs, from a measured 1 %, and what each method and estimator adds. Prints Markdown.

FOLDER is made and kept: a synthetic database of N subjects (default 105) with one expression (AU 12), and its
workspace (150 x 150 vertices a face). The matrix is 105 targets x 104 sources x 9 expressions = 98,280 transfers.
1 % of it, 945 units of work / 100 = 9 targets of one expression with 104 sources each, is run twice: once with 1
target, once with 10. The difference is 9 units; what is left of the run with 1 target is what the expression costs
once: reading and studying all participants. Seconds are processor time of the program (user and system, one thread).
"""
import argparse
import os
import pathlib
import resource
import subprocess

MATRIX = (105, 104, 9)
SOURCES = "{ next = 8 }"
ESTIMATORS = ["point-to-surface", "point-to-point", "signed", "normal-angle", "curvature", "along-normal", "registered",
              "true", "reverse", "hausdorff", "landmarks/point-to-surface", "stable-region/point-to-surface"]


def seconds_of(command):
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run([str(word) for word in command], check=True, stdout=subprocess.DEVNULL)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def run(arguments, name, targets, methods, sources='"all"', extra="", whole_face=True):
    """Processor seconds of an experiment."""
    file = arguments.folder / f"{name}.toml"
    listed = ", ".join(f'"bs{k:03}"' for k in range(targets))
    file.write_text(f'schema = 1\nworkspace = "work"\nexpressions = ["12"]\nmethods = {methods}\n'.replace("'", '"')
                    + f"[subjects]\ntargets = [{listed}]\nsources = {sources}\n[evaluation]\nreference = false\n"
                    + f"whole_face = {str(whole_face).lower()}\n{extra}\n[statistics]\nresamples = 100\n")
    return seconds_of([arguments.mimik, "run", file, "-o", arguments.folder / "out", "--anew", "--quiet", "--threads", 1])


def make_database(arguments):
    work = arguments.folder / "work"
    if (work / "workspace.json").exists():
        return
    arguments.folder.mkdir(parents=True, exist_ok=True)
    database = arguments.folder / "db"
    if not (database / "truth").exists():
        subprocess.run([arguments.mimik, "synthesize", database, "--subjects", str(arguments.subjects), "--expressions",
                        "12", "--quiet"], check=True, stdout=subprocess.DEVNULL)
    subprocess.run([arguments.mimik, "preprocess", database, "-o", work, "--quiet"], check=True,
                   stdout=subprocess.DEVNULL)


def per_unit(arguments, name, few, many, **options):
    """Seconds of what an expression costs once, and of each target."""
    first = run(arguments, name, few, **options)
    second = run(arguments, name, many, **options)
    unit = (second - first) / (many - few)
    return first - few * unit, unit


def matrix(arguments):
    subjects, _, expressions = MATRIX
    print("| what every transfer is measured by | an expression once, s | a target with its sources, s |"
          " 98,280 transfers, core hours |\n| --- | ---: | ---: | ---: |")
    for title, extra in (("the rows of every experiment", ""),
                         ("those, and the other direction (`reverse`)", 'estimators = ["reverse"]')):
        once, unit = per_unit(arguments, "matrix", 1, 10, methods=["default"], extra=extra)
        unit *= (subjects - 1) / (arguments.subjects - 1)
        once *= subjects / arguments.subjects
        print(f"| {title} | {once:.1f} | {unit:.2f} | {expressions * (once + subjects * unit) / 3600:.2f} |", flush=True)


def costs(arguments, kind, names, cases, **with_name):
    """What one more method or estimator adds to a case: 3 targets with 8 sources each, over the default alone."""
    _, base = per_unit(arguments, kind, 1, 4, methods=["default"], sources=SOURCES)
    print(f"\n| {kind} | ms a case |\n| --- | ---: |")
    for name in names:
        options = {"methods": ["default"], **{key: value(name) for key, value in with_name.items()}}
        once, unit = per_unit(arguments, kind, 1, 4, sources=SOURCES, **options)
        print(f"| `{name}` | {1000 * (unit - base) / cases(name):.1f} |", flush=True)


def names_of(arguments, topic, keep):
    text = subprocess.run([str(arguments.mimik), "help", topic], check=True, capture_output=True, text=True).stdout
    return [line.split()[0] for line in text.splitlines() if keep(line)]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("mimik", type=pathlib.Path)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--subjects", type=int, default=105)
    parser.add_argument("--parts", default="matrix,methods,estimators")
    arguments = parser.parse_args()
    make_database(arguments)
    parts = arguments.parts.split(",")
    print(f"{os.cpu_count()} processors, load {os.getloadavg()[0]:.1f} at the start, {arguments.subjects} subjects\n")
    if "matrix" in parts:
        matrix(arguments)
    if "methods" in parts:
        methods = names_of(arguments, "methods", lambda line: line.startswith("  ") and line.split()[0] != "default")
        means = set(names_of(arguments, "methods", lambda line: " mean " in line[:40]))
        costs(arguments, "method", methods, lambda name: 1 if name in means else 8,
              methods=lambda name: ["default", name])
    if "estimators" in parts:
        # Doing nothing is a case, too.
        costs(arguments, "estimator", ESTIMATORS, lambda name: 9, extra=lambda name: f'estimators = ["{name}"]')
    print(f"\nload {os.getloadavg()[0]:.1f} at the end")


if __name__ == "__main__":
    main()
