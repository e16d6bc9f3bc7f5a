"""SVG of matplotlib made fit to stand in a page beside others, small and without outside links."""

import re
from html import escape

FEW_MARKERS = 8

_NUMBER = re.compile(r"-?\d+(?:\.\d+)?(?:e-?\d+)?")
_MARKER = re.compile(r"<path id=\"(m[0-9a-f]+)\" d=\"([^\"]*)\"")
_USES = re.compile(
    r"<g(?P<clip>[^>]*)>\s*(?P<uses><use xlink:href=\"#(?P<id>[^\"]+)\"[^>]*/>\s*"
    r"(?:<use xlink:href=\"#(?P=id)\"[^>]*/>\s*)*)</g>"
)
_BARE_GROUP = re.compile(r"<g(?: id=\"[^\"]*\")?\s*/?>")
_USE = re.compile(r"x=\"([^\"]*)\" y=\"([^\"]*)\" style=\"([^\"]*)\"")


def embeddable(svg: str, name: str, title: str, share: float) -> str:
    """Prepare a picture for a page.

    Parameters
    ----------
    svg
        Text as matplotlib writes it.
    name
        Prefix of every id, so that the ids of several pictures differ.
    title
        Alternative text.
    share
        Width of the picture as a share of the text's width.
    """
    svg = svg[svg.index("<svg") :]
    svg = re.sub(r"<metadata>.*?</metadata>\s*", "", svg, flags=re.DOTALL)
    # A style sheet inside the picture would style the whole page.
    svg = re.sub(
        r"<defs>\s*<style type=\"text/css\">.*?</style>\s*</defs>", "", svg, flags=re.DOTALL
    )
    shapes = dict(_MARKER.findall(svg))
    svg = _USES.sub(lambda match: _merged(match, shapes), svg)
    svg = re.sub(r"\bd=\"([^\"]*)\"", lambda match: f'd="{_compact(match[1])}"', svg)
    svg = re.sub(r" transform=\"rotate\(-0 [^)]*\)\"", "", svg)
    svg = _without_bare_groups(svg)
    # WeasyPrint does not expect blanks between families.
    svg = re.sub(r"font-family: [^;\"]*", lambda match: match[0].replace(", ", ","), svg)
    svg = re.sub(r"(\bid=\"|url\(#|href=\"#)", rf"\g<1>{name}-", svg)
    label = escape(title)
    style = f"--share: {share:.3f}; stroke-linejoin: round; stroke-linecap: butt"
    svg = svg.replace("<svg", f'<svg role="img" aria-label="{label}" style="{style}"', 1)
    return re.sub(r"<svg[^>]*>", lambda match: f"{match[0]}<title>{label}</title>", svg, count=1)


def _merged(match: re.Match[str], shapes: dict[str, str]) -> str:
    """Many markers of one look as one path: pages are laid out several times faster."""
    uses = [_USE.search(use) for use in match["uses"].split("<use")[1:]]
    looks = {use[3] for use in uses if use}
    if len(uses) < FEW_MARKERS or len(looks) != 1 or match["id"] not in shapes:
        return match[0]
    places = [(float(use[1]), float(use[2])) for use in uses if use]
    path = " ".join(_moved(shapes[match["id"]], x, y) for x, y in places)
    return f'<g{match["clip"]}><path d="{path}" style="{looks.pop()}"/></g>'


def _without_bare_groups(svg: str) -> str:
    """Drop groups that carry nothing but an id: nothing refers to them, and layout costs time."""
    kept: list[bool] = []

    def tag(match: re.Match[str]) -> str:
        if match[0] == "</g>":
            return match[0] if kept.pop() else ""
        keep = _BARE_GROUP.fullmatch(match[0]) is None
        if not match[0].endswith("/>"):
            kept.append(keep)
        return match[0] if keep else ""

    return re.sub(r"<g(?: [^>]*)?>|</g>", tag, svg)


def _moved(path: str, x: float, y: float) -> str:
    """A path of absolute commands (M, L, C, Q, z: coordinates in pairs) shifted by x, y."""
    offsets = (x, y)
    turn = iter(range(path.count(" ") + path.count("\n") + 2))
    return _NUMBER.sub(lambda match: f"{float(match[0]) + offsets[next(turn) % 2]:.2f}", path)


def _compact(path: str) -> str:
    """Coordinates to a hundredth of a point, which no printer shows."""
    return " ".join(_NUMBER.sub(lambda match: f"{float(match[0]):.2f}", path).split())
