"""The `posstats` command."""

import os
import signal
import sys
from pathlib import Path
from types import FrameType
from typing import get_args

import click

from posstats.contract.choices import (
    DEFAULT_CALIBRATION_DRIFT,
    DEFAULT_DRIFT,
    DEFAULT_ERRORS,
    DEFAULT_FRAME,
    DEFAULT_ROBUST,
    DEFAULT_RULES,
    DEFAULT_SCOPE,
    DEFAULT_SELF_CALIBRATION,
    AngleErrorSource,
    ControlSubset,
    DriftScope,
    FrameChoice,
    Language,
    RuleSetName,
    ScenarioName,
    Scope,
    SelfCalibration,
)
from posstats.version import __version__

from . import acceptance_group as acceptance_cli
from .command_line import (
    FOLDER,
    block_argument,
    calibration_option,
    choice,
    clear_errors,
    default_out,
    language_option,
    named,
    no_pdf_option,
    out_option,
    seed_option,
)


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
@block_argument
@out_option
@click.option(
    "--rules",
    default=DEFAULT_RULES,
    show_default=True,
    metavar=named(RuleSetName),
    help="Which angles to correct: the paper's rule, the strict rule, or a TOML file.",
)
@click.option(
    "--scope",
    type=choice(Scope),
    default=DEFAULT_SCOPE,
    show_default=True,
    help="One regression line for the block, or one per strip.",
)
@click.option(
    "--errors",
    type=choice(AngleErrorSource),
    default=DEFAULT_ERRORS,
    show_default=True,
    help="Angle errors from the tie points, from a bundle adjustment with control points, or "
    "against adjusted.csv.",
)
@click.option(
    "--frame",
    type=choice(FrameChoice),
    default=DEFAULT_FRAME,
    show_default=True,
    help="Frame of the regression; auto takes the one that fits better out of sample.",
)
@click.option(
    "--robust/--no-robust",
    default=DEFAULT_ROBUST,
    show_default=True,
    help="Resist blunders in the tie points, or plain least squares.",
)
@calibration_option
@language_option("Of the report and its figures; the terminal and results.json stay English.")
@no_pdf_option("report")
@clear_errors
def analyse(
    block: Path,
    out: Path | None,
    rules: str,
    scope: Scope,
    errors: AngleErrorSource,
    frame: FrameChoice,
    robust: bool,
    calibration: Path | None,
    language: Language,
    no_pdf: bool,
) -> None:
    """Analyse the block folder BLOCK and write its report.

    Writes results.json, corrected_orientations.csv, tables/*.csv, figures/*.svg, report.html
    and report.pdf. Files of the same names are replaced.

    \b
    Example:
      posstats analyse flight7 --out flight7/report --rules strict --frame auto
    """
    from posstats.settings import Settings

    from .analyse import analyse_block

    settings = Settings(rules=rules, scope=scope, errors=errors, frame=frame, robust=robust)
    target = out or default_out(block)
    for line in analyse_block(
        block, target, settings, calibration, language=language, pdf=not no_pdf
    ):
        click.echo(line)


@cli.command()
@block_argument
@out_option
@click.option(
    "--control",
    metavar=named(ControlSubset),
    help="Control points chosen among all ground points, or a file of ids, one on a line; the "
    "others are check points.  [default: the roles of ground_points.csv]",
)
@click.option(
    "--drift",
    type=choice(DriftScope),
    default=DEFAULT_DRIFT,
    show_default=True,
    help="Shifts and drifts of GNSS and IMU, and the boresight: none, or of the block or strips.",
)
@click.option(
    "--self-calibration",
    type=choice(SelfCalibration),
    default=DEFAULT_SELF_CALIBRATION,
    show_default=True,
    help="Image deformation.",
)
@click.option(
    "--camera", is_flag=True, help="Principal distance and principal point are unknown too."
)
@click.option("--lever-arm", is_flag=True, help="The lever arm is unknown too.")
@click.option(
    "--estimate-weights", is_flag=True, help="Estimate the accuracy of images, GNSS, IMU, control."
)
@click.option(
    "--drop-insignificant", is_flag=True, help="Drop free parameters that are not significant."
)
@calibration_option
@click.option(
    "--robust/--no-robust",
    default=DEFAULT_ROBUST,
    show_default=True,
    help="Take out contradicting image rays before data snooping.",
)
@language_option(
    "Of the report, or of why there is none; the terminal and adjustment.json stay English."
)
@no_pdf_option("report")
@clear_errors
def adjust(
    block: Path,
    out: Path | None,
    control: str | None,
    drift: DriftScope,
    self_calibration: SelfCalibration,
    camera: bool,
    lever_arm: bool,
    estimate_weights: bool,
    drop_insignificant: bool,
    calibration: Path | None,
    robust: bool,
    language: Language,
    no_pdf: bool,
) -> None:
    """Adjust the block folder BLOCK as a bundle with its POS, and write a report.

    Writes adjustment.json, adjusted_orientations.csv, points.csv, adjustment.html and
    adjustment.pdf. Files of the same names are replaced; if the adjustment fails, nothing is
    written.

    \b
    Example:
      posstats adjust flight7 --control corners --drift strip --out flight7/adjusted
    """
    from posstats.settings import AdjustmentSettings

    from .adjust import adjust_folder, control_choice

    settings = AdjustmentSettings(
        control=control_choice(control),
        drift=drift,
        self_calibration=self_calibration,
        camera=camera,
        lever_arm=lever_arm,
        estimate_weights=estimate_weights,
        drop_insignificant=drop_insignificant,
        robust=robust,
    )
    target = out or default_out(block)
    for line in adjust_folder(
        block, target, settings, calibration, language=language, pdf=not no_pdf
    ):
        click.echo(line)


