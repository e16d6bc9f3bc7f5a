"""The commands of the acceptance: accept, profiles, sign, verify."""

import sys
from pathlib import Path
from typing import get_args

import click

from posstats.contract.choices import JudgedOrientation, Language, TerrainKind
from posstats.errors import PosstatsError

from .command_line import (
    FOLDER,
    choice,
    clear_errors,
    default_out,
    language_option,
    no_pdf_option,
    out_option,
)


class _Length(click.ParamType[float]):
    """A length with its unit, read as metres."""

    name = "length"

    def convert(
        self, value: str | float, param: click.Parameter | None, ctx: click.Context | None
    ) -> float:
        from .accept import length_m

        if isinstance(value, float):
            return value
        try:
            return length_m(value)
        except ValueError as error:
            self.fail(str(error), param, ctx)


LENGTH = _Length()

_WRITTEN_OR_SAID = "Of what is written or said."


@click.command()
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
@click.option("--terrain", type=choice(TerrainKind), help="Kind of terrain.")
@click.option(
    "--orientation",
    type=choice(JudgedOrientation),
    help=f"Orientation to judge.  [default: the first of {', '.join(get_args(JudgedOrientation))} "
    "that the results hold]",
)
@language_option(_WRITTEN_OR_SAID)
@click.option(
    "--templates",
    type=FOLDER,
    metavar="DIR",
    help="Folder with a logo, a letterhead or other templates of yours.",
)
@out_option
@no_pdf_option("document")
@click.pass_context
@clear_errors
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
    terrain: TerrainKind | None,
    orientation: JudgedOrientation | None,
    language: Language,
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

    from .accept import EXIT_CODES, Wish, judge

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
    verdict, lines = judge(source, out or default_out(_block_of(source)), wish, pdf=not no_pdf)
    for line in lines:
        click.echo(line)
    context.exit(EXIT_CODES[verdict])


def _block_of(source: Path) -> Path:
    """The block folder, or the folder of a results.json: what an output folder is named after."""
    return source if source.is_dir() else source.resolve().parent


@click.command()
@click.argument("name", required=False)
@clear_errors
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
    from .profiles import describe_profile, list_profiles

    for line in list_profiles() if name is None else describe_profile(name):
        click.echo(line)


@click.command()
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
@language_option(_WRITTEN_OR_SAID)
@clear_errors
def sign(
    file: Path, p12: Path, passphrase_file: Path | None, out: Path, language: Language
) -> None:
    """Sign the acceptance document FILE.pdf, as a copy; the original is left alone.

    Needs the optional extra: pip install 'posstats[sign]'. No network is used. A document that is
    signed already gets a further signature.

    \b
    Example:
      posstats sign acceptance.pdf --p12 surveyor.p12 --out acceptance-signed.pdf
    """
    from ..output import timestamp
    from ..verification.words import words_of
    from .sign import sign_file

    document_id = sign_file(file, p12, out, passphrase_file, _ask_passphrase, now=timestamp.clock())
    words = words_of(language)
    click.echo(words.text("signing.done", document_id=document_id, file=str(out)))


@click.command()
@click.argument("file", type=FOLDER, metavar="FILE.pdf")
@click.option(
    "--inputs", type=FOLDER, metavar="BLOCK", help="Compare with this block folder, and recompute."
)
@click.option(
    "--trust", type=FOLDER, metavar="CERT.pem", help="Whom to trust: certificates of authorities."
)
@click.option(
    "--templates",
    type=FOLDER,
    metavar="DIR",
    help="Templates that you know; pages of others are not believed.",
)
@language_option(_WRITTEN_OR_SAID)
@clear_errors
def verify(
    file: Path,
    inputs: Path | None,
    trust: Path | None,
    templates: Path | None,
    language: Language,
) -> None:
    """Verify the acceptance document FILE.pdf: a line a question.

    Is it signed, by whom, and unchanged since; do the embedded data agree with each other, with
    the pages, and with the input files. Exit code 0 if all that was asked holds, 1 otherwise.

    \b
    Example:
      posstats verify acceptance-signed.pdf --inputs flight7 --trust authority.pem
    """
    from ..output import timestamp
    from ..verification.questions import holds
    from ..verification.words import line, words_of
    from .verify import verify_file

    answers = verify_file(file, inputs, trust, templates, now=timestamp.clock())
    words = words_of(language)
    for each in answers:
        click.echo(line(words, each))
    if not holds(answers):
        sys.exit(1)


def _ask_passphrase() -> str:
    """Hidden, from a terminal only: a pipe would leave it in a script."""
    if not sys.stdin.isatty():
        raise PosstatsError("no terminal to ask for the passphrase: give --passphrase-file")
    answer: str = click.prompt("Passphrase", hide_input=True, default="", show_default=False)
    return answer


COMMANDS = (accept, profiles, sign, verify)
