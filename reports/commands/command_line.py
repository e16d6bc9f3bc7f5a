"""What all commands share: paths, errors, where output goes."""

from collections.abc import Callable
from functools import wraps
from pathlib import Path
from typing import Any, get_args

import click

from posstats.errors import PosstatsError


class _Folder(click.Path):
    """A path that is not empty: an empty one would be the working directory."""

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        if value == "":
            self.fail("is empty; . is the working directory", param, ctx)
        return super().convert(value, param, ctx)


FOLDER = _Folder(path_type=Path)


def choice(literal: Any) -> click.Choice[str]:
    """The choices of a Literal type of `posstats.settings`."""
    return click.Choice(get_args(literal))


def named(literal: Any) -> str:
    """How help names what is one of a Literal type's values, or a file."""
    return "|".join((*get_args(literal), "FILE"))


def clear_errors(command: Callable[..., None]) -> Callable[..., None]:
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


def default_out(block: Path) -> Path:
    """Where output of a block folder goes if nobody says."""
    return Path("out") / block.resolve().name
