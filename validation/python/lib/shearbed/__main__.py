"""The program shearbed: ``python -m shearbed`` and the script ``shearbed``."""

from __future__ import annotations

import signal
import sys

from . import _core


def main() -> None:
    # The program answers Ctrl-C itself, in order.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    _core.main([sys.executable, "-m", "shearbed"], sys.argv[1:])


if __name__ == "__main__":
    main()
