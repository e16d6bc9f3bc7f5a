"""What the document rests on: files, settings, software."""

from posstats.contract.results import AnalysisSettings

from ..document import format as fmt
from ..document.content import Paragraph, Part, filled
from ..document.table import Table, pairs
from .material import Material, file_table, section
from .words import Words


def inputs(material: Material) -> Part:
    """Files with their checksums, settings of the analysis, versions."""
    words, acceptance = material.words, material.acceptance
    titles = words.text("column.package"), words.text("column.version")
    listed = [
        file_table(words, "inputs", [*acceptance.block.inputs, acceptance.results]),
        file_table(words, "rules", acceptance.profile.files),
        settings_table(words, material.results.settings),
        pairs("software", words.text("table.software"), titles, acceptance.versions.items()),
    ]
    return section(words, "inputs", (Paragraph(words.text("inputs.intro")), *filled(listed)))


def settings_table(words: Words, stated: AnalysisSettings) -> Table:
    """Settings of the analysis that the acceptance rests on."""
    named = {
        "rules": words.known("setting_value", stated.rules),
        "scope": words.of("setting_value", stated.scope),
        "errors": words.of("setting_value", stated.errors),
        "frame": words.of("setting_value", stated.frame),
        "robust": words.of("setting_value", str(stated.robust)),
        "position_m": fmt.with_unit(stated.position_m, "m"),
        "angle_rad": fmt.with_unit(1e3 * stated.angle_rad, "mrad"),
        "image_px": fmt.with_unit(stated.image_px, "px"),
    }
    titles = words.text("column.setting"), words.text("column.value")
    shown = [(words.of("setting", name), value) for name, value in named.items()]
    return pairs("settings", words.text("table.settings"), titles, shown)
