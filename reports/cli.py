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
    type=click.Choice(["coplanarity", "bundle", "adjusted"]),
    default="coplanarity",
    show_default=True,
    help="Angle errors from the tie points, from a bundle adjustment with control points, or "
    "against adjusted.csv.",
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
@click.option("--calibration", type=FOLDER, metavar="FILE", help="Take a calibration off the POS.")
@click.option("--no-pdf", is_flag=True, help="Write the report as HTML only.")
@_clear_errors
def analyse(
    block: Path,
    out: Path | None,
    rules: str,
    scope: Literal["block", "strip"],
    errors: Literal["coplanarity", "bundle", "adjusted"],
    frame: Literal["ground", "camera", "auto"],
    robust: bool,
    calibration: Path | None,
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
    target = out or _default_out(block)
    for line in analyse_block(block, target, settings, calibration, pdf=not no_pdf):
        click.echo(line)


@cli.command()
@click.argument("block", type=FOLDER)
@click.option("--out", type=FOLDER, help="Output folder.  [default: out/NAME of the block folder]")
@click.option(
    "--control",
    metavar="none|centre|corners|all|FILE",
    help="Control points chosen among all ground points, or a file of ids, one on a line; the "
    "others are check points.  [default: the roles of ground_points.csv]",
)
@click.option(
    "--drift",
    type=click.Choice(["none", "block", "strip"]),
    default="block",
    show_default=True,
    help="Shifts and drifts of GNSS and IMU, and the boresight: none, or of the block or strips.",
)
@click.option(
    "--self-calibration",
    type=click.Choice(["none", "bauer", "brown"]),
    default="none",
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
@click.option("--calibration", type=FOLDER, metavar="FILE", help="Take a calibration off the POS.")
@click.option(
    "--robust/--no-robust",
    default=True,
    show_default=True,
    help="Take out contradicting image rays before data snooping.",
)
@click.option("--no-pdf", is_flag=True, help="Write the report as HTML only.")
@_clear_errors
def adjust(
    block: Path,
    out: Path | None,
    control: str | None,
    drift: Literal["none", "block", "strip"],
    self_calibration: Literal["none", "bauer", "brown"],
    camera: bool,
    lever_arm: bool,
    estimate_weights: bool,
    drop_insignificant: bool,
    calibration: Path | None,
    robust: bool,
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
    from posstats.adjustment import AdjustmentSettings

    from .adjust_command import adjust_folder, control_choice

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
    target = out or _default_out(block)
    for line in adjust_folder(block, target, settings, calibration, pdf=not no_pdf):
        click.echo(line)


@cli.command()
@click.argument("block", type=FOLDER)
@click.option("--out", type=FOLDER, required=True, metavar="FILE", help="TOML file to write.")
@click.option(
    "--control",
    metavar="none|centre|corners|all|FILE",
    help="Control points, as of adjust.  [default: the roles of ground_points.csv]",
)
@click.option(
    "--drift",
    type=click.Choice(["block", "strip"]),
    default="strip",
    show_default=True,
    help="Shifts and drifts of the calibration flight itself: of the block or of each strip.",
)
@click.option("--lever-arm", is_flag=True, help="Estimate the lever arm too.")
@_clear_errors
def calibrate(
    block: Path,
    out: Path,
    control: str | None,
    drift: Literal["block", "strip"],
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
    from posstats.adjustment import AdjustmentSettings

    from .adjust_command import control_choice
    from .calibrate_command import calibrate_folder

    settings = AdjustmentSettings(control=control_choice(control), drift=drift, lever_arm=lever_arm)
    for line in calibrate_folder(block, out, settings):
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
@click.option("--out", type=FOLDER, default="out/wucaps", show_default=True, help="Output folder.")
@click.option(
    "--seed", type=click.IntRange(min=0), default=1, show_default=True, help="Of the simulation."
)
@click.option("--no-pdf", is_flag=True, help="Write the report as HTML only.")
@_clear_errors
def wucaps(out: Path, seed: int, no_pdf: bool) -> None:
    """Reproduce the second source paper: POS errors removed in the bundle adjustment.

    Needs no input. Simulates a flat block at 1:2 500 and a mountainous one at 1:32 000, orients
    them in every way the paper compares, and writes wucaps.html, wucaps.pdf and wucaps.json.
    Files of the same names are replaced.

    \b
    Example:
      posstats wucaps --out wucaps --seed 7
    """
    from .wucaps_command import reproduce_wucaps

    for line in reproduce_wucaps(out, seed, pdf=not no_pdf):
        click.echo(line)


@cli.command()
@click.option(
    "--scenario",
    type=FOLDER,
    metavar="FILE",
    help="Scenario file (docs/simulation.md), or one of area1, area1-small, area2, "
    "area3, wucaps-flat, wucaps-mountain.",
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


class _Length(click.ParamType):
    """A length with its unit, read as metres."""

    name = "length"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        from .accept_command import length_m

        if isinstance(value, float):
            return value
        try:
            return length_m(value)
        except ValueError as error:
            self.fail(str(error), param, ctx)


LENGTH = _Length()


@cli.command()
@click.argument("source", type=FOLDER, metavar="BLOCK|results.json")
@click.option("--profile", metavar="NAME|FILE", help="Profile to judge by: see posstats profiles.")
@click.option(
    "--contract",
    type=FOLDER,
    metavar="FILE",
    help="Contract (TOML): parties, product, and limits of its own that extend a profile.",
)
@click.option(
    "--class",
    "class_both",
    type=LENGTH,
    metavar="LENGTH",
    help="Accuracy class of the product, horizontal and vertical, such as 10cm.",
)
@click.option("--class-h", type=LENGTH, metavar="LENGTH", help="Horizontal accuracy class.")
@click.option("--class-v", type=LENGTH, metavar="LENGTH", help="Vertical accuracy class.")
@click.option("--gsd", type=LENGTH, metavar="LENGTH", help="Ground sampling distance.")
@click.option("--scale", type=click.FloatRange(1), metavar="N", help="Map scale 1:N, such as 5000.")
@click.option("--terrain", type=click.Choice(["flat", "mountain"]), help="Kind of terrain.")
@click.option(
    "--orientation",
    type=click.Choice(["pos", "selected", "adjusted", "bundle"]),
    help="Orientation to judge.  [default: the first of bundle, adjusted, selected, pos that the "
    "results hold]",
)
@click.option(
    "--language",
    type=click.Choice(["en", "zh"]),
    default="en",
    show_default=True,
    help="Of the document.",
)
@click.option(
    "--templates",
    type=FOLDER,
    metavar="DIR",
    help="Folder with a logo, a letterhead or other templates of yours.",
)
@click.option("--out", type=FOLDER, help="Output folder.  [default: out/NAME of the block folder]")
@click.option("--no-pdf", is_flag=True, help="Write the document as HTML only.")
@click.pass_context
@_clear_errors
def accept(
    context: click.Context,
    source: Path,
    profile: str | None,
    contract: Path | None,
    class_both: float | None,
    class_h: float | None,
    class_v: float | None,
    gsd: float | None,
    scale: float | None,
    terrain: Literal["flat", "mountain"] | None,
    orientation: str | None,
    language: str,
    templates: Path | None,
    out: Path | None,
    no_pdf: bool,
) -> None:
    """Judge a block, or its results.json, by a standard or contract, and certify the verdict.

    Writes acceptance.html, acceptance.pdf (for the archive, with all data inside) and
    acceptance.json. Files of the same names are replaced. Exit code 0: accepted; 3: rejected;
    4: not assessable; 1: an error.

    \b
    Example:
      posstats accept flight7 --profile asprs-2024 --class 10cm
      posstats accept report/results.json --contract contract.toml --language zh
    """
    from posstats.acceptance.product import Product

    from .accept_command import EXIT_CODES, Wish, judge

    if class_both is not None and (class_h is not None or class_v is not None):
        raise click.UsageError("give either --class, or --class-h and --class-v")
    product = Product(
        class_h_m=class_both or class_h,
        class_v_m=class_both or class_v,
        gsd_m=gsd,
        map_scale=scale,
        terrain=terrain,
    )
    wish = Wish(profile, contract, product, orientation, language, templates)
    verdict, lines = judge(source, out or _default_out(_block_of(source)), wish, pdf=not no_pdf)
    for line in lines:
        click.echo(line)
    context.exit(EXIT_CODES[verdict])


def _block_of(source: Path) -> Path:
    """The block folder, or the folder of a results.json: what an output folder is named after."""
    return source if source.is_dir() else source.resolve().parent


@cli.command()
@click.argument("name", required=False)
@_clear_errors
def profiles(name: str | None) -> None:
    """List the acceptance profiles, or print the profile NAME with its sources.

    NAME may also be a contract or profile file, which is validated: exit code 1 with the findings
    if it is refused.

    \b
    Example:
      posstats profiles
      posstats profiles asprs-2024
      posstats profiles contract.toml
    """
    from .profiles_command import describe_profile, list_profiles

    for line in list_profiles() if name is None else describe_profile(name):
        click.echo(line)


@cli.command()
@click.argument("file", type=FOLDER, metavar="FILE.pdf")
@click.option(
    "--p12", type=FOLDER, required=True, metavar="KEY.p12", help="Private key and certificate."
)
@click.option(
    "--passphrase-file",
    type=FOLDER,
    metavar="FILE",
    help="Its first line opens the key.  [default: ask for the passphrase]",
)
@click.option("--out", type=FOLDER, required=True, metavar="SIGNED.pdf", help="File to write.")
@_clear_errors
def sign(file: Path, p12: Path, passphrase_file: Path | None, out: Path) -> None:
    """Sign the acceptance document FILE.pdf, as a copy; the original is left alone.

    Needs the optional extra: pip install 'posstats[sign]'. No network is used. A document that is
    signed already gets a further signature.

    \b
    Example:
      posstats sign acceptance.pdf --p12 surveyor.p12 --out acceptance-signed.pdf
    """
    from .sign_command import sign_file

    for line in sign_file(file, p12, out, passphrase_file, _ask_passphrase):
        click.echo(line)


@cli.command()
@click.argument("file", type=FOLDER, metavar="FILE.pdf")
@click.option(
    "--inputs", type=FOLDER, metavar="BLOCK", help="Compare with this block folder, and recompute."
)
@click.option(
    "--trust", type=FOLDER, metavar="CERT.pem", help="Whom to trust: certificates of authorities."
)
@_clear_errors
def verify(file: Path, inputs: Path | None, trust: Path | None) -> None:
    """Verify the acceptance document FILE.pdf: a line a question.

    Is it signed, by whom, and unchanged since; do the embedded data agree with each other, with
    the pages, and with the input files. Exit code 0 if all that was asked holds, 1 otherwise.

    \b
    Example:
      posstats verify acceptance-signed.pdf --inputs flight7 --trust authority.pem
    """
    from .verification import holds
    from .verify_command import verify_file

    answers = verify_file(file, inputs, trust)
    for each in answers:
        click.echo(each.line)
    if not holds(answers):
        sys.exit(1)


def _ask_passphrase() -> str:
    """Hidden, from a terminal only: a pipe would leave it in a script."""
    if not sys.stdin.isatty():
        raise PosstatsError("no terminal to ask for the passphrase: give --passphrase-file")
    answer: str = click.prompt("Passphrase", hide_input=True, default="", show_default=False)
    return answer


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
