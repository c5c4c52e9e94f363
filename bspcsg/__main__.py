"""The entry point of ``python -m bspcsg``, which runs the command line."""

from .cli.entry import main

if __name__ == "__main__":
    main()
