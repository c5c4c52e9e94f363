"""Start a worker, with another core if one is named: ``start_worker.py ROOT CORE TASK``.

With ``--`` and arguments in place of the task it runs the package's command line. The package loads
its core when it is first imported, so this file is not part of the package.
"""

import sys
from importlib.machinery import ExtensionFileLoader
from importlib.util import module_from_spec, spec_from_file_location
from runpy import run_module


def load_core(core: str) -> None:
    """Load a compiled module from this file as the package's core."""
    name = "bspcsg._core"
    spec = spec_from_file_location(name, core, loader=ExtensionFileLoader(name, core))
    if spec is None or spec.loader is None:
        raise ImportError(
            f"{core} is not a compiled Python module; pass the compiled core of bspcsg"
        )
    module = module_from_spec(spec)
    sys.modules[name] = module
    spec.loader.exec_module(module)


if __name__ == "__main__":
    root, core, task, *arguments = sys.argv[1:]
    sys.path.insert(0, root)
    if core:
        load_core(core)
    if task == "--":
        sys.argv = ["bspcsg", *arguments]
        # Like `python -m bspcsg`.
        run_module("bspcsg", run_name="__main__")
    else:
        from bspcsg.bench.worker import main

        main(task)
