"""What all commands share: paths, errors, where output goes."""

from collections.abc import Callable, Iterator
from functools import wraps
from os import PathLike
from pathlib import Path
from typing import ParamSpec, TypeVar, get_args

import click

from posstats.contract.choices import DEFAULT_LANGUAGE, PAPER_SEED, Language
from posstats.errors import PosstatsError

_Command = TypeVar("_Command", bound=Callable[..., object])
_Given = ParamSpec("_Given")


class _Folder(click.Path):
    """A path that is not empty: an empty one would be the working directory."""

    def convert(
        self,
        value: str | PathLike[str],
        param: click.Parameter | None,
        ctx: click.Context | None,
    ) -> str | bytes | PathLike[str]:
        if value == "":
            self.fail("is empty; . is the working directory", param, ctx)
        return super().convert(value, param, ctx)


FOLDER = _Folder(path_type=Path)


def choice(literal: object) -> click.Choice[str]:
    """The choices of a Literal type of `posstats.contract.choices`."""
    return click.Choice(get_args(literal))


def named(literal: object) -> str:
    """How help names what is one of a Literal type's values, or a file."""
    return "|".join((*get_args(literal), "FILE"))


block_argument = click.argument("block", type=FOLDER)
out_option = click.option(
    "--out", type=FOLDER, help="Output folder.  [default: out/NAME of the block folder]"
)
calibration_option = click.option(
    "--calibration", type=FOLDER, metavar="FILE", help="Take a calibration off the POS."
)
seed_option = click.option(
    "--seed",
    type=click.IntRange(min=0),
    default=PAPER_SEED,
    show_default=True,
    help="Of the simulation.",
)


def language_option(of: str) -> Callable[[_Command], _Command]:
    """The option of a command that writes or says something in a language: `of` what it is."""
    return click.option(
        "--language", type=choice(Language), default=DEFAULT_LANGUAGE, show_default=True, help=of
    )


def no_pdf_option(document: str) -> Callable[[_Command], _Command]:
    """The option of a command that writes a document of this name."""
    return click.option("--no-pdf", is_flag=True, help=f"Write the {document} as HTML only.")


def clear_errors(command: Callable[_Given, None]) -> Callable[_Given, None]:
    """Turn the package's errors and the system's into one message and exit code 1."""

    @wraps(command)
    def run(*args: _Given.args, **kwargs: _Given.kwargs) -> None:
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


def default_out(block: Path) -> Path:
    """Where output of a block folder goes if nobody says."""
    return Path("out") / block.resolve().name


def written(out: Path, name: str, missing: str, *, pdf: bool) -> Iterator[str]:
    """The last lines of a summary: where a report is, and what is missing for its PDF."""
    yield ""
    if missing:
        yield missing
    files = [out / f"{name}.html", *([out / f"{name}.pdf"] if pdf and not missing else [])]
    yield f"report: {', '.join(map(str, files))}"
