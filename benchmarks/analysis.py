"""Time and memory of whole `posstats` processes on a block of the size of the paper's area 1."""

import argparse
import resource
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

COMMAND = Path(sys.executable).with_name("posstats")


def seconds(*arguments: str | Path) -> float:
    start = time.perf_counter()
    subprocess.run([COMMAND, *arguments], check=True, stdout=subprocess.DEVNULL)
    return time.perf_counter() - start


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--runs", type=int, default=5)
    runs = parser.parse_args().runs
    with tempfile.TemporaryDirectory() as folder:
        block, out = Path(folder) / "block", Path(folder) / "out"
        simulation = seconds("simulate", "--scenario", "area1", "--out", block)
        print(f"posstats simulate: {simulation:.1f} s")
        timings = {
            "posstats --help": ("--help",),
            "posstats check": ("check", block),
            "posstats analyse, with PDF": ("analyse", block, "--out", out),
        }
        for name, arguments in timings.items():
            seconds(*arguments)
            measured = [seconds(*arguments) for _ in range(runs)]
            median = statistics.median(measured)
            print(f"{name}: median {median:.2f} s (largest {max(measured):.2f} s)")
    peak_kib = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss
    print(f"largest process: {peak_kib / 1024**2:.2f} GiB")


if __name__ == "__main__":
    main()
