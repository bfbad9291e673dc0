"""Ratings after standards.

- ``solved``: the whole way from a scene through its solved mesh to safeties that a report prints.
- ``spectra``: damage under 500 bins of which a dozen torques are solved, against all of them solved.
- ``strength``: K, Z and Y factors, strengths and safeties that two sources print; a spectrum of ISO 6336-6.
"""
