"""Topic: the bundle adjustment that the angle errors come from, where they come from one."""

from posstats.contract.results import Bundle

from ..document import format as fmt
from ..document.content import Paragraph, Part
from ..document.table import Table, pairs
from .words import BlockReport, Words


def topic(report: BlockReport) -> Part | None:
    """What the adjustment says of the stated accuracies; None without one."""
    words, bundle = report.words, report.results.bundle
    if bundle is None:
        return None
    n = bundle.n_control_points
    control = words.counted("bundle.control", n) if n else words.text("bundle.no_control")
    text = Paragraph(words.sentences([words.text("bundle.text"), control]))
    return Part("bundle", words.text("bundle.title"), (text, table(words, bundle)))


def table(words: Words, bundle: Bundle) -> Table:
    """Figures of the adjustment."""
    figures = {
        "sigma0": fmt.number(bundle.sigma0),
        "dof": fmt.count(bundle.dof),
        "p_value": fmt.p_value(bundle.p_value),
        "image_rms": fmt.with_unit(bundle.image_rms_px, "px"),
        "sigma_image": fmt.with_unit(bundle.sigma_image_px, "px"),
        "n_rays": fmt.count(bundle.n_rays),
        "n_rejected_rays": fmt.count(bundle.n_rejected_rays),
        "n_control_points": fmt.count(bundle.n_control_points),
    }
    named = [(words.of("bundle_figure", name), value) for name, value in figures.items()]
    titles = words.text("column.figure"), words.text("column.value")
    return pairs("bundle", words.text("bundle.caption"), titles, named)
