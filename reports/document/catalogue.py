"""Every word of the reports: message catalogues (gettext), read with Babel.

Messages have symbolic ids such as ``verdict.accepted``, in English too: no wording stands in code.
Values are put in by name (`str.format`); plurals follow the rule in the catalogue's head. A
catalogue is made of domains, one file each: ``document`` for what all documents say, and one for
every kind of report.
"""

import gettext
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from functools import cache
from importlib import resources
from typing import get_args

from babel.messages.pofile import read_po

from posstats.contract.choices import Language
from posstats.errors import PosstatsError

LANGUAGES: tuple[Language, ...] = get_args(Language)
_PATH = "locale/{language}/LC_MESSAGES/{domain}.po"


class MissingMessageError(KeyError):
    """An id that a catalogue does not hold."""


@dataclass(frozen=True)
class Catalogue:
    """The messages of one language.

    `language` is ``en`` or ``zh``; `messages` holds the forms of each id, several only for plurals;
    `form_of` chooses the form for a count.
    """

    language: str
    messages: Mapping[str, tuple[str, ...]]
    form_of: Callable[[int], int]

    def text(self, message: str, /, **values: str) -> str:
        """A message with its values put in.

        Parameters
        ----------
        message
            The id.
        values
            Texts by the names of their places; numbers are formatted before.

        Raises
        ------
        MissingMessageError
            If there is no such message.
        """
        return self._forms(message)[0].format(**values)

    def plural(self, message: str, n: int, /, **values: str) -> str:
        """A message in the form for a count; the count itself is a value as any other.

        Where a message has one form, this is the form for every count.
        """
        forms = self._forms(message)
        return forms[min(self.form_of(n), len(forms) - 1)].format(**values)

    def of(self, family: str, key: str, /, **values: str) -> str:
        """The message of a family for a key of the data: ``of("verdict", "not assessable")``."""
        return self.text(name_in(family, key), **values)

    def holds(self, family: str, key: str) -> bool:
        """Whether a family has a message for a key."""
        return name_in(family, key) in self.messages

    def joined(self, words: Iterable[str]) -> str:
        """An enumeration: ``a, b and c``."""
        *head, last = list(words) or [""]
        between, final = self.text("list.between"), self.text("list.final")
        return f"{between.join(head)}{final}{last}" if head else last

    def _forms(self, message: str) -> tuple[str, ...]:
        try:
            return self.messages[message]
        except KeyError:
            raise MissingMessageError(f"{message} ({self.language})") from None


def name_in(family: str, key: str) -> str:
    """Id of the message of a family for a key, whose blanks become underscores."""
    return f"{family}.{key.replace(' ', '_')}"


@cache
def catalogue(language: str, *domains: str) -> Catalogue:
    """The catalogue of a language, read once.

    Parameters
    ----------
    language
        ``en`` or ``zh``.
    domains
        Names of the files that it is made of; an id stands in one of them only.

    Raises
    ------
    PosstatsError
        If there is no such language.
    """
    if language not in LANGUAGES:
        raise PosstatsError(f"no language {language!r}; there are {', '.join(LANGUAGES)}")
    parts = [_domain(language, domain) for domain in domains]
    messages = {name: forms for part in parts for name, forms in part.messages.items()}
    return Catalogue(language, messages, parts[0].form_of)


@cache
def _domain(language: str, domain: str) -> Catalogue:
    path = resources.files("posstats.reports").joinpath(
        _PATH.format(language=language, domain=domain)
    )
    with path.open("rb") as stream:
        read = read_po(stream, locale=language)
    messages = {_id(each.id): _forms(each.string) for each in read if each.id}
    return Catalogue(language, messages, gettext.c2py(read.plural_expr))


def _id(message: str | tuple[str, ...] | list[str]) -> str:
    return message if isinstance(message, str) else message[0]


def _forms(string: str | tuple[str, ...] | list[str] | None) -> tuple[str, ...]:
    return (string,) if isinstance(string, str) else tuple(string or ())
