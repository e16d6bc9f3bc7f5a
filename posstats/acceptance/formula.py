"""Limits as formulas of the product: read by a whitelist, never run as Python.

A formula holds numbers, the product's values (``class_h``, ``class_v``, ``gsd`` in metres,
``scale``, ``lot``), ``+ - * / ( )`` and a few functions. Its value has the unit of the quantity
that it limits; units are not carried through, so ``0.0005 * scale`` (0.5 mm on the map) is in
metres because the quantity is.
"""

import ast
import math
import operator
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import lru_cache
from types import MappingProxyType

from posstats.acceptance.product import FORMULA_NAMES, Product
from posstats.acceptance.published import gbt_sample_size
from posstats.errors import PosstatsError
from posstats.formats.hints import nearest, shown

_LARGEST = 1e9
"""Limits beyond this (m, px, counts) are slips of the pen."""
_MAX_LENGTH = 200
_MAX_DEPTH = 20
_NUMBER = r"(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][-+]?[0-9]+)?"
_TOKEN = re.compile(rf"[ \t]*(?:{_NUMBER}(?![\w.])|[A-Za-z_][A-Za-z_0-9]*(?![\w.])|[-+*/(),])")
_WITH_UNIT = re.compile(rf"\s*(?P<number>{_NUMBER})\s*(?P<unit>[^\W\d_]+|%)\s*")
_ALLOWED = (
    f"numbers, {', '.join(FORMULA_NAMES)}, + - * / ( ), min(), max(), sqrt() and sample_size()"
)
_OPERATORS: Mapping[type[ast.operator], Callable[[float, float], float]] = MappingProxyType(
    {
        ast.Add: operator.add,
        ast.Sub: operator.sub,
        ast.Mult: operator.mul,
        ast.Div: operator.truediv,
    }
)


class FormulaError(PosstatsError):
    """A formula that cannot be read, or has no usable value for a product.

    `found` is what was read, as a finding shows it, and `reason` says what is wrong.
    """

    def __init__(self, value: object, reason: str) -> None:
        self.found = shown(value)
        self.reason = reason
        super().__init__(f"found {self.found}: {reason}")


class MissingProductValue(PosstatsError):  # noqa: N818 - no fault, but something not stated
    """A formula needs a value that the product does not state; `name` is its name there."""

    def __init__(self, name: str) -> None:
        self.name = name
        super().__init__(f"the product states no {name} ({FORMULA_NAMES[name]})")


@dataclass(frozen=True)
class Formula:
    """A number, or a formula of the product's values, that has been read and found harmless.

    Parameters
    ----------
    text
        As written: "0.1", "0.25 * class_h", "max(0.05, 2 * gsd)".

    Raises
    ------
    FormulaError
        If the text holds anything else than the module's docstring allows, is longer than 200
        characters or nested more than 20 deep, or is a number that is negative or too large.
    """

    text: str

    def __post_init__(self) -> None:
        if not self.names:
            self.evaluate(Product())

    @property
    def names(self) -> tuple[str, ...]:
        """The product's values that it needs, in the order of `FORMULA_NAMES`."""
        used = {node.id for node in ast.walk(_tree(self.text)) if isinstance(node, ast.Name)}
        return tuple(name for name in FORMULA_NAMES if name in used)

    @property
    def constant(self) -> float | None:
        """The value of a formula that needs nothing of the product; None for others."""
        return None if self.names else self.evaluate(Product())

    def evaluate(self, product: Product) -> float:
        """Its value for a product, in the unit of the quantity that it limits.

        Raises
        ------
        MissingProductValue
            If the product does not state a value that it needs.
        FormulaError
            For a division by zero, the root of a negative number, a value that is too large, and
            a result below zero.
        """
        value = _value(_tree(self.text), product, self.text)
        if value < 0.0:
            raise FormulaError(self.text, f"is {value:g}, expected a value of at least 0")
        return value + 0.0  # turns -0.0 into 0.0


def limit_formula(value: object, unit: str) -> Formula:
    """The formula of a limit in a file: a number, a number with the unit, or a formula's text.

    Parameters
    ----------
    unit
        Of the quantity: "m", "px" or "1".

    Raises
    ------
    FormulaError
        As for `Formula`, and if the text is a number in another unit.
    """
    if isinstance(value, bool) or not isinstance(value, int | float | str):
        raise FormulaError(value, "expected a number or the text of a formula")
    if not isinstance(value, str):
        return _number_formula(value)
    match = _WITH_UNIT.fullmatch(value)
    if match is None or match["unit"] in (*FORMULA_NAMES, *_FUNCTIONS):
        return Formula(value.strip())
    if match["unit"] != unit:
        wanted = "a number without unit" if unit == "1" else f"{unit}, which may be left out"
        raise FormulaError(value, f"is in {match['unit']}, expected {wanted}")
    return Formula(match["number"])


def _number_formula(value: float) -> Formula:
    if not (0.0 <= value <= _LARGEST):
        raise FormulaError(value, f"expected a number from 0 to {_LARGEST:g}")
    return Formula(repr(value))


