"""Topic: inputs, settings, versions."""

from collections.abc import Iterable, Iterator

from posstats.contract.adjustment import AdjustmentRequest, AdjustmentResults

from ..document import format as fmt
from ..document.content import Part, filled
from ..document.table import Table, pairs
from .words import Words

Pair = tuple[str, str]


def topic(words: Words, results: AdjustmentResults) -> Part:
    """What was read, asked for, and computed with."""
    inputs = [(each.file, each.sha256) for each in results.block.inputs]
    tables = [
        _table(words, "inputs", ("bundle_column.file", "bundle_column.sha256"), inputs),
        _table(
            words,
            "settings",
            ("bundle_column.setting", "bundle_column.is"),
            _settings(words, results),
        ),
        _table(
            words,
            "versions",
            ("bundle_column.package", "bundle_column.version"),
            results.versions.items(),
        ),
    ]
    return Part("provenance", words.text("provenance.title"), filled(tables))


def _table(words: Words, name: str, titles: Pair, items: Iterable[Pair]) -> Table:
    heads = (words.text(titles[0]), words.text(titles[1]))
    return pairs(name, words.text(f"provenance.{name}"), heads, items)


def _settings(words: Words, results: AdjustmentResults) -> list[Pair]:
    settings = results.settings
    stated = {
        "position": fmt.with_unit(settings.position_m, "m"),
        "angle": fmt.with_unit(fmt.DEGREE.scaled(settings.angle_rad), "°"),
        "image": fmt.with_unit(settings.image_px, "px"),
    }
    shown = [*_chosen(words, settings).items(), *stated.items()]
    if settings.calibration:
        shown.append(("calibration", settings.calibration))
    named = [(words.of("bundle_setting", key), value) for key, value in shown]
    return [*named, *(_priors(words, settings) if settings.drift != "none" else ())]


def _chosen(words: Words, settings: AdjustmentRequest) -> dict[str, str]:
    control = settings.control
    ids = words.text("list.between").join(control) if isinstance(control, tuple) else None
    return {
        "control": words.of("control_choice", str(control)) if ids is None else ids,
        "drift": words.of("drift", settings.drift),
        "self_calibration": words.of("self_calibration", settings.self_calibration),
        "camera": words.yes(settings.camera),
        "lever_arm": words.yes(settings.lever_arm),
        "estimate_weights": words.yes(settings.estimate_weights),
        "drop_insignificant": words.yes(settings.drop_insignificant),
        "robust": words.yes(settings.robust),
    }


def _priors(words: Words, settings: AdjustmentRequest) -> Iterator[Pair]:
    priors = settings.priors
    degrees = fmt.DEGREE.per_si
    stated = {
        "gnss_shift": (priors.shift_m, 1.0, "m"),
        "gnss_drift": (priors.drift_m_per_s, 100.0, "m/100 s"),
        "imu_shift": (priors.shift_rad, degrees, "°"),
        "imu_drift": (priors.drift_rad_per_s, 100.0 * degrees, "°/100 s"),
        "boresight": (priors.boresight_rad, degrees, "°"),
    }
    for key, (value, factor, unit) in stated.items():
        text = words.text("prior.free") if value is None else fmt.with_unit(value * factor, unit)
        yield words.text("prior.sigma", parameter=words.of("prior", key)), text
