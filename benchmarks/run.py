"""Run Slackside and the installed peers on the shared benchmark, interleaved in one run, and tabulate the answers.

    python benchmarks/run.py [--python VENV/bin/python] [--repeats 5] [--rounds 2] [--tasks abcdefghij] [--full]

Writes ``results/latest.json`` and ``results/latest.md``. See README.md for what is measured and how to read it.
"""

import argparse
import json
import os
import platform
import statistics
import subprocess
import sys
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Any

HERE = Path(__file__).resolve().parent
OURS = "slackside"
CASES = {"a": "AB"} | {task: "A" for task in "bcdefghij"}
LONG_SECONDS = 60.0  # a program that takes longer than this runs in the first round only
ONE_THREAD = {name: "1" for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "RAYON_NUM_THREADS")}

Line = dict[str, Any]


@dataclass(frozen=True)
class Peer:
    """One peer program: its script, the module whose presence means installed, the package, the tasks it can do."""

    script: str
    module: str
    package: str
    tasks: str


PEERS = (
    Peer("heyoka_peer.py", "heyoka", "heyoka", "bc"),
    Peer("scipy_peer.py", "scipy", "scipy", "bc"),
    Peer("sundae_peer.py", "sksundae", "scikit-sundae", "bc"),
    Peer("pyharm_peer.py", "pyHarm", "pyHarm-os", "a"),
    Peer("eigen_peer.py", "scipy", "scipy", "e"),
)


def run_program(command: list[str]) -> list[Line]:
    """Run a program and return the JSON lines it printed; a failure is reported on stderr and yields no lines."""
    try:
        done = subprocess.run(command, capture_output=True, text=True, env=os.environ | ONE_THREAD, cwd=HERE.parent)
    except FileNotFoundError as error:
        print(f"skipped: {error.filename} is not installed", file=sys.stderr)
        return []
    if done.returncode != 0:
        reason = (done.stderr.strip().splitlines() or ["no message"])[-1]
        print(f"failed ({done.returncode}): {' '.join(command)}\n    {reason}", file=sys.stderr)
    return [json.loads(line) for line in done.stdout.splitlines() if line.startswith("{")]


def installed_peers(python: str) -> list[Peer]:
    """Return the peers whose module the interpreter finds; name the others with the way to install them."""
    found = []
    for peer in PEERS:
        probe = f"import importlib.util as u, sys; sys.exit(u.find_spec({peer.module!r}) is None)"
        if subprocess.run([python, "-c", probe]).returncode == 0:
            found.append(peer)
        else:
            print(
                f"skipped: {peer.package} is not installed; pip install -r benchmarks/peers/requirements.txt",
                file=sys.stderr,
            )
    return found


def commands(task: str, peers: list[Peer], options: argparse.Namespace) -> list[list[str]]:
    """Return the programs to run for a task in one round: ours before each peer, so that neighbours are compared."""
    repeats = ["--repeats", str(options.repeats)]
    cargo = ["cargo", "run", "--release", "--quiet", "-p", "slackside-benchmarks", "--"]
    ours = [cargo + [task, "--case", case, *repeats] for case in CASES[task]]
    able = [peer for peer in peers if task in peer.tasks]
    result = [] if able else list(ours)
    for peer in able:
        result += ours
        extra = ["--tasks", task] + (["--full"] if options.full else []) if "b" in peer.tasks else []
        result.append([options.python, str(HERE / "peers" / peer.script), *repeats, *extra])
    return result


def measure(peers: list[Peer], options: argparse.Namespace) -> list[Line]:
    """Run all programs in rounds and return every line they printed; Ctrl-C ends early and keeps those lines."""
    lines: list[Line] = []
    try:
        run_rounds(peers, options, lines)
    except KeyboardInterrupt:
        print("interrupted: the table holds what was finished", file=sys.stderr)
    return lines


def run_rounds(peers: list[Peer], options: argparse.Namespace, lines: list[Line]) -> None:
    """Run all programs in rounds, appending to ``lines`` as each finishes."""
    skip: set[str] = set()
    for round_number in range(1, options.rounds + 1):
        for task in options.tasks:
            for command in commands(task, peers, options):
                key = " ".join(command)
                if key in skip:
                    continue
                print(f"round {round_number}, task ({task}): {key}", file=sys.stderr)
                began = time.monotonic()
                printed = run_program(command)
                lines += printed
                if not printed or time.monotonic() - began > LONG_SECONDS:
                    skip.add(key)