def _whole(argument: float) -> int:
    if not argument.is_integer() or argument < 1.0:
        raise ValueError("expects a whole number of at least 1")
    return int(argument)


def _sample_size(lot: float) -> float:
    """Sample size of GB/T 24356-2023."""
    return float(gbt_sample_size(_whole(lot)))


def _sqrt(value: float) -> float:
    if value < 0.0:
        raise ValueError("takes the root of a negative number")
    return math.sqrt(value)


@dataclass(frozen=True)
class _Function:
    call: Callable[..., float]
    least: int
    most: int | None


_FUNCTIONS: Mapping[str, _Function] = MappingProxyType(
    {
        "min": _Function(min, 2, None),
        "max": _Function(max, 2, None),
        "sqrt": _Function(_sqrt, 1, 1),
        "sample_size": _Function(_sample_size, 1, 1),
    }
)


@lru_cache(maxsize=1024)
def _tree(text: str) -> ast.expr:
    """The syntax tree of a formula that holds nothing but what is allowed."""
    if len(text) > _MAX_LENGTH:
        raise FormulaError(text, f"has {len(text)} characters, expected at most {_MAX_LENGTH}")
    _check_characters(text)
    try:
        tree = ast.parse(text.strip(), mode="eval").body
    except (SyntaxError, ValueError, MemoryError, RecursionError) as error:
        raise FormulaError(text, f"is not a formula, expected {_ALLOWED}") from error
    _check(tree, text, _MAX_DEPTH)
    return tree


def _check_characters(text: str) -> None:
    """Refuse what is no token of ours, before Python's parser sees it."""
    position = 0
    end = len(text.rstrip(" \t"))
    while position < end:
        token = _TOKEN.match(text, position)
        if token is None:
            rest = text[position:].lstrip(" \t")
            raise FormulaError(text, f"cannot be read at {shown(rest[:12])}, expected {_ALLOWED}")
        position = token.end()


def _check(node: ast.expr, text: str, depth: int) -> None:
    """Refuse every node that is not on the list."""
    if depth == 0:
        raise FormulaError(text, f"is nested more than {_MAX_DEPTH} deep")
    match node:
        case ast.Constant(value=int() | float() as value) if not isinstance(value, bool):
            if value > _LARGEST:
                raise FormulaError(text, f"holds a number above {_LARGEST:g}")
        case ast.Name(id=name):
            _check_name(name, text)
        case ast.UnaryOp(op=ast.UAdd() | ast.USub(), operand=operand):
            _check(operand, text, depth - 1)
        case ast.BinOp(left=left, op=op, right=right) if type(op) in _OPERATORS:
            _check(left, text, depth - 1)
            _check(right, text, depth - 1)
        case ast.Call(func=ast.Name(id=name), args=arguments, keywords=[]):
            _check_call(name, arguments, text)
            for argument in arguments:
                _check(argument, text, depth - 1)
        case _:
            raise FormulaError(text, f"holds more than {_ALLOWED}")


def _check_name(name: str, text: str) -> None:
    if name in _FUNCTIONS:
        raise FormulaError(text, f"uses the function {name} without ( )")
    if name not in FORMULA_NAMES:
        raise FormulaError(
            text, f"found an unknown name {shown(name)}{nearest(name, FORMULA_NAMES)}"
        )


def _check_call(name: str, arguments: list[ast.expr], text: str) -> None:
    function = _FUNCTIONS.get(name)
    if function is None:
        known = nearest(name, tuple(_FUNCTIONS))
        raise FormulaError(text, f"found an unknown function {shown(name)}{known}")
    n = len(arguments)
    if n < function.least or (function.most is not None and n > function.most):
        wanted = f"{function.least}{' or more' if function.most is None else ''}"
        raise FormulaError(text, f"{name}() has {n} arguments, expected {wanted}")


def _value(node: ast.expr, product: Product, text: str) -> float:
    """The value of a checked tree."""
    match node:
        case ast.Constant(value=int() | float() as value):
            return float(value)
        case ast.Name(id=name):
            return _product_value(name, product)
        case ast.UnaryOp(op=op, operand=operand):
            value = _value(operand, product, text)
            return -value if isinstance(op, ast.USub) else value
        case ast.BinOp(left=left, op=op, right=right):
            pair = (_value(left, product, text), _value(right, product, text))
            return _applied(_OPERATORS[type(op)], pair, text)
        case ast.Call(func=ast.Name(id=name), args=arguments):
            values = tuple(_value(argument, product, text) for argument in arguments)
            return _applied(_FUNCTIONS[name].call, values, text)
        case _:
            raise FormulaError(text, f"holds more than {_ALLOWED}")


def _product_value(name: str, product: Product) -> float:
    value = product.value(name)
    if value is None:
        raise MissingProductValue(name)
    return float(value)


def _applied(call: Callable[..., float], values: tuple[float, ...], text: str) -> float:
    try:
        value = call(*values)
    except ZeroDivisionError as error:
        raise FormulaError(text, "divides by zero") from error
    except (ValueError, PosstatsError) as error:
        raise FormulaError(text, str(error)) from error
    if not math.isfinite(value):
        raise FormulaError(text, "has a value that is too large")
    return value
