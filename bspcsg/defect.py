"""Reports of defects of this package: files with the failed call, its inputs and the error."""

import itertools
import os
import time
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from ._core import ObjectTree, PanicException, Tree, __version__

if TYPE_CHECKING:
    import zipfile

#: The largest number of reports that one process writes, since a program that continues after a
#: defect may repeat it often.
_MAX_REPORTS = 16

_numbers = itertools.count(1)


def report(message: str, call: str, inputs: Mapping[str, Any]) -> str | None:
    """Write a report of a defect into the folder for temporary files, and return its path.

    The file is a ZIP archive that only its owner may read: ``report.json`` with the message, the
    call, the versions and small inputs, arrays as ``.npy`` files, trees as ``.snapshot`` files.
    None means that writing failed, or that this process has written too many reports.
    """
    try:
        return _written(message, call, inputs) if next(_numbers) <= _MAX_REPORTS else None
    except Exception:
        return None


def _written(message: str, call: str, inputs: Mapping[str, Any]) -> str:
    # Import these modules only when a report is written, so that programs start faster.
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
    """Return the entry of an input in `report.json`: a small value, or the name of an archive file.

    Arrays and trees are written into the archive.
    """
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
