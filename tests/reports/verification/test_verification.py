"""`posstats verify` finds every change of a document."""

import sys
from dataclasses import replace

import pytest
from answers import IN_FORCE, INTACT, TRUSTED, changed, codes, failures, reason, rewritten
from archive_documents import (
    NOW,
    certificate,
    document,
    p12,
    pem,
    results_of,
)

from posstats.reports.archive.signing import sign
from posstats.reports.verification.answers import (
    APPENDED,
    ASSESSMENT,
    FILES,
    PAGES,
    READABLE,
    RECOMPUTED,
    Question,
    Standing,
    said,
)
from posstats.reports.verification.signature import read_trust


def test_an_unsigned_document_is_said_to_be_unsigned_and_judged_on_the_rest(ask, archive, inputs):
    answers = ask(archive, inputs=inputs)
    assert ask.holds
    assert [each.standing for each in answers.values()] == [
        *("pass", "not_signed", "pass", "pass", "pass", "pass", "pass", "pass")
    ]
    assert answers[PAGES].said == (said("same_bytes"),)


def test_an_unsigned_document_needs_no_pyhanko(ask, archive, signed, monkeypatch):
    monkeypatch.setitem(sys.modules, "pyhanko.sign", None)
    ask(archive)
    assert ask.holds
    assert "posstats[sign]" in reason(failures(ask(signed))[INTACT])


def test_a_signed_document_passes_and_names_its_signer(ask, signed, inputs):
    answers = ask(signed, inputs=inputs)
    assert ask.holds
    signer = "Common Name: Example Survey Ltd"
    assert answers[INTACT].said == (said("signed_whole", signer=signer),)
    assert answers[TRUSTED].standing is Standing.NOT_ASKED
    assert answers[TRUSTED].said == (said("no_anchor", signer=signer, issuer=None),)
    assert answers[APPENDED].said == (said("only_signatures"),)


def test_two_signatures_are_both_judged(ask, signed):
    client = certificate("Example Client Ltd")
    twice = sign(signed, p12(client, "Example Client Ltd"), b"secret", now=NOW)
    answers = ask(twice, trust=read_trust(pem(client)))
    assert set(failures(answers)) == {Question("signer_trusted", 1)}
    (first,) = answers[Question("intact", 1)].said
    assert (first.code, first.values["n_bytes"]) == ("signed_part", len(signed))
    assert codes(answers[Question("intact", 2)].said) == {"signed_whole"}


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
    assert {INTACT, READABLE} & set(failures(answers))


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
        answers = ask(rewritten(data, name, lambda content: content.replace(b"0.1", b"0.2")))
        assert said("file_changed", file=name) in failures(answers)[FILES]


def test_a_better_verdict_in_the_data_is_found_by_assessing_again(ask, inputs):
    def better(acceptance):
        acceptance["verdict"] = "rejected"

    answers = ask(document(results_of(inputs), change=better))
    assert failures(answers) == {
        ASSESSMENT: (said("value_differs", path="verdict", stated="rejected", found="accepted"),)
    }


def test_a_better_verdict_on_the_page_alone_is_found_by_laying_it_out_again(ask, inputs):
    data = document(results_of(inputs), edit=lambda page: page.replace("accepted", "honoured"))
    assert failures(ask(data)) == {PAGES: (said("page_differs", number=1),)}


def test_what_pages_share_is_compared_too(ask, inputs):
    data = document(results_of(inputs), edit=lambda page: page.replace("Residual", "Resydual"))
    kinds = {each.values["kind"] for each in failures(ask(data))[PAGES]}
    assert "StructElem" in kinds


def test_another_number_of_pages_is_said(ask, inputs):
    data = document(results_of(inputs), edit=lambda page: page.replace("</body>", "<h1>X</h1>"))
    (only,) = failures(ask(data))[PAGES]
    assert only.code == "page_count"
    assert only.values["n_shown"] == only.values["n_made"] + 1


def test_missing_unlisted_and_unassessed_files_are_named(ask, inputs):
    def edit(acceptance):
        acceptance["attachments"][-1]["file"] = "templates/other.j2"
        acceptance["attachments"][0]["relationship"] = "Source"
        acceptance["results"]["sha256"] = "0"

    assert failures(ask(document(results_of(inputs), change=edit)))[FILES] == (
        said("file_missing", file="templates/other.j2"),
        said("file_unlisted", file="templates/logo.svg"),
        said("file_relationship", file="results.json"),
        said("file_not_assessed", file="results.json"),
    )


def test_rewriting_everything_consistently_needs_a_signature_or_the_inputs_to_be_found(ask, inputs):
    results = results_of(inputs)
    points = list(results.check_point_residuals)
    points[7] = replace(points[7], dx_m=0.0001)
    data = document(replace(results, check_point_residuals=tuple(points)))
    ask(data)
    assert ask.holds  # documented: without signature and inputs nothing contradicts it
    path = "check_point_residuals[8].dx_m"
    different = said("value_differs", path=path, stated="0.0001", found="0.007")
    assert failures(ask(data, inputs=inputs)) == {RECOMPUTED: (different,)}
