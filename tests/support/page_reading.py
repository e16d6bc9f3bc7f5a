"""Reading pages as their readers do: the texts of HTML, the pages of a PDF, a browser."""

import re
import subprocess
from html.parser import HTMLParser
from pathlib import Path

from needed import program


class _Texts(HTMLParser):
    def __init__(self) -> None:
        super().__init__()
        self.tags: list[str] = []
        self.ids: list[str] = []
        self.links: list[str] = []
        self.texts: list[str] = []

    def handle_starttag(self, tag, attrs):
        self.tags.append(tag)
        self.ids += [value for name, value in attrs if name == "id"]
        names = ("href", "src", "xlink:href")
        self.links += [value for name, value in attrs if name in names]

    def handle_data(self, data):
        self.texts.append(data)


def read(text: str) -> _Texts:
    parser = _Texts()
    parser.feed(text)
    return parser


def plain(text: str) -> str:
    return text.replace("\u00a0", " ").replace("\u202f", " ")


def pdf_pages(path: Path) -> list[str]:
    command = [program("pdftotext", package="poppler-utils"), "-layout", str(path), "-"]
    run = subprocess.run(command, capture_output=True, check=True, text=True)
    return [plain(text) for text in run.stdout.split("\f")[:-1]]


PROBE = """<script>
const log = [];
addEventListener("error", event => log.push("error " + event.message), true);
document.addEventListener("securitypolicyviolation", e => log.push("request " + e.blockedURI));
addEventListener("load", () => document.fonts.ready.then(() => {
  const root = document.documentElement;
  log.push("width " + root.scrollWidth + " of " + root.clientWidth);
  log.push("requests " + performance.getEntriesByType("resource")
    .filter(entry => !entry.name.startsWith("data:")).length);
  log.push("fonts " + [...document.fonts].map(font => font.status).join(" "));
  parent.postMessage(log.join("; "), "*");
}));
</script>"""
FRAME = """<!DOCTYPE html><body><p id="told"></p>
<script>addEventListener("message", event => { told.textContent = event.data; });</script>
<iframe src="NAME" width="WIDTH" height="900" style="border: 0"></iframe></body>"""


def assert_shown_without_fault(page: str, width: int, folder: Path) -> None:
    """In a browser window of a width: no error, no request, no sideways scrolling."""
    probed = page.replace("<head>", f"<head>{PROBE}", 1)
    (folder / "page.html").write_text(probed, encoding="utf-8")
    frame = folder / "frame.html"
    inside = FRAME.replace("NAME", "page.html").replace("WIDTH", str(width))
    frame.write_text(inside, encoding="utf-8")
    told, errors = _browse(frame, folder / "profile")
    assert f"width {width} of {width}" in told
    assert "requests 0" in told
    assert "fonts loaded" in told
    assert "error" not in told
    assert "CONSOLE" not in errors


def _browse(frame: Path, profile: Path) -> tuple[str, str]:
    """What the page tells its frame, and the browser's log."""
    flags = [
        "--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run",
        "--disable-background-networking", "--disable-component-update", "--disable-sync",
        "--hide-scrollbars", "--enable-logging=stderr", "--allow-file-access-from-files",
        "--window-size=1400,1000", "--virtual-time-budget=8000",
    ]  # fmt: skip
    browser = program("chromium", "chromium-browser", package="chromium")
    command = [browser, *flags, f"--user-data-dir={profile}", "--dump-dom", frame.as_uri()]
    run = subprocess.run(command, capture_output=True, check=True, text=True)
    return re.search(r'id="told">([^<]*)', run.stdout)[1], run.stderr
