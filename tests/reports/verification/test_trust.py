"""Whom a signature is trusted from, and when its certificate is in force."""

import datetime as dt

import pytest
from answers import IN_FORCE, TRUSTED, codes, failures
from archive_documents import (
    NOW,
    certificate,
    p12,
    pem,
)

from posstats.reports.archive import signing
from posstats.reports.archive.signing import sign
from posstats.reports.verification.signature import TrustError, read_trust


def test_an_authority_that_issued_the_certificate_makes_it_trusted(ask, archive):
    name, authority = "Example Survey Ltd", "Example Authority"
    root, leaf = certificate(authority), certificate(name, authority)
    data = sign(archive, p12(leaf), b"secret", now=NOW)
    answers = ask(data, trust=read_trust(pem(root)))
    assert ask.holds
    (told,) = answers[TRUSTED].said
    assert told.code == "trusted"
    assert told.values["issuer"] == f"Common Name: {authority}"
    said = failures(ask(data, trust=read_trust(pem(certificate("Other Authority")))))
    assert set(said) == {TRUSTED}
    same_name = read_trust(pem(certificate(authority, key="another")))
    assert set(failures(ask(data, trust=same_name))) == {TRUSTED}


def test_a_self_signed_certificate_is_trusted_only_if_it_is_the_one_given(ask, archive):
    own, other = certificate(), certificate("Example Impostor")
    forged = sign(archive, p12(other, "Example Impostor"), b"secret", now=NOW)
    said = failures(ask(forged, trust=read_trust(pem(own))))
    assert {each.values["issuer"] for each in said[TRUSTED]} == {None}


def test_an_expired_certificate_fails_then_and_later(ask, archive, signed, monkeypatch):
    monkeypatch.setattr(signing, "_require_validity", lambda *_: None)  # as another program signs
    data = sign(archive, p12(certificate(days=(-20, -10))), b"secret", now=NOW)
    assert codes(failures(ask(data))[IN_FORCE]) == {"signed_outside_validity"}
    later = failures(ask(signed, now=NOW + dt.timedelta(days=500)))
    assert set(later) == {IN_FORCE}
    assert codes(later[IN_FORCE]) == {"no_longer_in_force"}
    early = failures(ask(signed, now=NOW - dt.timedelta(days=5)))
    assert codes(early[IN_FORCE]) == {"signed_in_future"}


def test_a_certificate_without_key_usage_is_accepted(ask, archive):
    own = certificate(usage=None)
    data = sign(archive, p12(own), b"secret", now=NOW)
    ask(data, trust=read_trust(pem(own)))
    assert ask.holds


def test_trust_without_a_certificate_is_refused():
    for content in (b"", b"-----BEGIN CERTIFICATE-----\n", b"{}"):
        with pytest.raises(TrustError):
            read_trust(content)
