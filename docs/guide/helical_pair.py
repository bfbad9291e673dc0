"""Draw the pictures of the guide docs/guide/helical_pair.md.

Run from the root of the repository: ``python -m docs.guide.helical_pair``.
"""

import warnings
from pathlib import Path

from loaded_tca import AccuracyWarning, analyse, read_scene
from loaded_tca.plots import plot_pressure_envelope, plot_transmission_error

FOLDER = Path(__file__).parent
SCENE = FOLDER.parents[1] / "examples" / "scenes" / "design_helical.toml"


def main() -> None:
    """Analyse, and draw."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AccuracyWarning)  # the guide says that the contact reaches the face ends
        result = analyse(read_scene(SCENE).with_changes({"analysis.positions": 33}))
    plot_pressure_envelope(result).savefig(FOLDER / "helical_pair_envelope.png", dpi=90)
    plot_transmission_error(result).savefig(FOLDER / "helical_pair_transmission_error.png", dpi=90)


if __name__ == "__main__":
    main()
