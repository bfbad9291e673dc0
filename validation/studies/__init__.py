"""Studies: many analyses as one.

- ``engine_cost``: what the engine of studies costs, and how far it carries: time, workers, memory, files; a page.
- ``large_studies``: time, memory and disk of studies of up to a million variants; prints a table.
- ``robust_design``: a helical pair designed under scatter, by gradients, differences and evolution; a page.
"""
