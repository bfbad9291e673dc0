"""Face-milled pairs.

- ``settings``: basic machine settings and the contact of the 19 x 62 pair of SpyGO;
- ``swept_cutter``: flanks cut with tilt, swivel, blank offset, helical motion and modified roll;
- ``duplex_paper``: the bidirectional start of the duplex paper; ``duplex_document`` writes the page;
- ``hypoid_pair``: a hypoid pair beside its five contact equations, which ``hypoid_axes`` has, and ISO/TR 10300-30;
- ``synthesis``: settings by local synthesis beside what was asked for, by the same equations;
- ``measured_settings``: errors of settings found from flanks that a swept cutter leaves;
- ``pairs``: the pairs that both share.
"""
