"""Starts a worker, and beside it what ends it with its runner.

No part of the package is imported before: that takes a while, in which a runner can end, and starts
threads, with which a process is not divided.
"""

import os
import select
import signal

#: In a process that has just begun, all open file descriptors have lower numbers than this.
_MAX_DESCRIPTORS = 1024


def end_with_runner() -> None:
    """Start a process of this group that kills it when its input has no writer any more.

    A thread would wait for the lock of Python's, which another library may hold for minutes.
    """
    if os.name != "posix" or os.getpgrp() != os.getpid() or os.fork():
        return
    try:
        # Who reads what the worker says must not wait for the end of this process.
        os.closerange(1, _MAX_DESCRIPTORS)
        waiting = select.poll()
        waiting.register(0, 0)
        waiting.poll()
        os.killpg(0, signal.SIGKILL)
    finally:
        os._exit(1)


if __name__ == "__main__":
    end_with_runner()
    from bspcsg.campaign.running.worker import main

    main()
