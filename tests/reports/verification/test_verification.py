"""`posstats verify` finds every change of a document."""

import re
import sys

import pytest
from answers import IN_FORCE, INTACT, TRUSTED, changed, failures, rewritten
from archive_documents import (
    NOW,
    certificate,
    document,
    p12,
    pem,
    results_of,
)

from posstats.reports.archive.signing import sign
from posstats.reports.verification import words
from posstats.reports.verification.signature import read_trust
from posstats.reports.verification.words import Standing


def test_an_unsigned_document_is_said_to_be_unsigned_and_judged_on_the_rest(ask, archive, inputs):
    answers = ask(archive, inputs=inputs)
    assert ask.holds
    assert [each.standing.value for each in answers.values()] == [
        *("PASS", "NOT SIGNED", "PASS", "PASS", "PASS", "PASS", "PASS", "PASS")
    ]
    assert answers[words.PAGES].text == words.SAME_BYTES


def test_an_unsigned_document_needs_no_pyhanko(ask, archive, signed, monkeypatch):
    monkeypatch.setitem(sys.modules, "pyhanko.sign", None)
    ask(archive)
    assert ask.holds
    assert "posstats[sign]" in failures(ask(signed))[INTACT]


def test_a_signed_document_passes_and_names_its_signer(ask, signed, inputs):
    answers = ask(signed, inputs=inputs)
    assert ask.holds
    assert "over the whole file, by Common Name: Example Survey Ltd" in answers[INTACT].text
    assert answers[TRUSTED].standing is Standing.NOT_ASKED
    assert "self-signed" in answers[TRUSTED].text
    assert answers[words.APPENDED].text == words.ONLY_SIGNATURES


def test_two_signatures_are_both_judged(ask, signed):
    client = certificate("Example Client Ltd")
    twice = sign(signed, p12(client, "Example Client Ltd"), b"secret", now=NOW)
    answers = ask(twice, trust=read_trust(pem(client)))
    assert set(failures(answers)) == {words.trust_question("signature 1")}
    assert "later ones follow" in answers[words.intact_question("signature 1")].text
    assert "whole file" in answers[words.intact_question("signature 2")].text


def test_no_network_is_used(ask, signed, monkeypatch):
    def refuse(*_, **__):
        raise AssertionError("a connection was tried")

    monkeypatch.setattr("socket.socket.connect", refuse)
    ask(signed, trust=read_trust(pem(certificate())))


def places(data: bytes) -> dict[str, int]:
    return {
        "header": 7,
        "comment": 11,
        "page": data.index(b"stream\n", data.index(b"/Filter /FlateDecode")) + 40,
        "attachment": data.index(b"stream\n", data.index(b"/EmbeddedFile")) + 30,
        "listing": data.index(b"/AFRelationship /Data") + 17,
        "producer": data.index(b"/Producer (WeasyPrint") + 22,
        "title": data.index(b"/Title (Acceptance") + 9,
        "metadata": data.index(b"<dc:title>") + 60,
        "table": data.index(b"xref\n0") + 45,
        "start": data.index(b"startxref\n") + 10,
        "identifier": data.index(b"/ID [") + 8,
        "end": data.index(b"%%EOF") + 3,
    }


PLACES = [
    *("header", "comment", "page", "attachment", "listing", "title"),
    *("producer", "metadata", "table", "start", "identifier", "end"),
]


@pytest.mark.parametrize("place", PLACES)
def test_one_changed_byte_is_found_in_an_unsigned_document(ask, archive, place):
    answers = ask(changed(archive, places(archive)[place]))
    assert not ask.holds
    assert failures(answers)


@pytest.mark.parametrize("place", PLACES)
def test_one_changed_byte_is_found_in_a_signed_document(ask, signed, place):
    answers = ask(changed(signed, places(signed)[place]))
    assert not ask.holds
    assert {INTACT, words.READABLE} & set(failures(answers))


def test_a_changed_signature_is_found_also_in_its_padding(ask, signed):
    begin = signed.rindex(b"/Contents <") + 11
    end = signed.index(b">", begin)
    for at in (begin + 9, begin + 400, end - 900, end - 2):
        digit = b"0" if signed[at : at + 1] != b"0" else b"1"
        answers = ask(signed[:at] + digit + signed[at + 1 :])
        assert INTACT in failures(answers)
        assert failures(answers).keys() <= {INTACT, IN_FORCE}


def test_any_changed_byte_of_the_appended_part_is_found(ask, archive, signed):
    begin = signed.rindex(b"/Contents <")
    end = signed.index(b">", begin)
    for at in (*range(len(archive), begin, 97), *range(end + 1, len(signed), 41)):
        ask(changed(signed, at))
        assert not ask.holds, at


@pytest.mark.parametrize("name", ["results.json", "profile.toml", "tables/points.csv"])
def test_a_changed_attachment_is_named(ask, archive, signed, name):
    for data in (archive, signed):
        answers = ask(rewritten(data, name, lambda content: content.replace(b"1", b"2")))
        assert f"{name} was changed" in failures(answers)[words.FILES]


def test_a_better_verdict_in_the_data_is_found_by_assessing_again(ask, inputs):
    def better(acceptance):
        acceptance["verdict"] = "accepted with honours"

    answers = ask(document(results_of(inputs), change=better))
    assert failures(answers) == {
        words.ASSESSMENT: "verdict: accepted with honours stated, accepted found"
    }


def test_a_better_verdict_on_the_page_alone_is_found_by_laying_it_out_again(ask, inputs):
    data = document(results_of(inputs), edit=lambda page: page.replace("accepted", "honoured"))
    assert failures(ask(data)) == {words.PAGES: "page 1 is not what the data make"}


def test_what_pages_share_is_compared_too(ask, inputs):
    data = document(results_of(inputs), edit=lambda page: page.replace("Residual", "Resydual"))
    assert "StructElem" in failures(ask(data))[words.PAGES]


def test_another_number_of_pages_is_said(ask, inputs):
    data = document(results_of(inputs), edit=lambda page: page.replace("</body>", "<h1>X</h1>"))
    assert re.search(r"it has \d pages, the data make \d", failures(ask(data))[words.PAGES])


def test_missing_unlisted_and_unassessed_files_are_named(ask, inputs):
    def edit(acceptance):
        acceptance["attachments"][-1]["file"] = "templates/other.j2"
        acceptance["attachments"][0]["relationship"] = "Source"
        acceptance["results"]["sha256"] = "0"

    said = failures(ask(document(results_of(inputs), change=edit)))[words.FILES]
    assert "templates/other.j2 is missing" in said
    assert "templates/logo.svg is not listed" in said
    assert "results.json has another relationship" in said
    assert "results.json is not what was assessed" in said


def test_rewriting_everything_consistently_needs_a_signature_or_the_inputs_to_be_found(ask, inputs):
    results = results_of(inputs)
    results["check_points"][7]["dx_m"] = 0.0001
    data = document(results)
    ask(data)
    assert ask.holds  # documented: without signature and inputs nothing contradicts it
    said = failures(ask(data, inputs=inputs))
    assert said == {words.RECOMPUTED: "check_points[8].dx_m: 0.0001 stated, 0.007 found"}
