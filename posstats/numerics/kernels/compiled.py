"""The one way in which kernels are compiled: numba, without the GIL, cached where possible.

Division by zero gives infinity or NaN, as in NumPy: one degenerate pair of images must not
raise an exception for a whole block.
"""

from collections.abc import Callable
from functools import wraps
from hashlib import sha256
from pathlib import Path
from typing import Any, TypeVar, cast

import numba
from numba.extending import is_jitted

F = TypeVar("F", bound=Callable[..., Any])


def kernel(function: F) -> F:
    """Compile an array kernel; a missing or full cache costs compile time, never the result.

    numba keeps its cache beside the module, else in the user's cache folder. With neither
    writable it raises when the function is decorated, on a full disk at the first call; both
    fall back to compiling in memory.
    """
    uncached = numba.njit(nogil=True, error_model="numpy")(function)
    try:
        cached = _cached(function)
    except (RuntimeError, OSError):
        return cast(F, uncached)

    @wraps(function)
    def call(*args: Any) -> Any:
        try:
            return cached(*args)
        except OSError:
            return uncached(*args)

    return cast(F, call)


def inner_kernel(function: F) -> F:
    """Compile a function for use inside kernels, into them; Python cannot call it.

    Between functions that stay apart, every array handed on is counted as a reference: that is
    half the time of kernels with many arrays. And a function that stays apart exists twice, on its
    own and with its caller; the run that compiles takes the one, a run from the cache the other,
    and their last digits differ.
    """
    return cast(F, numba.njit(**_INNER)(function))


def summing_kernel(function: F) -> F:
    """As `inner_kernel`; sums may be added up in any order, as vector instructions do."""
    fast = {"reassoc", "contract", "nsz"}
    return cast(F, numba.njit(**_INNER, fastmath=fast)(function))


# The wrappers for calls from Python and from C take a fifth of the compile time.
_INNER: dict[str, Any] = {
    "nogil": True,
    "error_model": "numpy",
    "no_cpython_wrapper": True,
    "no_cfunc_wrapper": True,
    "forceinline": True,
}


def _cached(function: F) -> Any:
    """Compile with a cache that also notices changes of the inner kernels of other files.

    numba checks the file of the kernel only. It names the cache after the function, so the
    name is made to depend on the contents of the other files for that moment.
    """
    name = function.__qualname__
    others = _kernel_files(function.__globals__, set()) - {function.__code__.co_filename}
    if others:
        contents = b"".join(Path(file).read_bytes() for file in sorted(others))
        function.__qualname__ = f"{name}_{sha256(contents).hexdigest()[:12]}"
    try:
        return numba.njit(nogil=True, cache=True, error_model="numpy")(function)
    finally:
        function.__qualname__ = name


def _kernel_files(namespace: dict[str, Any], known: set[str]) -> set[str]:
    """Files of the compiled functions in a module's namespace, and of those that they use."""
    for value in list(namespace.values()):
        if is_jitted(value):
            inner = value.py_func
            if inner.__code__.co_filename not in known:
                known.add(inner.__code__.co_filename)
                _kernel_files(inner.__globals__, known)
    return known
