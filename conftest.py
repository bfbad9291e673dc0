"""What every test and example shares: no model of a gear body is kept on disk, or taken from there."""

import os

os.environ["LOADED_TCA_CACHE"] = "off"
