"""Unloaded contact of cylindrical pairs against closed forms, published tables and other methods.

- ``involute_pairs``: unmodified, aligned pairs have no transmission error;
- ``internal_pairs``: random pairs of a pinion and a ring, conjugate without modifications, certified with them;
- ``reduced_tca_misalignment``, ``reduced_tca_tables``: the helical pair 40/37 of the reduced-TCA dissertation;
- ``mounting_errors``, with ``mounting_error_pairs``, ``mounting_error_trends``, ``spur_trends``, ``helical_trends`` and
  ``mounting_error_figures``: what each error does, and which statements and numbers of the dissertation hold; writes a
  page;
- ``mounting_error_map``: two errors together, a picture;
- ``rounded_edges``: a thousand random misaligned positions of flanks with rounded edges, certified, and their cost;
- ``convergence_from_random_starts``, with ``random_starts``: two equations beside five; writes a page.
"""

import warnings

from loaded_tca.errors import AccuracyWarning

# The dissertation's crownings are as thick as a tooth.
warnings.filterwarnings("ignore", message=".*lead_crowning: .* is more than 1 mm", category=AccuracyWarning)
