"""Closed forms that tests and users share."""
