"""A local web server whose pages reload in the browser when their content changes."""

import contextlib
import os
import threading
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from http import HTTPStatus
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

from ...errors import FormatError

#: The only address at which the server listens: that of this machine for itself.
_HERE = "127.0.0.1"

#: The host names of valid requests; a request for another name may come from a foreign web page
#: whose name was made to resolve to this machine (DNS rebinding).
_OWN_NAMES = (_HERE, "localhost")

#: The largest number of requests that are answered at the same time; a browser sends up to six.
_MAX_CONCURRENT_REQUESTS = 8

#: The number of seconds after which a connection without data is closed.
_IDLE_TIMEOUT = 30

#: The largest number of files that are watched for changes.
_MAX_FILES_WATCHED = 2000

#: The time between two checks of whether the server has to end, in seconds.
_POLL_INTERVAL = 0.2


@dataclass(frozen=True)
class Site:
    """The pages that a live server shows.

    Parameters
    ----------
    page : callable
        Returns the HTML page at a path, or None if there is none.
    state : callable
        Returns a text that changes whenever the content of a page changes.
    """

    page: Callable[[str], str | None]
    state: Callable[[], str]


class LiveServer(ThreadingHTTPServer):
    """A local web server that ends with the process, without waiting for connections.

    Parameters
    ----------
    site : Site
    port : int
        The port; 0 for any free one.

    Raises
    ------
    FormatError
        If the port is taken or forbidden; code "unwritable".
    """

    daemon_threads = True
    block_on_close = False

    def __init__(self, site: Site, port: int = 0) -> None:
        try:
            super().__init__((_HERE, port), _Handler)
        except OSError as error:
            message = (
                f"port {port}: the server cannot use this port ({error.strerror}); leave out"
                " --port to use a free one."
            )
            raise FormatError(message, "unwritable") from error
        self.site = site
        self.places = threading.BoundedSemaphore(_MAX_CONCURRENT_REQUESTS)
        self.making = threading.Lock()

    @property
    def address(self) -> str:
        """The address of the server, which a browser can open."""
        return f"http://{_HERE}:{self.server_port}/"

    def handle_error(self, request: Any, client_address: Any) -> None:
        """Ignore errors of requests, such as that the browser has closed the connection."""

    def serve(self) -> None:
        """Answer requests until Ctrl-C, then close the server."""
        with contextlib.suppress(KeyboardInterrupt):
            self.serve_forever(_POLL_INTERVAL)
        self.server_close()


class _Handler(BaseHTTPRequestHandler):
    """The handler of one connection to a live server."""

    timeout = _IDLE_TIMEOUT
    server: LiveServer

    def do_GET(self) -> None:
        """Answer a request with the page at its path, or “/changes” with the state of the site."""
        host = urlsplit(f"//{self.headers.get('Host', '')}").hostname
        if host not in _OWN_NAMES:
            self._send(
                HTTPStatus.FORBIDDEN,
                "This server only answers requests from the machine on which it runs.",
                "plain",
            )
            return
        path = urlsplit(self.path).path
        with self.server.places:
            if path == "/changes":
                self._send(HTTPStatus.OK, self.server.site.state(), "plain")
                return
            with self.server.making:
                page = self.server.site.page(path)
        if page is None:
            self._send(HTTPStatus.NOT_FOUND, "This page does not exist.", "plain")
        else:
            self._send(HTTPStatus.OK, page, "html")

    def _send(self, status: HTTPStatus, text: str, kind: str) -> None:
        data = text.encode("utf-8", "replace")
        self.send_response(status)
        self.send_header("Content-Type", f"text/{kind}; charset=utf-8")
        self.send_header("Content-Length", str(len(data)))
        self.send_header("Cache-Control", "no-store")
        self.end_headers()
        self.wfile.write(data)

    def log_message(self, *args: Any) -> None:
        """Do not log requests."""


def change_stamp(paths: Iterable[Path]) -> str:
    """Return a text that changes whenever a named file, or a file in a named folder, changes."""
    marks = []
    for path in _files(paths):
        try:
            found = path.stat()
        except OSError:
            marks.append(f"{path}:gone")
        else:
            marks.append(f"{path}:{found.st_mtime_ns}:{found.st_size}")
    return f"{hash(tuple(marks)):x}"


def _files(paths: Iterable[Path]) -> list[Path]:
    """Return the named files and the files of named folders, at most `_MAX_FILES_WATCHED`."""
    found: list[Path] = []
    for path in paths:
        if path.is_dir():
            with contextlib.suppress(OSError), os.scandir(path) as entries:
                found += sorted(Path(entry.path) for entry in entries if not entry.is_dir())
        else:
            found.append(path)
    return found[:_MAX_FILES_WATCHED]
