"""A small acceptance document with tables, a figure and data, made as `posstats accept` does."""

import datetime as dt
import hashlib
import html
import io
from dataclasses import replace
from functools import cache
from importlib.metadata import version

import acceptance_values as values
import pikepdf
from cryptography import x509
from cryptography.hazmat.primitives import hashes
from cryptography.hazmat.primitives.asymmetric import ec
from cryptography.hazmat.primitives.serialization import (
    BestAvailableEncryption,
    Encoding,
    NoEncryption,
    pkcs12,
)
from cryptography.x509.oid import NameOID

from posstats import __version__
from posstats.contract.acceptance import Acceptance, AttachedFile, JudgedPoint, JudgedRequirement
from posstats.contract.files import to_json
from posstats.contract.results import Results
from posstats.contract.survey import InputFile
from posstats.reports.archive.writing import Attachment, render_archive
from posstats.reports.typefaces import fonts
from posstats.reports.verification.steps import Steps

CREATED = "2026-01-02T03:04:05+00:00"
NOW = dt.datetime(2026, 6, 1, 12, tzinfo=dt.UTC)
ALWAYS = (-10_000, 40_000)
"""Days around NOW: a certificate for programs that read the clock of the machine."""
INPUTS = {"block.toml": b'name = "flight7"\n', "orientations.csv": b"image,x\na,1.0\n"}
PROFILE = b'name = "house"\nlimit = 0.1\n'
TEMPLATE = b"<p>Example Survey Ltd</p>"
PIXEL = (  # with transparency
    "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mP8z8BQDwAEhQGAhKmMIQAAAABJRU5Erk"
    "Jggg=="
)
PAGE = """<!DOCTYPE html><html lang="en"><head><title>Acceptance {id}</title>
<meta name="author" content="Example Survey Ltd"><style>
@font-face {{ font-family: "DejaVu Sans"; src: url({font}) }}
@page {{ size: A4; margin: 25mm; @top-left {{ content: "{id}, page " counter(page) " of "
  counter(pages); border-bottom: 1px solid }} }}
body {{ font-family: "DejaVu Sans" }} h1 {{ break-before: page }}
li a::after {{ content: " " target-counter(attr(href), page) }}
td, th {{ border: 1px solid; background: #eee }}
</style></head><body><h2 id="top">{verdict}</h2>{letterhead}
<p>{block}: RMSE {rmse} m, limit {limit} m</p>
<ul><li><a href="#points">Check points</a></li></ul>
<img alt="logo" src="data:image/png;base64,{pixel}" width="20">
<figure><svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 100 50" width="300">
<title>Residual plan</title><circle cx="20" cy="20" r="10" opacity="0.5"/>
<text x="30" y="20">north</text></svg><figcaption>Figure 1. Plan</figcaption></figure>
<h1 id="points">Check points</h1>
<table><caption>Table 1</caption><thead><tr><th scope="col">point</th><th scope="col">dx, m</th>
</tr></thead><tbody>{rows}</tbody></table></body></html>"""


@cache
def _font() -> str:
    return fonts.data_uri("", "normal")


@cache
def _remembered(page: str, files: tuple[Attachment, ...], created: str, identifier: bytes) -> bytes:
    return render_archive(page, files, created, identifier)


def remembering(page, files, created, identifier) -> bytes:
    """`render_archive`, which gives the same bytes for the same arguments, called once for them."""
    in_order = sorted(files, key=lambda file: file.name)  # any order gives the same bytes
    return _remembered(page, tuple(in_order), created, identifier)


def render_document(acceptance, results, templates) -> str:
    """A page as a function of its data alone."""
    (judged,) = acceptance.requirements
    rows = "".join(
        f'<tr><th scope="row">{html.escape(row.point)}</th><td>{row.dx_m:.3f}</td></tr>'
        for row in acceptance.check_points
    )
    return PAGE.format(
        id=acceptance.document_id,
        verdict=html.escape(acceptance.verdict),
        letterhead=b"".join(templates.values()).decode(),
        block=html.escape(results.block.name),
        rmse=judged.found,
        limit=judged.limit,
        pixel=PIXEL,
        font=_font(),
        rows=rows,
    )


def reassess(results, profile_files, acceptance) -> Acceptance:
    limit = float(profile_files["house.toml"].rsplit(b"=")[-1])
    rows = results.check_point_residuals
    worst = max(row.dx_m for row in rows)
    kept = worst <= limit
    judged = JudgedRequirement(
        id="worst", clause="1", quantity="largest_residual_h", source="house", mandatory=True,
        exceeding="fail", found=worst, limit=limit, limit_formula="0.1", unit="m",
        margin=limit - worst, verdict="pass" if kept else "fail",
        reason_code="within" if kept else "exceeds", reason_values={},
    )  # fmt: skip
    points = [{n: v for n, v in vars(row).items() if n != "orientation"} for row in rows]
    return replace(
        acceptance,
        verdict="accepted" if kept else "rejected",
        requirements=(judged,),
        check_points=tuple(JudgedPoint(**row, dh_m=row["dx_m"], blunder=False) for row in points),
    )


def recompute(folder, pattern) -> Results:
    x = float((folder / "orientations.csv").read_text().split(",")[-1])
    row = values.results().check_point_residuals[0]
    points = (
        replace(row, point=f"p{n}", dx_m=0.001 * n * x, dy_m=0.0, dz_m=0.0) for n in range(25)
    )
    return replace(pattern, check_point_residuals=tuple(points))