def combine(lines: list[Line]) -> list[Line]:
    """Merge the lines of one contestant, task and case: least minimum, median of medians, sum of the repeats.

    Adds ``cpu_seconds_whole_task``, the median extrapolated where only a share of the task was run, and
    ``ratio_to_slackside`` of those, when ours ran.
    """
    groups: dict[tuple[str, str, str], list[Line]] = {}
    for line in lines:
        groups.setdefault((line["task"], line["case"], line["peer"]), []).append(line)
    merged = []
    for group in groups.values():
        line = dict(group[-1])
        line["cpu_seconds_min"] = min(entry["cpu_seconds_min"] for entry in group)
        line["cpu_seconds_median"] = statistics.median(entry["cpu_seconds_median"] for entry in group)
        line["repeats"] = sum(entry["repeats"] for entry in group)
        line["cpu_seconds_whole_task"] = line["cpu_seconds_median"] / line.get("share", 1.0)
        merged.append(line)
    ours = {(line["task"], line["case"]): line["cpu_seconds_median"] for line in merged if line["peer"] == OURS}
    for line in merged:
        own = ours.get((line["task"], line["case"]))
        line["ratio_to_slackside"] = line["cpu_seconds_whole_task"] / own if own else None
    return sorted(
        merged, key=lambda line: (line["task"], line["case"], line["peer"] != OURS, line["cpu_seconds_whole_task"])
    )


def short(value: Any) -> str:
    """Return a table cell: three significant digits for numbers."""
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, float):
        return f"{value:.3g}"
    return "[" + ", ".join(map(short, value)) + "]" if isinstance(value, list) else str(value)


def table(lines: list[Line]) -> str:
    """Return the markdown table, and the notes of the contestants below it."""
    rows = [
        "| task | case | program | CPU s, min | median | repeats | share run | whole task, s | ratio | accuracy |",
        "|---|---|---|---|---|---|---|---|---|---|",
    ]
    for line in lines:
        share = line.get("share", 1.0)
        ratio = line["ratio_to_slackside"]
        accuracy = ", ".join(f"{name.replace('_', ' ')} {short(value)}" for name, value in line["accuracy"].items())
        cells = [
            f"({line['task']})",
            line["case"],
            f"{line['peer']} {line['version']}",
            short(line["cpu_seconds_min"]),
            short(line["cpu_seconds_median"]),
            str(line["repeats"]),
            f"{share:.3g}",
            ("about " if share < 1.0 else "") + short(line["cpu_seconds_whole_task"]),
            "" if ratio is None else ("about " if share < 1.0 else "") + short(ratio),
            accuracy,
        ]
        rows.append("| " + " | ".join(cells) + " |")
    notes = dict.fromkeys(f"* {line['peer']}, task ({line['task']}): {line['note']}." for line in lines if line["note"])
    return "\n".join([*rows, "", *notes]) + "\n"


def main() -> int:
    """Run, print the table, write the result files; return 1 when nothing could be run."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--python", default=sys.executable, help="interpreter in which the peers are installed")
    parser.add_argument("--repeats", type=int, default=5, help="repeats in each program run")
    parser.add_argument("--rounds", type=int, default=2, help="times the whole field is run, one after another")
    parser.add_argument("--tasks", default="abcdefghij", help="letters of the tasks to run")
    parser.add_argument("--full", action="store_true", help="let slow peers run all of task (b): an hour or more")
    options = parser.parse_args()

    results = combine(measure(installed_peers(options.python), options))
    if not results:
        print("nothing was measured; see the messages above", file=sys.stderr)
        return 1
    machine = f"{platform.machine()}, {os.cpu_count()} CPUs, load {os.getloadavg()[0]:.2f} at the end"
    heading = f"# Benchmark results\n\n{time.strftime('%Y-%m-%d %H:%M', time.gmtime())} UTC; {machine}; one thread.\n\n"
    text = heading + table(results)
    folder = HERE / "results"
    folder.mkdir(exist_ok=True)
    (folder / "latest.md").write_text(text)
    (folder / "latest.json").write_text(json.dumps({"machine": machine, "results": results}, indent=1) + "\n")
    print(text)
    return 0


if __name__ == "__main__":
    sys.exit(main())
