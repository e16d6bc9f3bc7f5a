"""HTML to PDF by WeasyPrint: vector figures, bookmarks, tags; nothing loaded from anywhere."""

from typing import Any

from posstats.errors import PosstatsError

DEBIAN_PACKAGES = "libpango-1.0-0 libpangoft2-1.0-0 libharfbuzz-subset0"


class PdfUnavailableError(PosstatsError):
    """The libraries that WeasyPrint needs are not installed."""


def render(html_text: str) -> bytes:
    """Render a self-contained HTML page as PDF.

    Raises
    ------
    PdfUnavailableError
        If the libraries that WeasyPrint needs are not installed.
    """
    weasyprint, fetcher = load()
    page = weasyprint.HTML(string=html_text, url_fetcher=fetcher)
    pdf: bytes = page.write_pdf(pdf_tags=True, pdf_identifier=b"posstats-report")
    return pdf


def load() -> tuple[Any, Any]:
    """WeasyPrint, and a fetcher that gives it nothing but ``data:`` URIs.

    Raises
    ------
    PdfUnavailableError
        If the libraries that WeasyPrint needs are not installed.
    """
    try:
        import weasyprint
        from weasyprint.urls import URLFetcher
    except OSError as error:
        raise PdfUnavailableError(
            "No PDF was written: WeasyPrint's libraries are not installed. On Debian or Ubuntu: "
            f"sudo apt-get install {DEBIAN_PACKAGES}. The HTML report needs none of them. ({error})"
        ) from error
    return weasyprint, URLFetcher(allowed_protocols=("data",))
