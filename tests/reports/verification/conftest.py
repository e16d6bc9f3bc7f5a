"""A document and its signed copy, made once, and what verifying answers."""

from pathlib import Path

import pytest
from archive_documents import (
    NOW,
    STEPS,
    certificate,
    document,
    p12,
    remembering,
    results_of,
    write_inputs,
)

from posstats.reports.archive.signing import sign
from posstats.reports.verification import pages as verification_pages
from posstats.reports.verification.answers import Answer, Question
from posstats.reports.verification.questions import holds, verify


@pytest.fixture(scope="session")
def inputs(tmp_path_factory) -> Path:
    folder = tmp_path_factory.mktemp("inputs")
    write_inputs(folder)
    return folder


@pytest.fixture(scope="session")
def archive(inputs) -> bytes:
    return document(results_of(inputs))


@pytest.fixture(scope="session")
def signed(archive) -> bytes:
    return sign(archive, p12(certificate()), b"secret", now=NOW)


@pytest.fixture
def ask(tmp_path, monkeypatch):
    """Verify bytes: the answers by question."""
    monkeypatch.setattr(verification_pages, "render_archive", remembering)

    def run(data: bytes, steps=STEPS, now=NOW, **options) -> dict[Question, Answer]:
        path = tmp_path / "asked.pdf"
        path.write_bytes(data)
        answers = list(verify(path, steps, now=now, **options))
        run.holds = holds(answers)
        return {each.question: each for each in answers}

    return run
