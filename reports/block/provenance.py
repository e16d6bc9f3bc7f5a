"""Topic: inputs, settings, versions."""

from posstats.contract.results import AnalysisSettings

from ..document.content import Part, filled
from ..document.table import pairs
from .words import BlockReport, Words


def topic(report: BlockReport) -> Part:
    """What was read, asked for, and computed with."""
    words, results = report.words, report.results
    read = [(each.file, each.sha256) for each in results.block.inputs]
    tables = [
        pairs(
            "inputs",
            words.text("provenance.inputs"),
            (words.text("column.file"), "SHA-256"),
            read,
        ),
        pairs(
            "settings",
            words.text("provenance.settings"),
            (words.text("column.setting"), words.text("column.value")),
            _settings(words, results.settings),
        ),
        pairs(
            "versions",
            words.text("provenance.versions"),
            (words.text("column.package"), words.text("column.version")),
            results.versions.items(),
        ),
    ]
    return Part("provenance", words.text("provenance.title"), filled(tables))


def _settings(words: Words, settings: AnalysisSettings) -> list[tuple[str, str]]:
    asked = {
        "rules": settings.rules,
        "scope": words.of("setting_value", settings.scope),
        "errors": words.of("setting_value", settings.errors),
        "frame": words.of("frame", settings.frame),
        "robust": words.yes(settings.robust),
    }
    return [(words.of("setting", name), value) for name, value in asked.items()]