NUMBERS = {"posstats": __version__, "numpy": "2.4"}
LAYOUT = f"posstats {__version__}, WeasyPrint {version('weasyprint')}"
STEPS = Steps(recompute, reassess, render_document, NUMBERS, LAYOUT)


def sha256(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()


@cache
def _pattern() -> tuple[Results, Acceptance]:
    """Small results and an acceptance, neither computed."""
    results = replace(
        values.results(),
        posstats_version=__version__, versions={"numpy": "2.4"}, created=CREATED,
        images=(), parallax=(), models=(), error_sources=(), angle_errors=(), regression=(),
    )  # fmt: skip
    return results, values.acceptance(0)


def results_of(folder) -> Results:
    results, _ = _pattern()
    inputs = tuple(InputFile(file=name, sha256=sha256(each)) for name, each in INPUTS.items())
    block = replace(results.block, name="flight <7>", inputs=inputs)
    return recompute(folder, replace(results, block=block))


def contents(results, *, change=lambda values: None) -> tuple[Acceptance, list[Attachment]]:
    """The acceptance of results, and all files to embed."""
    files = [
        Attachment("results.json", to_json(results).encode()),
        Attachment("profile.toml", PROFILE, "Source"),
        Attachment("block.toml", INPUTS["block.toml"], "Source"),
        Attachment("tables/points.csv", b"point,dx_m\np1,0.1\n", "Supplement"),
        Attachment("templates/logo.svg", TEMPLATE, "Supplement"),
    ]
    _, pattern = _pattern()
    profile = (InputFile(file="house.toml", sha256=sha256(PROFILE)),)
    pattern = replace(
        pattern,
        posstats_version=__version__,
        versions={"numpy": "2.4", "weasyprint": version("weasyprint")},
        created=CREATED,
        profile=replace(pattern.profile, files=profile),
        results=InputFile(file="results.json", sha256=sha256(files[0].content)),
        attachments=tuple(
            AttachedFile(
                file=each.name, sha256=sha256(each.content), relationship=each.relationship
            )
            for each in files
        ),
    )
    assessed = reassess(results, {"house.toml": PROFILE}, pattern)
    acceptance = values.edited(assessed, change)
    return acceptance, [*files, Attachment("acceptance.json", to_json(acceptance).encode())]


def document(
    results,
    *,
    change=lambda values: None,
    edit=lambda page: page,
    render=remembering,
) -> bytes:
    """The PDF; `change` the values of its data before it is laid out, `edit` the page alone."""
    acceptance, files = contents(results, change=change)
    page = edit(render_document(acceptance, results, {"letterhead.html.j2": TEMPLATE}))
    return render(page, files, acceptance.created, acceptance.document_id.encode())


def write_inputs(folder) -> None:
    folder.mkdir(exist_ok=True)
    for name, content in INPUTS.items():
        (folder / name).write_bytes(content)


def appended_update(data: bytes, objects: dict[int, bytes], size: int) -> bytes:
    """An incremental update by hand: objects by number."""
    pdf = pikepdf.open(io.BytesIO(data))
    root, info = pdf.trailer.Root.objgen[0], pdf.trailer.Info.objgen[0]
    previous = int(data.rsplit(b"startxref", 1)[1].split()[0])
    out, table = bytearray(data), bytearray(b"xref\n0 1\n0000000000 65535 f \n")
    for number, content in objects.items():
        table += b"%d 1\n%010d 00000 n \n" % (number, len(out))
        out += b"%d 0 obj\n%b\nendobj\n" % (number, content)
    start = len(out)
    out += table + b"trailer\n<</Size %d/Root %d 0 R/Info %d 0 R/Prev %d>>\n" % (
        size,
        root,
        info,
        previous,
    )
    return bytes(out + b"startxref\n%d\n%%%%EOF\n" % start)


@cache
def _key(name: str) -> ec.EllipticCurvePrivateKey:
    return ec.generate_private_key(ec.SECP256R1())


def certificate(name="Example Survey Ltd", issuer=None, days=(-10, 365), usage=True, key=None):
    """A certificate; without issuer self-signed; keys are called by names."""
    names = [
        x509.Name([x509.NameAttribute(NameOID.COMMON_NAME, each)])
        for each in (name, issuer or name)
    ]
    builder = (
        x509.CertificateBuilder(names[1], names[0], _key(key or name).public_key())
        .serial_number(x509.random_serial_number())
        .not_valid_before(NOW + dt.timedelta(days=days[0]))
        .not_valid_after(NOW + dt.timedelta(days=days[1]))
        .add_extension(x509.BasicConstraints(issuer is None, None), critical=True)
    )
    if usage is not None:
        flags = [usage, usage, not usage, False, False, issuer is None, False, False, False]
        builder = builder.add_extension(x509.KeyUsage(*flags), critical=True)
    return builder.sign(_key(issuer or key or name), hashes.SHA256())


def pem(cert) -> bytes:
    return cert.public_bytes(Encoding.PEM)


def p12(cert, name="Example Survey Ltd", passphrase=b"secret") -> bytes:
    packed = BestAvailableEncryption(passphrase) if passphrase else NoEncryption()
    return pkcs12.serialize_key_and_certificates(b"key", _key(name), cert, None, packed)
