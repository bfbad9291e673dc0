"""Tribology of loaded contacts.

- ``published``: friction, film, temperatures and scuffing of published stages; the loss of an even line load.
"""
