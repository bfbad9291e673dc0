"""Finite element reference: CalculiX decks of a spur pair in full contact, their runs, and the numbers kept.

``python -m validation.calculix`` (``make reference-fem``) repeats the whole set; it needs the program ``ccx``.
Nothing here is imported by the package, and the geometry is written down once more instead of taken from it.
"""
