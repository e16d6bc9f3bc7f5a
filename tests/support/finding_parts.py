"""A finding about a file in its parts, which are compared one by one.

``c.toml:4, requirement.limit: found 7, expected text`` says where, what was found there, and
what was expected instead; a finding that says it otherwise has all of it as what was found.
"""

import re


def parts(finding: str) -> tuple[str, str, str]:
    """Place (file, line, key), what was found, what was expected (both from their beginning)."""
    where, _, what = finding.partition(": ")
    found, *expected = re.split(r"[,:] expected ", what.removeprefix("found "), maxsplit=1)
    return where, found, "".join(expected)


def assert_finding(finding: str, where: str, found: str, expected: str = "") -> None:
    """The place is this one; what was found, and what was expected, begins so."""
    place, thing, other = parts(finding)
    assert place == where, finding
    assert thing.startswith(found), finding
    assert other.startswith(expected), finding
