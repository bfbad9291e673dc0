"""The contact solver by itself, without gears.

- ``sphere``, ``subsurface``: Hertz, and the stresses below;
- ``free_edge``, ``wedge``, ``free_edge_fem``, ``free_block``: contact beside a free edge against Hetenyi and finite
  elements;
- ``rounded_edge``: graded columns at rounded edges against a closed form and uniform grids; writes a page;
- ``rounded_ends``: contacts that cross rounded ends, against Hetenyi;
- ``hard_cases``: contacts on which solvers fail, each with its answer;
- ``stacks``: time of a problem among others of its kind;
- ``growth``: time and memory of grids up to 4096 x 4096; writes a page;
- ``speed_against_error``: time against error beside two other solvers; writes a page.
"""
