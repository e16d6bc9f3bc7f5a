"""The words of the report on an adjustment."""

from dataclasses import dataclass

from posstats.contract.adjustment import AdditionalParameter, Element
from posstats.contract.notice import Notice

from ..document import format as fmt
from ..document import words as document
from ..document.catalogue import catalogue
from .units import unit_of

DOMAINS = ("document", "notices", "adjustment")
_BLOCK = "block"


@dataclass(frozen=True)
class Words(document.Words):
    """The catalogue of the report, with the names of parameters."""

    def parameter(self, name: str) -> str:
        """A parameter as it is called in a sentence: ``omega drift``, ``GNSS X shift``."""
        source, _, rest = name.partition("_")
        if source in ("gnss", "imu"):
            of, _, kind = rest.partition("_")
            return self.text(f"parameter.{source}_{kind}", of=self.of("bundle_component", of))
        if name == "camera_c":
            return self.text("parameter.distance")
        of = rest.rpartition("_")[2]
        return self.text(f"parameter.{source}", of=self.known("bundle_component", of))

    def element(self, name: Element) -> str:
        """An element of an orientation."""
        return self.of("bundle_component", name)

    def scope(self, scope: str) -> str:
        """``block``, or the strip in words."""
        return self.text("scope.block") if scope == _BLOCK else self.text("scope.strip", id=scope)

    def yes(self, value: bool) -> str:
        """Yes or no."""
        return self.text("answer.yes" if value else "answer.no")

    def value(self, parameter: AdditionalParameter) -> str:
        """A parameter's value with its unit; drifts of angles in rad/s and degrees per hour."""
        if parameter.unit == "rad/s":
            return fmt.rate(parameter.value)
        unit = unit_of(parameter.unit)
        return fmt.with_unit(unit.scaled(parameter.value), unit.name)

    def _written(self, said: Notice, name: str, plain: bool) -> str:
        """A value of a notice; control points are counted, groups and units are named."""
        value = said.values[name]
        if name == "n_control" and isinstance(value, int):
            return self.counted("control.count", value) if value else self.text("control.no")
        if name == "groups" and isinstance(value, tuple):
            return self._row([self.of("weight", str(group)) for group in value])
        if name in ("angle_unit", "stated_unit"):
            return self.of("angle_unit", str(value))
        if name == "parameters" and isinstance(value, tuple):
            return self._row([str(each) for each in value])
        return super()._written(said, name, plain)


def words_in(language: str) -> Words:
    """The words in a language."""
    return Words(catalogue(language, *DOMAINS))
