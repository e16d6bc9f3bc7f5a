"""Put kept faults into copies of the source, one at a time, and see whether the tests notice.

A mutant of mutants.toml replaces one piece of text in one file. The tests that it names are run
in a copy of the working tree that holds it: they kill the mutant if they fail. The tree itself
is never changed. Exits with 1 if a mutant survives, if its text is not found exactly once (it is
stale), or if it does not even start; with 2 if tests fail without any mutant.

    python benchmarks/mutants.py                  all
    python benchmarks/mutants.py margin reports/  those with one of these in their name or file
"""

import argparse
import os
import shutil
import subprocess
import sys
import tempfile
import tomllib
from collections.abc import Iterable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from itertools import chain
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
KEPT = Path(__file__).with_name("mutants.toml")
COPIED = (
    *("posstats", "reports", "templates", "tests", "benchmarks", "docs"),
    *("pyproject.toml", "README.md", "CHANGELOG.md", "Makefile"),
)
SEPARATE = ("reports", "templates")  # packages inside posstats that lie beside it
MOST_S = 600.0  # a mutant may never come to an end
PASSED, FAILED = 0, 1  # exit codes of pytest


@dataclass(frozen=True)
class Mutant:
    """A fault, as mutants.toml states it.

    Attributes
    ----------
    name
        What is wrong in it, in a few words.
    harm
        What it would do to a user.
    file, old, new
        Where, what is there, and what the mutant has instead.
    tests
        Files or single tests that kill it.
    """

    name: str
    harm: str
    file: str
    old: str
    new: str
    tests: tuple[str, ...]

    def count(self, tree: Path = ROOT) -> int:
        """How often its old text is in its file; it is stale if not once."""
        file = tree / self.file
        return file.read_text(encoding="utf-8").count(self.old) if file.is_file() else 0

    def put_into(self, tree: Path) -> None:
        """Change the file in a copy of the tree, without what was compiled of it."""
        file = tree / self.file
        text = file.read_text(encoding="utf-8")
        for compiled in file.parent.glob(f"__pycache__/{file.stem}.*"):
            compiled.unlink()
        file.write_text(text.replace(self.old, self.new), encoding="utf-8")


def read(file: Path = KEPT) -> tuple[Mutant, ...]:
    """The kept mutants."""
    rows = tomllib.loads(file.read_text(encoding="utf-8"))["mutant"]
    return tuple(Mutant(**(row | {"tests": tuple(row["tests"])})) for row in rows)


def copy_to(folder: Path) -> Path:
    """Copy the tree so that `posstats` and all that is in it are imported from there."""
    for name in COPIED:
        source = ROOT / name
        if source.is_dir():
            shutil.copytree(source, folder / name)
        else:
            shutil.copy2(source, folder / name)
    for name in SEPARATE:
        (folder / "posstats" / name).symlink_to(Path("..", name), target_is_directory=True)
    return folder


def run_tests(tree: Path, tests: Sequence[str], most_s: float | None = MOST_S) -> int | None:
    """Exit code of pytest over the tests of a copy; None if it had to be stopped."""
    surroundings = os.environ | {"PYTHONPATH": str(tree), "OPENBLAS_NUM_THREADS": "1"}
    command = [sys.executable, "-m", "pytest", "-x", "-q", "-p", "no:cacheprovider", *tests]
    try:
        done = subprocess.run(
            command, cwd=tree, env=surroundings, capture_output=True, timeout=most_s, check=False
        )
    except subprocess.TimeoutExpired:
        return None
    if done.returncode not in (PASSED, FAILED) or (done.returncode == FAILED and most_s is None):
        print(done.stdout.decode()[-3000:], file=sys.stderr)
    return done.returncode


def judge(mutant: Mutant, sound: Path) -> str:
    """What became of a mutant: killed, SURVIVED, STALE or BROKEN (its tests do not start).

    It is put into a copy of the sound tree. Times of files are kept: kernels that were compiled
    there stay valid for files that do not change, and for no others.
    """
    if (n := mutant.count(sound)) != 1:
        return f"STALE ({n} times in {mutant.file})"
    with tempfile.TemporaryDirectory(prefix="mutant-") as folder:
        tree = Path(shutil.copytree(sound, Path(folder, "tree"), symlinks=True))
        mutant.put_into(tree)
        code = run_tests(tree, mutant.tests)
    if code in (None, FAILED):
        return "killed"
    return "SURVIVED" if code == PASSED else "BROKEN"


def is_sound(tree: Path, mutants: Iterable[Mutant]) -> bool:
    """Whether all tests pass in a copy without a mutant, and whether they run in that copy."""
    shown = "import posstats.reports as r; print(r.__file__)"
    found = subprocess.run(
        [sys.executable, "-c", shown], cwd=tree, env=os.environ | {"PYTHONPATH": str(tree)},
        capture_output=True, text=True, check=True,
    )  # fmt: skip
    if not found.stdout.startswith(str(tree)):
        raise SystemExit(f"a copy imports {found.stdout.strip()}, which is not in it")
    tests = tuple(dict.fromkeys(chain.from_iterable(each.tests for each in mutants)))
    return run_tests(tree, tests, most_s=None) == PASSED


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument(
        "words", nargs="*", help="only those with one of these in their name or file"
    )
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), help="mutants at a time")
    asked = parser.parse_args()
    mutants = [
        each for each in read()
        if not asked.words or any(word in f"{each.name} {each.file}" for word in asked.words)
    ]  # fmt: skip
    killed = 0
    with tempfile.TemporaryDirectory(prefix="mutant-none-") as folder:
        sound = copy_to(Path(folder).resolve())
        if not is_sound(sound, mutants):
            print("the tests fail without any mutant")
            return 2
        with ThreadPoolExecutor(asked.jobs) as pool:
            judged = pool.map(lambda each: judge(each, sound), mutants)
            for mutant, found in zip(mutants, judged, strict=True):
                killed += found == "killed"
                print(f"{found:8}  {mutant.name}", flush=True)
    print(f"{killed} of {len(mutants)} mutants killed, {len(mutants) - killed} not")
    return 0 if killed == len(mutants) else 1


if __name__ == "__main__":
    sys.exit(main())
