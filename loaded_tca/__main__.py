"""``python -m loaded_tca`` is the command ``loaded-tca``."""

import gc
import sys

INTERRUPTED = 130


def main() -> int:
    """Run the command; an interrupt while it is imported ends in one line, too."""
    try:
        from loaded_tca.cli import main as command

        code = command()
    except KeyboardInterrupt:
        sys.stderr.write("loaded-tca: interrupted; no file is half written\n")
        code = INTERRUPTED
    if code == INTERRUPTED:
        exec("")  # CPython ends by the signal, not by the code, if an interrupt went through the last exec of a text
    gc.freeze()  # the interpreter would look all objects through as it ends: a tenth of the time of the demo
    return code


if __name__ == "__main__":
    sys.exit(main())
