"""Starts a worker, and a process that ends the worker together with its runner.

No part of the package is imported before. Imports take a while, in which a runner can end, and
start threads, and a process with threads must not fork.
"""

import os
import select
import signal

#: In a process that has just begun, all open file descriptors have lower numbers than this.
_MAX_DESCRIPTORS = 1024


def end_with_runner() -> None:
    """Fork a process of this group that kills the group once nobody can write to its input.

    A thread would have to wait for Python's lock, which another library may hold for minutes.
    """
    if os.name != "posix" or os.getpgrp() != os.getpid() or os.fork():
        return
    try:
        # Readers of the worker's output must not wait for the end of this process.
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
