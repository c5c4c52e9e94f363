"""The time that work takes, for tests of how cost grows."""

import time
from collections.abc import Callable


def seconds(work: Callable[[], object], turns: int = 1) -> float:
    """Return the processor time of some work, the least of some turns."""

    def once() -> float:
        began = time.process_time()
        work()
        return time.process_time() - began

    return min(once() for _ in range(turns))
