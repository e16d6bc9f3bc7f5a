"""Time and memory of whole `posstats` processes: a block of area 1's size, and the experiment."""

import argparse
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

COMMAND = Path(sys.executable).with_name("posstats")


def run(*arguments: str | Path) -> tuple[float, float]:
    """Seconds, and the largest memory (GiB) of the process and its children together."""
    start = time.perf_counter()
    process = subprocess.Popen([COMMAND, *arguments], stdout=subprocess.DEVNULL)
    peak_kib = 0
    while process.poll() is None:
        peak_kib = max(peak_kib, sum(map(proportional_kib, family(process.pid))))
        time.sleep(0.1)
    if process.returncode:
        raise SystemExit(f"posstats {arguments[0]} failed")
    return time.perf_counter() - start, peak_kib / 1024**2


def family(pid: int) -> Iterator[int]:
    """A process and its descendants."""
    yield pid
    try:
        children = Path(f"/proc/{pid}/task/{pid}/children").read_text()
    except OSError:  # it has just ended
        return
    for child in children.split():
        yield from family(int(child))


def proportional_kib(pid: int) -> int:
    """Memory of a process, with its share of what it shares (PSS)."""
    try:
        lines = Path(f"/proc/{pid}/smaps_rollup").read_text().splitlines()
    except OSError:  # it has just ended
        return 0
    return next(int(line.split()[1]) for line in lines if line.startswith("Pss:"))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--runs", type=int, default=5)
    runs = parser.parse_args().runs
    with tempfile.TemporaryDirectory() as folder:
        block, out = Path(folder) / "block", Path(folder) / "out"
        seconds, _ = run("simulate", "--area", "1", "--out", block)
        print(f"posstats simulate: {seconds:.1f} s")
        timings = {
            "posstats --help": ("--help",),
            "posstats check": ("check", block),
            "posstats analyse, with PDF": ("analyse", block, "--out", out),
            "posstats paper, with PDF": ("paper", "--out", out / "paper"),
        }
        for name, arguments in timings.items():
            run(*arguments)
            measured = [run(*arguments) for _ in range(runs)]
            times, peaks = zip(*measured, strict=True)
            print(
                f"{name}: median {statistics.median(times):.2f} s (largest {max(times):.2f} s), "
                f"{max(peaks):.2f} GiB"
            )


if __name__ == "__main__":
    main()
