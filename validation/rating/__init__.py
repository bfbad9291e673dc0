"""Ratings after standards.

- ``bevel_solved``: a spiral bevel and a hypoid pair from the scene to numbers of ISO/TR 10300-30.
- ``iso_tr_10300_30``: factors, stresses and safeties of the three samples of ISO/TR 10300-30.
- ``methods_part``: where the standard and the analysis part, and why; a page of the studies, no rows.
- ``rings``: critical sections, nominal stresses and factors of planets and rings of two printed stages.
- ``solved``: the whole way from a scene through its solved mesh to safeties that a report prints.
- ``stages``: two whole planetary stages, from stage files to safeties that reports print.
- ``strength``: K, Z and Y factors, strengths and safeties that two sources print; a spectrum of ISO 6336-6.
"""