@cli.command()
@block_argument
@click.option("--out", type=FOLDER, required=True, metavar="FILE", help="TOML file to write.")
@click.option(
    "--control",
    metavar=named(ControlSubset),
    help="Control points, as of adjust.  [default: the roles of ground_points.csv]",
)
@click.option(
    "--drift",
    type=choice(Scope),
    default=DEFAULT_CALIBRATION_DRIFT,
    show_default=True,
    help="Shifts and drifts of the calibration flight itself: of the block or of each strip.",
)
@click.option("--lever-arm", is_flag=True, help="Estimate the lever arm too.")
@clear_errors
def calibrate(
    block: Path,
    out: Path,
    control: str | None,
    drift: Scope,
    lever_arm: bool,
) -> None:
    """Estimate the boresight of the POS from the calibration flight BLOCK.

    Writes boresight and lever arm with their covariance, and the block and camera they belong to.
    Other commands take the file with --calibration.

    \b
    Example:
      posstats calibrate field --out boresight.toml
      posstats analyse flight7 --calibration boresight.toml
    """
    from posstats.settings import AdjustmentSettings

    from .adjust import control_choice
    from .calibrate import calibrate_folder

    settings = AdjustmentSettings(control=control_choice(control), drift=drift, lever_arm=lever_arm)
    for line in calibrate_folder(block, out, settings):
        click.echo(line)


@cli.command()
@click.option("--out", type=FOLDER, default="out/paper", show_default=True, help="Output folder.")
@seed_option
@language_option("Of the report; the terminal and comparison.json stay English.")
@no_pdf_option("report")
@clear_errors
def paper(out: Path, seed: int, language: Language, no_pdf: bool) -> None:
    """Reproduce the source paper's Tables 1-4 and Figures 1-3 on three simulated test areas.

    Needs no input. Writes paper.html, paper.pdf, comparison.json (every published number beside
    the reproduced one), and area1, area2, area3 with results.json, corrected_orientations.csv,
    tables and figures as analyse writes them. Files of the same names are replaced.

    \b
    Example:
      posstats paper --out paper --seed 7
    """
    from .paper import reproduce_paper

    for line in reproduce_paper(out, seed, language=language, pdf=not no_pdf):
        click.echo(line)


@cli.command()
@click.option("--out", type=FOLDER, default="out/wucaps", show_default=True, help="Output folder.")
@seed_option
@language_option("Of the report; the terminal and wucaps.json stay English.")
@no_pdf_option("report")
@clear_errors
def wucaps(out: Path, seed: int, language: Language, no_pdf: bool) -> None:
    """Reproduce the second source paper: POS errors removed in the bundle adjustment.

    Needs no input. Simulates a flat block at 1:2 500 and a mountainous one at 1:32 000, orients
    them in every way the paper compares, and writes wucaps.html, wucaps.pdf and wucaps.json.
    Files of the same names are replaced.

    \b
    Example:
      posstats wucaps --out wucaps --seed 7
    """
    from .wucaps import reproduce_wucaps

    for line in reproduce_wucaps(out, seed, language=language, pdf=not no_pdf):
        click.echo(line)


@cli.command()
@click.option(
    "--scenario",
    type=FOLDER,
    metavar="FILE",
    help=f"Scenario file (docs/simulation.md), or one of {', '.join(get_args(ScenarioName))}.",
)
@click.option("--area", type=click.IntRange(1, 3), help="A test area of the source paper.")
@click.option("--out", type=FOLDER, required=True, help="Block folder to write.")
@click.option("--seed", type=click.IntRange(min=0), help="Random seed instead of the scenario's.")
@clear_errors
def simulate(scenario: Path | None, area: int | None, out: Path, seed: int | None) -> None:
    """Simulate a block of known truth, as a block folder.

    Give either a scenario or the number of a test area.

    \b
    Example:
      posstats simulate --area 1 --out block
      posstats simulate --scenario area1-small --out block --seed 7
    """
    from posstats.synthetic import load_scenario, shipped_scenario

    from .blocks import simulate_block

    if scenario is not None and area is None:
        chosen = load_scenario(scenario)
    elif area is not None and scenario is None:
        chosen = shipped_scenario(f"area{area}")
    else:
        raise click.UsageError("give exactly one of --scenario and --area")
    for line in simulate_block(chosen, out, seed):
        click.echo(line)


@cli.command()
@block_argument
@clear_errors
def check(block: Path) -> None:
    """Validate the block folder BLOCK and print a summary.

    Exit code 1 with the findings if the block is refused.

    \b
    Example:
      posstats check flight7
    """
    from .blocks import check_block

    for line in check_block(block):
        click.echo(line)


for command in acceptance_cli.COMMANDS:
    cli.add_command(command)


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
