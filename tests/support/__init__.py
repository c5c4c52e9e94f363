"""The common part of the tests: plain shapes as arrays, and the checks of a sound result."""

import os

#: True to take the time for everything, as `scripts/check --deep` does.
DEEP = bool(os.environ.get("BSPCSG_DEEP"))
