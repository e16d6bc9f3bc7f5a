"""The verdict on an adjustment in one paragraph of plain words, and its key figures."""

from collections.abc import Iterator

from ..document import format as fmt
from ..document.key_figure import KeyFigure
from .view import (
    KINDS,
    SEVERAL,
    Results,
    Row,
    first,
    group,
    parameter_words,
    predicted_rmse,
    rows,
    value_words,
)

DOUBTFUL_P = 0.05
SHOWN = 4


def paragraph(results: Results) -> str:
    """Convergence, fit, POS errors, image deformation, check points, blunders, what is open."""
    sentences = (
        _fit(results),
        _errors(results),
        _deformation(results),
        _check_points(results),
        blunders(results),
        _open(results),
    )
    return " ".join(sentence for sentence in sentences if sentence)


def _fit(results: Results) -> str:
    steps, sigma0, p = results["n_iterations"], results["sigma0"], results["chi2_p"]
    text = f"The adjustment converged in {steps} steps"
    if fmt.is_missing(sigma0):
        return f"{text}; nothing is redundant, so that nothing was tested."
    text += (
        f": sigma0 is {fmt.number(sigma0)} with {fmt.count(results['dof'])} degrees of freedom. "
    )
    if fmt.is_missing(p) or p >= DOUBTFUL_P:
        return f"{text}The chi-square test agrees with the weights ({fmt.p_phrase(p)})."
    sides = "worse" if sigma0 > 1.0 else "better"
    return (
        f"{text}The chi-square test contradicts the weights ({fmt.p_phrase(p)}): the observations "
        f"are {sides} than stated. Standard deviations below are scaled by sigma0."
    )


def _errors(results: Results) -> str:
    """POS errors that are significant."""
    if results["settings"]["drift"] == "none":
        return "No systematic errors of the POS were estimated."
    known = [row for row in rows(results, "parameters") if _is_of_pos(row["name"])]
    found = [row for row in known if row["significant"] and row["determined"]]
    if not found:
        return "No systematic error of the POS is significant."
    words = list(_described(found))
    return f"Errors of the POS that are significant: {'; '.join(words)}."


def _is_of_pos(name: str) -> bool:
    return name.startswith(("gnss", "imu", "boresight", "lever"))


def _described(found: list[Row]) -> Iterator[str]:
    """One phrase for every kind of parameter, whatever the number of its scopes."""
    for name in dict.fromkeys(row["name"] for row in found):
        same = [row for row in found if row["name"] == name]
        largest = max(same, key=lambda row: abs(row["value"]))
        text = f"{parameter_words(name)} {value_words(largest)}"
        if largest["scope"] != "block":
            more = "" if len(same) == 1 else f", the largest of {len(same)}"
            text += f" (strip {largest['scope']}{more})"
        yield text


def _deformation(results: Results) -> str:
    if results["settings"]["self_calibration"] == "none":
        return ""
    known = [row for row in rows(results, "parameters") if not _is_of_pos(row["name"])]
    found = [row for row in known if row["significant"]]
    if not found:
        return "No image deformation is significant."
    return f"Image deformation: {fmt.joined(parameter_words(row['name']) for row in found)}."


def _check_points(results: Results) -> str:
    row = first(results, "check_points", orientation="bundle", translation_removed=False)
    if fmt.is_missing(row.get("rmse_horizontal_m")):
        return "No check points were used, so the ground was not tested."
    text = (
        f"At {_number_of(row['n'])}, which took no part, the RMSE is "
        f"{_m(row['rmse_horizontal_m'])} horizontally and {_m(row['rmse_vertical_m'])} vertically"
    )
    predicted = predicted_rmse(results)
    if predicted is not None:
        text += f"; the covariances predict {_m(predicted[0])} and {_m(predicted[1])}"
    pos = first(results, "check_points", orientation="pos", translation_removed=False)
    if not fmt.is_missing(pos.get("rmse_horizontal_m")):
        text += (
            f". The POS as delivered gives {_m(pos['rmse_horizontal_m'])} and "
            f"{_m(pos['rmse_vertical_m'])}"
        )
    return f"{text}."


def _number_of(n: int) -> str:
    return "one check point" if n == 1 else f"{fmt.count(n)} check points"


def _m(value: float) -> str:
    return fmt.with_unit(value, "m")


