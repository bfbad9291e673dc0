"""Ratings after standards.

- ``bevel_solved``: bevel and hypoid pairs of printed samples, from scenes through their solved mesh to safeties.
- ``iso_tr_10300_30``: factors, stresses and safeties of the samples that ISO/TR 10300-30 prints.
- ``methods_part``: where the standard and the analysis part, and why; a page of the studies, no rows.
- ``rings``: critical sections, nominal stresses and factors of planets and rings of two printed stages.
- ``solved``: the whole way from a scene through its solved mesh to safeties that a report prints.
- ``speed``: processor time of a rating under 500 bins beside that of the analysis of its dozen torques.
- ``spectra``: damage under 500 bins of which a dozen torques are solved, against all of them solved.
- ``stage_spectra``: Miner sums of a planetary stage, by hand of its single meshes, and of all torques solved.
- ``stages``: two whole planetary stages, from stage files to safeties that reports print.
- ``strength``: K, Z and Y factors, strengths and safeties that two sources print; a spectrum of ISO 6336-6.
"""
