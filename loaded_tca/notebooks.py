"""What notebooks show in the place of a line of text."""


class InNotebooks:
    """Base of what notebooks show as a card: title, key figures, what limits them, warnings and a small picture."""

    def _repr_html_(self) -> str:
        """HTML of :func:`loaded_tca.reports.card_of`, as IPython and sphinx-gallery ask for it."""
        from loaded_tca.reports.notebook import card_of

        return card_of(self).html
