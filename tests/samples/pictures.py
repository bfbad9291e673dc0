"""What pictures say."""

from loaded_tca.plots.style import note_of


def told(figure):
    """The title of a picture and what stands below it, in one line."""
    return f"{figure.get_suptitle()}; {note_of(figure)}"
