"""Reports of defects: a file with the call, its inputs, and the failure."""

import itertools
import os
import time
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from ._core import ObjectTree, PanicException, Tree, __version__

if TYPE_CHECKING:
    import zipfile

#: The largest number of reports that one process writes: a program that continues after a defect
#: may meet the defect often.
_MAX_REPORTS = 16

_numbers = itertools.count(1)


def report(message: str, call: str, inputs: Mapping[str, Any]) -> str | None:
    """Write a report into the folder for temporary files; return its path, or None.

    The file is a ZIP archive that only its owner may read: ``report.json`` with the message, the
    call, the versions and small inputs, arrays as ``.npy`` files, trees as ``.snapshot`` files.
    Errors in here are never raised.
    """
    try:
        return _written(message, call, inputs) if next(_numbers) <= _MAX_REPORTS else None
    except Exception:
        return None


def _written(message: str, call: str, inputs: Mapping[str, Any]) -> str:
    # Imported late: every start needs this module, and hardly any writes a report.
    import json
    import platform
    import tempfile
    import zipfile

    import numpy as np

    facts = {
        "message": message,
        "call": call,
        "bspcsg": __version__,
        "python": platform.python_version(),
        "numpy": np.__version__,
        "platform": platform.platform(),
        "processors": os.cpu_count(),
        "time": time.strftime("%Y-%m-%dT%H:%M:%SZ", time.gmtime()),
    }
    handle, path = tempfile.mkstemp(prefix="bspcsg-report-", suffix=".zip")
    with (
        os.fdopen(handle, "wb") as file,
        zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED) as archive,
    ):
        small = {name: _put(archive, name, value) for name, value in inputs.items()}
        archive.writestr(
            "report.json", json.dumps(facts | {"inputs": small}, indent=1, default=repr)
        )
    return path


def _put(archive: "zipfile.ZipFile", name: str, value: Any) -> Any:
    """Put a large input into the archive; return the entry for it in `report.json`."""
    import io

    import numpy as np

    try:
        if isinstance(value, np.ndarray):
            content = io.BytesIO()
            np.save(content, value, allow_pickle=False)
            name, data = f"{name}.npy", content.getvalue()
        elif isinstance(value, Tree | ObjectTree):
            name, data = f"{name}.snapshot", value.dump()
        else:
            return value
    except (Exception, PanicException) as error:
        return f"not written: {error!r}"
    archive.writestr(name, data)
    return name
