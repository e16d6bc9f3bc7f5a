"""The content of ``wucaps.json``; conclusions come in words of the report's catalogue."""

from posstats.contract.record import record
from posstats.contract.wucaps import Prediction, SituationRow, SituationShare, Wucaps
from posstats.papers.wucaps.adjustments import CONTROLS
from posstats.papers.wucaps.experiment import Row, SituationRun
from posstats.papers.wucaps.findings import CRITERIA
from posstats.papers.wucaps.reproduction import Reproduction
from posstats.papers.wucaps.seeds import pooled, repeated, share
from posstats.papers.wucaps.situations import Situation
from posstats.version import __version__

from .report import Report


def results(report: Report, created: str) -> Wucaps:
    """All numbers of the report.

    Parameters
    ----------
    report
        Its conclusions in English, whatever the language of the pages.
    created
        ISO 8601 time stamp.
    """
    run = report.run
    return Wucaps(
        posstats_version=__version__,
        created=created,
        simulated=True,
        seed=run.seed,
        rows=tuple(_row(each, row) for each in run.runs.values() for row in each.rows),
        relative_parallax_mm={s: each.relative_mm for s, each in run.runs.items()},
        conclusions=tuple(each.stated() for each in report.conclusions),
        beyond=tuple(each.stated() for each in report.beyond),
        seed_shares=_shares(run),
        predictions=(
            *(_prediction(s, f"weighted_{c}") for s in run.runs for c in CONTROLS),
            *(_prediction(s, "reference") for s in run.runs),
        ),
    )


def _row(run: SituationRun, row: Row) -> SituationRow:
    best, found = run.measures("reference", "all"), row.measures
    values = {
        "situation": run.situation,
        "method": row.method,
        "control": row.control,
        "sigma0": row.sigma0,
        "undetermined": row.undetermined,
        "determined": found is not None and not row.undetermined,
    }
    if found is not None:
        values |= vars(found) | {
            "horizontal_over_reference": found.horizontal_m / best.horizontal_m,
            "vertical_over_reference": found.vertical_m / best.vertical_m,
        }
    return record(SituationRow, values)


def _shares(run: Reproduction) -> tuple[SituationShare, ...]:
    return tuple(
        SituationShare(finding=name, situation=s, n_seeds=len(repeated()[s]), share=share(name, s))
        for name in CRITERIA
        for s in run.runs
    )


def _prediction(situation: Situation, name: str) -> Prediction:
    """RMSE over all seeds, and as predicted."""
    values = {
        f"{kind}{side}_m": pooled(f"{name}_{kind}{side}_m", situation)
        for kind in ("", "predicted_")
        for side in ("horizontal", "vertical")
    }
    return record(Prediction, {"situation": situation, "adjustment": name, **values})
