"""Start a worker process, and a second process that kills the worker when its runner ends.

It imports nothing of the package before: imports take a while, in which a runner can end, and they
start threads, and a process with threads must not fork.
"""

import os
import select
import signal

#: A bound of the open file descriptors of a process that has just started.
_MAX_DESCRIPTORS = 1024


def end_with_runner() -> None:
    """Fork a process that kills this process group once the runner has closed its pipe to stdin.

    A thread could not do this, since it may wait minutes for Python's global lock.
    """
    if os.name != "posix" or os.getpgrp() != os.getpid() or os.fork():
        return
    try:
        # Close stdout, so that readers of the worker's output do not wait for this process.
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
