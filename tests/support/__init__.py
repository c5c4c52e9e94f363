"""What the tests share: plain shapes as arrays, and what a sound result must satisfy."""

import os

#: Whether to take the time for everything, as `scripts/check --deep` does.
DEEP = bool(os.environ.get("BSPCSG_DEEP"))