def blunders(results: Results) -> str:
    """What was taken out, in a sentence."""
    taken = rows(results, "blunders", found_by="snooping", taken_out=True)
    held = rows(results, "blunders", taken_out=False)
    parts = []
    for kind in dict.fromkeys(row["kind"] for row in taken if row["kind"] != "image"):
        same = [row for row in taken if row["kind"] == kind]
        parts += [_named(row) for row in same] if len(same) <= SHOWN else [_counted(kind, same)]
    n_rays = sum(row["kind"] == "image" for row in taken) + results["n_rejected_rays"]
    if n_rays:
        parts.append("one image ray" if n_rays == 1 else f"{fmt.count(n_rays)} image rays")
    sentences = [f"Taken out as blunders: {fmt.joined(parts)}."] if parts else []
    if held:
        names = fmt.joined(_named(row) for row in held)
        sentences.append(f"Contradicting others, but kept as the block needs it: {names}.")
    return " ".join(sentences) or "No blunders were found."


def _counted(kind: str, same: list[Row]) -> str:
    if kind == "control":
        return f"{len(same)} control points"
    return f"{SEVERAL[kind]} of {len(same)} images"


def _named(row: Row) -> str:
    if row["kind"] == "image":
        return f"{KINDS['image']} of point {row['point']} in {row['image']}"
    what = row["point"] if row["kind"] == "control" else row["image"]
    return f"{KINDS[row['kind']]} {what}"


def _open(results: Results) -> str:
    found = rows(results, "observability")
    parameters = [row for row in found if row["kind"] == "parameter"]
    images = [name for row in found if row["kind"] == "image" for name in row["names"]]
    apart = [row for row in found if row["kind"] == "connection"]
    parts = []
    if parameters:
        words = list(_of_scopes(parameters))
        parts.append(f"{fmt.joined(words)}{_held(results, parameters)}")
    if images:
        count = "one image" if len(images) == 1 else f"{fmt.count(len(images))} images"
        parts.append(f"an angle of {count}")
    text = f"Not determined by measurements: {fmt.joined(parts)}." if parts else ""
    if apart:
        text += f" The block falls into {len(apart) + 1} parts that no point ties together."
    return text.strip()


def _held(results: Results, found: list[Row]) -> str:
    """What keeps open parameters near zero, where all of them have a prior."""
    names = {(name, row["scope"]) for row in found for name in row["names"]}
    priors = [
        row["prior_sigma"]
        for row in rows(results, "parameters")
        if (row["name"], row["scope"]) in names and not row["prior_released"]
    ]
    if None in priors or len(priors) < len(names):
        return ""
    return f" ({'its' if len(names) == 1 else 'their'} prior holds)"


def _of_scopes(found: list[Row]) -> Iterator[str]:
    """Every parameter once, with the number of strips in which it is open."""
    scopes: dict[str, list[str]] = {}
    for row in found:
        for name in row["names"]:
            scopes.setdefault(name, []).append(row["scope"])
    for name, where in scopes.items():
        n = len(where)
        in_strips = f" in {n} strip{'s' if n > 1 else ''}"
        yield f"{parameter_words(name)}{in_strips if where != ['block'] else ''}"


def key_figures(results: Results) -> tuple[KeyFigure, ...]:
    """Sigma0, image residuals, accuracy of the orientations, check points."""
    image = group(results, "image")
    figures = [
        KeyFigure("sigma0", fmt.number(results["sigma0"]), "", fmt.p_phrase(results["chi2_p"])),
        KeyFigure(
            "Image residuals", fmt.number(image["rms"]), "px", f"RMS of {fmt.count(image['n'])}"
        ),
        _orientation_figure(results),
    ]
    row = first(results, "check_points", orientation="bundle", translation_removed=False)
    if not fmt.is_missing(row.get("rmse_horizontal_m")):
        value = f"{fmt.number(row['rmse_horizontal_m'])} / {fmt.number(row['rmse_vertical_m'])}"
        figures.append(
            KeyFigure("Check points", value, "m", f"RMSE H / V, {row['n']} points, mean kept")
        )
    return tuple(figures)


def _orientation_figure(results: Results) -> KeyFigure:
    by_element = {row["element"]: row for row in rows(results, "orientations")}
    worst = max(by_element[axis]["median_sigma"] for axis in "xyz")
    angle = max(by_element[name]["median_sigma"] for name in ("omega", "phi", "kappa"))
    remark = f"and {fmt.angle(angle, 2)}: medians of the worst axis"
    return KeyFigure("Orientations, std. dev.", fmt.number(worst), "m", remark)
