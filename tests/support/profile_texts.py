"""Profiles and contract files as texts, and what is found in them."""

import re

import pytest
from helpers import ROOT

from posstats.acceptance.profile_files import (
    ProfileFormatError,
    load_contract,
)

DOCS = ROOT / "docs"


OWN = "[[requirement]]\nid = 'a'\nquantity = 'rmse_h'\nlimit = 1\n"


def write(folder, **texts):
    for name, text in texts.items():
        (folder / f"{name}.toml").write_text(text, encoding="utf-8")
    return folder / f"{next(iter(texts))}.toml"


def findings_of(path, **options):
    with pytest.raises(ProfileFormatError) as caught:
        load_contract(path, **options)
    return list(caught.value.findings)


def documented_contract(folder):
    """The contract file of the documentation."""
    page = (DOCS / "acceptance.md").read_text(encoding="utf-8")
    (text,) = re.findall(r"^```toml\n(.*?)^```", page, re.MULTILINE | re.DOTALL)
    return write(folder, contract=text)
