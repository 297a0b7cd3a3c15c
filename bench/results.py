#!/usr/bin/env python3
"""results.py MIMIK OUT [ICT-FaceKit]: makes the databases of docs/results.md, scores them, and prints its first tables.

Without the folder of ICT-FaceKit, those of the built-in faces alone. What is in OUT already is taken again, so that a
run that was stopped goes on. Two cores take about half an hour.
"""

import json
import pathlib
import statistics
import subprocess
import sys

THESIS = ["1", "2", "4", "12", "14", "15", "17", "20", "12L"]
FURTHER = ["5", "6", "7", "9", "10", "16", "18", "22", "23", "24", "25", "26", "27", "28", "34", "43"]
EMOTIONS = ["HAPPY", "SADNESS", "SURPRISE", "FEAR", "ANGER", "DISGUST"]
TITLES = {
    "thesis": "thesis",
    "sparse": "sparse",
    "sparse-mean": "sparse-mean",
    "default": "default",
    "mean": "mean",
    "true": "*true field, one source*",
    "true-mean": "*true field, mean*",
}


class World:
    """Databases of one face model, a seed each."""

    def __init__(self, mimik, out, name, subjects, model):
        self.mimik, self.out, self.name, self.subjects, self.model = mimik, out, name, subjects, model

    def run(self, *words):
        print("results.py:", " ".join(map(str, words)), file=sys.stderr, flush=True)
        done = subprocess.run([self.mimik, *map(str, words), "--quiet"], stdout=subprocess.DEVNULL, check=False)
        if done.returncode > 1:  # 1: done, with failures that the result lists
            sys.exit(f"results.py: '{words[0]}' ended with {done.returncode}")

    def scores(self, seed, which, expressions, methods):
        """Rows of scores.json by method; the true fields are `true` and `true-mean`."""
        folder = self.out / f"{self.name}-{seed}-{which}"
        if not (folder / "scores" / "scores.json").exists():
            database = folder / "database"
            if not database.exists():
                self.run("synthesize", database, "--subjects", self.subjects, "--seed", seed, "--expressions",
                         ",".join(expressions), *self.model)
            self.run("preprocess", database, "-o", folder / "work")
            self.run("evaluate", folder / "work", "--method", ",".join(methods), "--expression",
                     ",".join(expressions), "-o", folder / "scores")
        document = json.loads((folder / "scores" / "scores.json").read_text())
        if document["failures"]:
            print("results.py: failures:", *document["failures"], sep="\n  ", file=sys.stderr)
        rows = {}
        for row in document["rows"]:
            name = row["method"] if not row["reference"] else "true-mean" if row["kind"] == "mean" else "true"
            rows[name] = row
        return rows


def label(code):
    return code if code.isalpha() else "AU" + code


def table(head, lines):
    print("| " + " | ".join(head) + " |")
    print("| --- |" + " ---: |" * (len(head) - 1))
    for line in lines:
        print("| " + " | ".join(line) + " |")
    print()


def print_one_seed(rows, codes):
    names = [name for name in TITLES if name in rows]
    lines = [[label(c)] + [f"{rows[n]['expressions'][c]['explained']:.2f}" for n in names] for c in codes]
    lines.append(["mean"] + [f"**{rows[n]['explained']:.3f}**" for n in names])
    lines.append(["median case"] + [f"{rows[n]['explained_median']:.3f}" for n in names])
    lines.append(["share"] + [f"{rows[n]['share']:.2f}" if rows[n].get("share") is not None else "" for n in names])
    lines.append(["whole face"] + [f"{rows[n]['explained_whole_face']:.2f}" for n in names])
    cases = {n: [e["cases"] for e in rows[n]["expressions"].values()] for n in names}
    worse = {n: [e["worse_than_nothing"] for e in rows[n]["expressions"].values()] for n in names}
    lines.append(["worse than nothing"] + [f"{100 * sum(worse[n]) / sum(cases[n]):.1f} %" for n in names])
    lines.append(["cases"] + [str(sum(cases[n])) for n in names])
    table(["expression"] + [TITLES[n] for n in names], lines)
    print("Mean error in mm (distance to the real scan / to the true position of the same skin point):\n")
    lines = []
    for c in codes:
        first = rows[names[0]]["expressions"][c]
        line = [label(c), f"{first['nothing_mm']:.2f} / {first['nothing_true_mm']:.2f}"]
        for n in names:
            e = rows[n]["expressions"][c]
            line.append(f"{e['error_mm']:.2f} / {e['true_error_mm']:.2f}")
        lines.append(line)
    table(["expression", "doing nothing"] + [TITLES[n] for n in names], lines)


def spread(values):
    return f"{statistics.mean(values):.2f} ({min(values):.2f} .. {max(values):.2f})"


def print_seeds(by_seed, codes):
    names = [name for name in TITLES if name in by_seed[0]]
    lines = [[label(c)] + [spread([r[n]["expressions"][c]["explained"] for r in by_seed]) for n in names] for c in codes]
    lines.append(["mean"] + [spread([r[n]["explained"] for r in by_seed]) for n in names])
    lines.append(["share"] + [spread([r[n]["share"] for r in by_seed]) if r_has_share(by_seed, n) else "" for n in names])
    table(["expression"] + [TITLES[n] for n in names], lines)


def r_has_share(by_seed, name):
    return all(r[name].get("share") is not None for r in by_seed)


def print_further(by_seed, codes):
    names = [name for name in ("default", "mean", "true", "true-mean") if name in by_seed[0]]
    lines = [[label(c)] + [f"{statistics.mean(r[n]['expressions'][c]['explained'] for r in by_seed):.2f}" for n in names]
             for c in codes if all(c in r[names[0]]["expressions"] for r in by_seed)]
    table(["expression"] + [TITLES[n] for n in names], lines)


def main():
    if len(sys.argv) not in (3, 4):
        sys.exit(__doc__)
    mimik, out = sys.argv[1], pathlib.Path(sys.argv[2])
    methods = ["thesis", "sparse", "sparse-mean", "default", "mean"]
    worlds = [World(mimik, out, "builtin", 12, [])]
    if len(sys.argv) == 4:
        worlds.insert(0, World(mimik, out, "ict", 14, ["--face-model", sys.argv[3]]))
    for world in worlds:
        by_seed = [world.scores(seed, "thesis", THESIS, methods) for seed in (1, 2, 3)]
        print(f"## {world.name}, {world.subjects} subjects, seed 1\n")
        print_one_seed(by_seed[0], THESIS)
        print(f"### {world.name}, three seeds\n")
        print_seeds(by_seed, THESIS)
        if world.name == "ict":
            further = [world.scores(seed, "further", FURTHER + EMOTIONS, ["default", "mean"]) for seed in (1, 2)]
            print("### The other AUs and the emotions\n")
            print_further(further, FURTHER + EMOTIONS)


if __name__ == "__main__":
    main()
