"""The verdict on an adjustment: a paragraph of plain sentences."""

from collections.abc import Iterator, Sequence

from posstats.contract.adjustment import (
    AdditionalParameter,
    AdjustmentResults,
    ContradictedObservation,
    Undetermined,
)

from ..document import format as fmt
from .check_points import accuracy, predicted_rmse
from .words import Words

DOUBTFUL_P = 0.05
SHOWN = 4


def paragraph(words: Words, results: AdjustmentResults) -> str:
    """Convergence, fit, POS errors, image deformation, check points, blunders, what is open."""
    return words.sentences(
        (
            *_fit(words, results),
            _errors(words, results),
            _deformation(words, results),
            *_check_points(words, results),
            blunders(words, results),
            *_open(words, results),
        )
    )


def _fit(words: Words, results: AdjustmentResults) -> Iterator[str]:
    steps = fmt.count(results.n_iterations)
    sigma0, p = results.sigma0, results.chi2_p
    if sigma0 is None:
        yield words.text("fit.untested", steps=steps)
        return
    dof = fmt.count(results.dof)
    yield words.text("fit.tested", steps=steps, sigma0=fmt.number(sigma0), dof=dof)
    if p is None or p >= DOUBTFUL_P:
        said = "fit.agrees"
    else:
        said = "fit.worse" if sigma0 > 1.0 else "fit.better"
    yield words.text(said, p=fmt.p_phrase(p))


def _errors(words: Words, results: AdjustmentResults) -> str:
    """POS errors that are significant."""
    if results.settings.drift == "none":
        return words.text("errors.unasked")
    known = [row for row in results.parameters if _is_of_pos(row)]
    found = [row for row in known if row.significant and row.determined]
    if not found:
        return words.text("errors.none")
    described = words.text("errors.between").join(_described(words, found))
    return words.text("errors.found", errors=described)


def _is_of_pos(row: AdditionalParameter) -> bool:
    return row.name.startswith(("gnss", "imu", "boresight", "lever"))


def _described(words: Words, found: Sequence[AdditionalParameter]) -> Iterator[str]:
    """One phrase for every kind of parameter, whatever the number of its scopes."""
    for name in dict.fromkeys(row.name for row in found):
        same = [row for row in found if row.name == name]
        largest = max(same, key=lambda row: abs(row.value))
        values = {"parameter": words.parameter(name), "value": words.value(largest)}
        if largest.scope == "block":
            yield words.text("errors.of_block", **values)
        elif len(same) == 1:
            yield words.text("errors.of_strip", strip=largest.scope, **values)
        else:
            n = fmt.count(len(same))
            yield words.text("errors.of_strips", strip=largest.scope, n=n, **values)


def _deformation(words: Words, results: AdjustmentResults) -> str:
    if results.settings.self_calibration == "none":
        return ""
    found = [row for row in results.parameters if not _is_of_pos(row) and row.significant]
    if not found:
        return words.text("deformation.none")
    return words.text(
        "deformation.found", parameters=words.joined(words.parameter(row.name) for row in found)
    )


def _check_points(words: Words, results: AdjustmentResults) -> Iterator[str]:
    row, pos = accuracy(results, "bundle"), accuracy(results, "pos")
    if row is None:
        yield words.text("checks.none")
        return
    values = {"h": _m(row.rmse_horizontal_m), "v": _m(row.rmse_vertical_m)}
    predicted = predicted_rmse(results)
    if predicted is None:
        yield words.counted("checks.found", row.n, **values)
    else:
        values |= {"predicted_h": _m(predicted[0]), "predicted_v": _m(predicted[1])}
        yield words.counted("checks.found_and_predicted", row.n, **values)
    if pos is not None:
        h, v = _m(pos.rmse_horizontal_m), _m(pos.rmse_vertical_m)
        yield words.text("checks.pos", h=h, v=v)


def _m(value: float | None) -> str:
    return fmt.with_unit(value, "m")


def blunders(words: Words, results: AdjustmentResults) -> str:
    """What was taken out, in a sentence or two."""
    parts = list(_taken_out(words, results))
    held = [_named(words, row) for row in results.blunders if not row.taken_out]
    sentences = []
    if parts:
        sentences.append(words.text("blunders.taken", what=words.joined(parts)))
    if held:
        sentences.append(words.text("blunders.held", what=words.joined(held)))
    return words.sentences(sentences) or words.text("blunders.none")


def _taken_out(words: Words, results: AdjustmentResults) -> Iterator[str]:
    """A few observations of a kind by their names, many by their number; rays counted."""
    taken = [row for row in results.blunders if row.found_by == "snooping" and row.taken_out]
    for kind in dict.fromkeys(row.kind for row in taken if row.kind != "image"):
        same = [row for row in taken if row.kind == kind]
        if len(same) <= SHOWN:
            yield from (_named(words, row) for row in same)
        else:
            yield words.of("several", kind, n=fmt.count(len(same)))
    n_rays = sum(row.kind == "image" for row in taken) + results.n_rejected_rays
    if n_rays:
        yield words.counted("blunders.rays", n_rays)


def _named(words: Words, row: ContradictedObservation) -> str:
    return words.of("named", row.kind, image=row.image or "", point=row.point or "")


def _open(words: Words, results: AdjustmentResults) -> Iterator[str]:
    found = results.observability
    of_parameters = [row for row in found if row.kind == "parameter"]
    images = [name for row in found if row.kind == "image" for name in row.names]
    n_apart = sum(row.kind == "connection" for row in found)
    parts = []
    if of_parameters:
        parts.append(_open_parameters(words, results, of_parameters))
    if images:
        parts.append(words.counted("open.images", len(images)))
    if parts:
        yield words.text("open.found", what=words.joined(parts))
    if n_apart:
        yield words.text("open.parts", n=fmt.count(n_apart + 1))


def _open_parameters(
    words: Words, results: AdjustmentResults, found: Sequence[Undetermined]
) -> str:
    """Open parameters, and whether priors keep all of them near zero."""
    what = words.joined(_of_scopes(words, found))
    names = {(name, row.scope) for row in found for name in row.names}
    priors = [
        row.prior_sigma
        for row in results.parameters
        if (row.name, row.scope) in names and not row.prior_released
    ]
    if None in priors or len(priors) < len(names):
        return what
    return words.counted("open.prior_holds", len(names), what=what)


def _of_scopes(words: Words, found: Sequence[Undetermined]) -> Iterator[str]:
    """Every parameter once, with the number of strips in which it is open."""
    scopes: dict[str, list[str]] = {}
    for row in found:
        for name in row.names:
            scopes.setdefault(name, []).append(row.scope)
    for name, where in scopes.items():
        parameter = words.parameter(name)
        if where == ["block"]:
            yield parameter
        else:
            yield words.counted("open.in_strips", len(where), parameter=parameter)
