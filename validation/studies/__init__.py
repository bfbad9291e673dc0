"""Studies: many analyses as one.

- ``engine_cost``: what the engine of studies costs, and how far it carries: time, workers, memory, files; a page.
- ``robust_design``: a helical pair designed under scatter, by gradients, differences and evolution; a page.
"""
