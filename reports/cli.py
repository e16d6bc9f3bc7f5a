"""The `posstats` command."""

import os
import signal
import sys
from collections.abc import Callable
from functools import wraps
from pathlib import Path
from types import FrameType
from typing import Any, Literal

import click

from posstats import __version__
from posstats.errors import PosstatsError


class _Folder(click.Path):
    """A path that is not empty: an empty one would be the working directory."""

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        if value == "":
            self.fail("is empty; . is the working directory", param, ctx)
        return super().convert(value, param, ctx)


FOLDER = _Folder(path_type=Path)


def _clear_errors(command: Callable[..., None]) -> Callable[..., None]:
    """Turn the package's errors and the system's into one message and exit code 1."""

    @wraps(command)
    def run(*args: Any, **kwargs: Any) -> None:
        try:
            command(*args, **kwargs)
        except PosstatsError as error:
            raise click.ClickException(str(error)) from error
        except OSError as error:
            where = f": {error.filename}" if error.filename else ""
            raise click.ClickException(f"{error.strerror or error}{where}") from error
        except MemoryError as error:
            raise click.ClickException("not enough memory for this block") from error

    return run


@click.group(context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 100})
@click.version_option(__version__, prog_name="posstats")
def cli() -> None:
    """Measure, explain and correct the errors of GNSS/INS orientations of aerial photographs.

    \b
    Example:
      posstats simulate --scenario area1-small --out block
      posstats check block
      posstats analyse block --out report
    """


@cli.command()
@click.argument("block", type=FOLDER)
@click.option("--out", type=FOLDER, help="Output folder.  [default: out/NAME of the block folder]")
@click.option(
    "--rules",
    default="paper",
    show_default=True,
    metavar="paper|strict|FILE",
    help="Which angles to correct: the paper's rule, the strict rule, or a TOML file.",
)
@click.option(
    "--scope",
    type=click.Choice(["block", "strip"]),
    default="block",
    show_default=True,
    help="One regression line for the block, or one per strip.",
)
@click.option(
    "--errors",
    type=click.Choice(["coplanarity", "adjusted"]),
    default="coplanarity",
    show_default=True,
    help="Angle errors from the tie points, or against adjusted.csv.",
)
@click.option(
    "--frame",
    type=click.Choice(["ground", "camera", "auto"]),
    default="ground",
    show_default=True,
    help="Frame of the regression; auto takes the one that fits better out of sample.",
)
@click.option(
    "--robust/--no-robust",
    default=True,
    show_default=True,
    help="Resist blunders in the tie points, or plain least squares.",
)
@click.option("--no-pdf", is_flag=True, help="Write the report as HTML only.")
@_clear_errors
def analyse(
    block: Path,
    out: Path | None,
    rules: str,
    scope: Literal["block", "strip"],
    errors: Literal["coplanarity", "adjusted"],
    frame: Literal["ground", "camera", "auto"],
    robust: bool,
    no_pdf: bool,
) -> None:
    """Analyse the block folder BLOCK and write its report.

    Writes results.json, corrected_orientations.csv, tables/*.csv, figures/*.svg, report.html
    and report.pdf. Files of the same names are replaced.

    \b
    Example:
      posstats analyse flight7 --out flight7/report --rules strict --frame auto
    """
    from posstats.analysis import Settings

    from .analyse_command import analyse_block

    settings = Settings(rules=rules, scope=scope, errors=errors, frame=frame, robust=robust)
    for line in analyse_block(block, out or _default_out(block), settings, pdf=not no_pdf):
        click.echo(line)


@cli.command()
@click.option("--out", type=FOLDER, default="out/paper", show_default=True, help="Output folder.")
@click.option(
    "--seed", type=click.IntRange(min=0), default=1, show_default=True, help="Of the simulation."
)
@click.option("--no-pdf", is_flag=True, help="Write the report as HTML only.")
@_clear_errors
def paper(out: Path, seed: int, no_pdf: bool) -> None:
    """Reproduce the source paper's Tables 1-4 and Figures 1-3 on three simulated test areas.

    Needs no input. Writes paper.html, paper.pdf, comparison.json (every published number beside
    the reproduced one), and area1, area2, area3 with results.json, corrected_orientations.csv,
    tables and figures as analyse writes them. Files of the same names are replaced.

    \b
    Example:
      posstats paper --out paper --seed 7
    """
    from .paper_command import reproduce_paper

    for line in reproduce_paper(out, seed, pdf=not no_pdf):
        click.echo(line)


@cli.command()
@click.option(
    "--scenario",
    type=FOLDER,
    metavar="FILE",
    help="Scenario file (docs/simulation.md), or one of area1, area1-small, area2, area3.",
)
@click.option("--area", type=click.IntRange(1, 3), help="A test area of the source paper.")
@click.option("--out", type=FOLDER, required=True, help="Block folder to write.")
@click.option("--seed", type=click.IntRange(min=0), help="Random seed instead of the scenario's.")
@_clear_errors
def simulate(scenario: Path | None, area: int | None, out: Path, seed: int | None) -> None:
    """Simulate a block of known truth, as a block folder.

    Give either a scenario or the number of a test area.

    \b
    Example:
      posstats simulate --area 1 --out block
      posstats simulate --scenario area1-small --out block --seed 7
    """
    from posstats.synthetic import load_scenario, shipped_scenario

    from .block_commands import simulate_block

    if scenario is not None and area is None:
        chosen = load_scenario(scenario)
    elif area is not None and scenario is None:
        chosen = shipped_scenario(f"area{area}")
    else:
        raise click.UsageError("give exactly one of --scenario and --area")
    for line in simulate_block(chosen, out, seed):
        click.echo(line)


@cli.command()
@click.argument("block", type=FOLDER)
@_clear_errors
def check(block: Path) -> None:
    """Validate the block folder BLOCK and print a summary.

    Exit code 1 with the findings if the block is refused.

    \b
    Example:
      posstats check flight7
    """
    from .block_commands import check_block

    for line in check_block(block):
        click.echo(line)


def _default_out(block: Path) -> Path:
    return Path("out") / block.resolve().name


def _terminate(_signal: int, _frame: FrameType | None) -> None:
    """Leave by an exception, so that temporary output is removed."""
    sys.exit(143)


def main() -> None:
    """Entry point of the `posstats` command."""
    signal.signal(signal.SIGTERM, _terminate)
    # No matrix here is worth two threads, and on a busy machine they wait for each other: one
    # factorisation was seen to take forty times as long. Read when NumPy is first imported.
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    cli()
