"""The one way in which kernels are compiled: numba, without the GIL, cached where possible.

Division by zero gives infinity or NaN, as in NumPy: one degenerate pair of images must not
raise an exception for a whole block.
"""

from collections.abc import Callable
from functools import wraps
from typing import Any, TypeVar, cast

import numba

F = TypeVar("F", bound=Callable[..., Any])


def kernel(function: F) -> F:
    """Compile an array kernel; a missing or full cache costs compile time, never the result.

    numba keeps its cache beside the module, else in the user's cache folder. With neither
    writable it raises when the function is decorated, on a full disk at the first call; both
    fall back to compiling in memory. Kernels that call each other share a file, because numba
    checks only the caller's file for changes.
    """
    uncached = numba.njit(nogil=True, error_model="numpy")(function)
    try:
        cached = numba.njit(nogil=True, cache=True, error_model="numpy")(function)
    except RuntimeError:
        return cast(F, uncached)

    @wraps(function)
    def call(*args: Any) -> Any:
        try:
            return cached(*args)
        except OSError:
            return uncached(*args)

    return cast(F, call)


def inner_kernel(function: F) -> F:
    """Compile a function for use inside the kernels of the same file."""
    return cast(F, numba.njit(nogil=True, error_model="numpy")(function))


def summing_kernel(function: F) -> F:
    """As `inner_kernel`; sums may be added up in any order, as vector instructions do."""
    fast = {"reassoc", "contract", "nsz"}
    return cast(F, numba.njit(nogil=True, error_model="numpy", fastmath=fast)(function))
