"""Ratings after standards.

- ``strength``: K, Z and Y factors, strengths and safeties that two sources print; a spectrum of ISO 6336-6.
"""
