"""The processor time of work, for tests of how cost grows."""

import time
from collections.abc import Callable


def seconds(work: Callable[[], object], turns: int = 1) -> float:
    """Return the least processor time of several calls of `work`, in seconds."""

    def once() -> float:
        began = time.process_time()
        work()
        return time.process_time() - began

    return min(once() for _ in range(turns))
