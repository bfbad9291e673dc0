"""Planetary stages.

- ``planetary``: shares of linear stages, pins against displaced axes, orders that phases cancel, stages in phase.
"""
