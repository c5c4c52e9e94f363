"""Lets Lighthouse judge the landing page of the site, as a phone on a slow network opens it.

    scripts/site && scripts/lighthouse

Needs npm with Node 22, its registry, and Chromium. The score of performance is that of a simulated
phone, and falls when the machine has other work. With --record the figures are kept.
"""

import argparse
import functools
import http.server
import json
import os
import shutil
import subprocess
import sys
import tempfile
import threading
from pathlib import Path
from typing import Any

from recording import REPOSITORY, keep

_LIGHTHOUSE = "lighthouse@13.5.0"

_CATEGORIES = ("performance", "accessibility", "best-practices", "seo")

_FIGURES = {
    "first_contentful_paint_ms": "first-contentful-paint",
    "largest_contentful_paint_ms": "largest-contentful-paint",
    "total_blocking_time_ms": "total-blocking-time",
    "bytes": "total-byte-weight",
}


class _Quiet(http.server.SimpleHTTPRequestHandler):
    """Serves files and says nothing of it."""

    def log_message(self, *_: object) -> None:
        """Say nothing."""


def judged(site: Path, page: str) -> dict[str, Any]:
    """Return what Lighthouse says of a page of a folder."""
    handler = functools.partial(_Quiet, directory=str(site))
    with http.server.ThreadingHTTPServer(("127.0.0.1", 0), handler) as server:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        try:
            return _report(f"http://127.0.0.1:{server.server_port}/{page}")
        finally:
            server.shutdown()


def _report(address: str) -> dict[str, Any]:
    with tempfile.TemporaryDirectory() as folder:
        profile = f"--user-data-dir={folder}/profile"
        flags = (
            f"--headless=new --no-sandbox --disable-gpu --disable-background-networking {profile}"
        )
        command = ["npx", "--yes", _LIGHTHOUSE, address, "--quiet", "--no-enable-error-reporting"]
        command += ["--output=json", f"--output-path={folder}/report.json"]
        command += [f"--only-categories={','.join(_CATEGORIES)}", f"--chrome-flags={flags}"]
        chromium = {"CHROME_PATH": shutil.which("chromium") or ""}
        subprocess.run(command, check=True, env=chromium | dict(os.environ), timeout=600)
        return dict(json.loads(Path(folder, "report.json").read_text(encoding="utf-8")))


def figures_of(report: dict[str, Any]) -> dict[str, float]:
    """Return the scores, of 100, and the figures below them."""
    scores = {name: round(100 * report["categories"][name]["score"]) for name in _CATEGORIES}
    audits = report["audits"]
    return scores | {key: round(audits[name]["numericValue"]) for key, name in _FIGURES.items()}


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("site", nargs="?", type=Path, default=REPOSITORY / "out" / "site")
    parser.add_argument("--page", default="docs/index.html")
    parser.add_argument("--record", action="store_true", help="keep the figures")
    options = parser.parse_args()
    if not (options.site / options.page).is_file():
        parser.error(f"{options.site / options.page} is not there; run scripts/site")
    figures = figures_of(judged(options.site, options.page))
    for name, value in figures.items():
        print(f"{name:28} {value}")
    if options.record:
        named = {"lighthouse": _LIGHTHOUSE, "page": options.page, "load": os.getloadavg()[0]}
        print(f"kept in {keep('lighthouse', named | figures)}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
