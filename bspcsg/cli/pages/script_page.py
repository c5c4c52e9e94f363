"""Running a script again whenever it changes, and serving a page with its result."""

import os
import threading
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from ...browsing import open_page
from ...errors import BspcsgError
from ..console import clock, output
from ..console.output import Output
from ..solid_verb import SolidVerb
from .file_pages import folders_of, page_of
from .live_server import LiveServer, Site, change_stamp

if TYPE_CHECKING:
    from ...report.viewer.layer import Layer
    from ...solid.solid import Solid

#: The time between two checks whether files have changed, in seconds.
_POLL_INTERVAL = 0.2


class ScriptPage:
    """A script that is run again when it changes, with a new job for each run.

    Parameters
    ----------
    script : Path
    job : callable
        Makes the job of one run.
    out : Output
    goes_on : bool
        True to run again whenever the script or a file beside it changes.
    """

    def __init__(
        self, script: Path, job: Callable[[], SolidVerb], out: Output, goes_on: bool = True
    ) -> None:
        self._script = script
        self._job = job
        self._out = out
        self._goes_on = goes_on
        self._runs = 0
        self._made: Solid | BspcsgError | None = None
        self._code = output.DONE

    def run(self, port: int | None = None, opens: bool = True) -> int:
        """Run until Ctrl-C, and return the exit code of the last run.

        Parameters
        ----------
        port : int, optional
            The port at which a page with the result is served, 0 for any; None for no page.
        opens : bool
            True to open the page in a browser.
        """
        server = None
        try:
            self._once()
            if port is not None:
                server = self._serve(port, opens)
            if self._goes_on:
                self._out.note(f"watching {self._script} until Ctrl-C")
            self._go_on()
        except KeyboardInterrupt:
            pass
        finally:
            if server is not None:
                server.shutdown()
                server.server_close()
        return self._code

    def _once(self) -> None:
        clock.start()
        self._before = change_stamp([self._script])
        job = self._job()
        try:
            self._code = job.run()
            self._made = job.made
        except BspcsgError as error:
            self._code = output.report_error(error, self._out.as_json)
            self._made = error
        # Take the state after the run, so that files which the script writes cause no new run.
        self._around = change_stamp(folders_of([self._script]))
        self._runs += 1

    def _go_on(self) -> None:
        while True:
            time.sleep(_POLL_INTERVAL)
            now = change_stamp([self._script]), change_stamp(folders_of([self._script]))
            if self._goes_on and now != (self._before, self._around):
                self._once()

    def _serve(self, port: int, opens: bool) -> LiveServer:
        site = Site(self._page, lambda: str(self._runs))
        server = LiveServer(site, port)
        threading.Thread(target=server.serve_forever, args=(_POLL_INTERVAL,), daemon=True).start()
        self._out.note(f"{server.address} shows the result until Ctrl-C")
        if opens:
            open_page(server.address)
        return server

    def _page(self, path: str) -> str | None:
        return page_of([self._script], self._scene) if path == "/" else None

    def _scene(self, files: Sequence[Path]) -> "tuple[list[Layer], str]":
        from ...report.viewer.layer_making import layers_of_solid, with_distinct_colours

        if isinstance(self._made, BspcsgError):
            raise self._made
        if self._made is None:
            return [], ""
        return with_distinct_colours(layers_of_solid(self._made, self._script.name)), ""


#: The output path of a result that is shown, but not written.
NOWHERE = Path(os.devnull)
