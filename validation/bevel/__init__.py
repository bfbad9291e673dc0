"""Straight and spiral bevel pairs.

- ``iso_23509_sample``: blanks of the standard's sample and of SpyGO;
- ``miter_gear_paper``: one pair by three methods, with its edges; ``miter_gear_document`` writes the page;
- ``mounting_errors``, with ``straight_trends``, ``spiral_trends``, ``effects`` and ``pictures``: what mounting errors
  do, and which statements of the reduced-TCA dissertation hold; writes a page;
- ``pressure``: pressure maps beside Hertz and at edges; writes a page;
- ``convergence``: two equations beside five from random starts; writes a page;
- ``pairs``: the two pairs of the dissertation, which the others share.
"""
