"""``python -m loaded_tca`` is the command ``loaded-tca``."""

import sys

from loaded_tca.cli import main

if __name__ == "__main__":
    sys.exit(main())
