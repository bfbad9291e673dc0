"""Methods of the literature, kept to compare with: nothing else of the package imports them."""
