"""Studies: many analyses as one.

- ``engine_cost``: what the engine of studies costs, and how far it carries: time, workers, memory, files; a page.
"""
