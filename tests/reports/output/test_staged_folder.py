"""A folder is replaced when all is written, and not before."""

import pytest

from posstats.errors import PosstatsError
from posstats.reports.output.staged_folder import staged_folder


def test_a_file_above_the_output_folder_is_refused_before_the_work(tmp_path):
    (tmp_path / "file").write_text("")
    with (
        pytest.raises(PosstatsError, match="is a file"),
        staged_folder(tmp_path / "file" / "sub"),
    ):
        pytest.fail("the work began")


def test_an_outdated_pdf_does_not_stay_beside_a_new_page(tmp_path):
    for name in ("paper.pdf", "mine.pdf"):
        (tmp_path / name).write_text("old")
    with staged_folder(tmp_path, replaced=("paper.pdf",)) as stage:
        (stage / "paper.html").write_text("new")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["mine.pdf", "paper.html"]
