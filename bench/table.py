#!/usr/bin/python3
"""One Markdown table from result files of Google Benchmark: table.py PROGRAM.json ... (names are tool_task/size)."""
import json
import pathlib
import re
import sys


def tidy(name):
    parts = [p for p in name.split("/") if p not in ("real_time", "process_time")]
    return "/".join(p for p in parts if not p.startswith(("min_time:", "repeats:")))


def milliseconds(result):
    """Processor time, which other load disturbs least; wall time where the benchmark asked for it (several threads)."""
    wall = "real_time" in result.get("run_name", result["name"]).split("/")
    return result["real_time" if wall else "cpu_time"] * {"ns": 1e-6, "us": 1e-3, "ms": 1.0, "s": 1e3}[result["time_unit"]]


def in_natural_order(task):
    return [int(part) if part.isdigit() else part for part in re.split(r"(\d+)", task)]


def three_digits(value):
    return f"{value:.0f}" if value >= 100 else f"{value:.3g}"


def main(files):
    rows = {}  # task -> {tool: ms}
    for file in files:
        for result in json.loads(pathlib.Path(file).read_text())["benchmarks"]:
            if result.get("run_type") == "aggregate" and result.get("aggregate_name") != "median":
                continue
            name = tidy(result.get("run_name", result["name"]))
            tool, _, task = name.partition("_")
            rows.setdefault(task, {})[tool] = milliseconds(result)
    print("| task | Mimik, ms | others, ms | best other / Mimik |")
    print("|---|---|---|---|")
    for task, tools in sorted(rows.items(), key=lambda row: in_natural_order(row[0])):
        ours = tools.pop("mimik", None)
        others = ", ".join(f"{tool} {three_digits(ms)}" for tool, ms in sorted(tools.items(), key=lambda t: t[1]))
        ratio = f"{min(tools.values()) / ours:.1f}" if ours and tools else ""
        print(f"| {task.replace('_', ' ')} | {three_digits(ours) if ours else ''} | {others} | {ratio} |")


if __name__ == "__main__":
    main(sys.argv[1:])
