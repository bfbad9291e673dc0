"""Finite element reference: CalculiX decks of a spur pair in full contact, their runs, and the numbers kept.

``python -m validation.calculix`` (``make reference-fem``) repeats the whole set; it needs the program ``ccx``.
Nothing here is imported by the package, and the geometry is written down once more instead of taken from it.

- ``mesh_cycle``, with ``comparison``: the loaded mesh cycle of the package beside the kept runs; writes a page;
- ``pairs_in_space``: a crowned and a flat pair of finite width beside the kept runs in space;
- ``helical_relief``, with ``helical_mesh`` and ``helical_contact``: a helical pair with short tip reliefs in space on
  both sides of a former step, its contact solved without the program; writes a page;
- ``rounded_tip``: a rounded tip on a flank in the plane, its run, and graded columns beside it;
- ``case``, ``tooth_form``, ``mesh_position``, ``steel``: gears, loads, positions and material of the runs;
- ``grading``, ``section``, ``model``, ``deck``: from a position to the mesh and the input deck; ``crowned`` in space;
- ``run``, ``evaluate``, ``campaign``, ``crowned_run``, ``mesh_study``: the runs and what is read from them;
- ``fillet``, ``roots``, ``root_campaign``: root stress over the mesh in plane strain; ``ring``, ``ring_run``: in space
  under line loads; ``plane_ring``, ``ring_solved``: one gear in plane strain under unit
  loads, and in space under loads of any course, solved without the program;
- ``keep``, ``tables``: the tables in ``data/``.
"""
