"""The loaded mesh cycle by itself; ``validation.calculix`` has it beside finite elements.

- ``limits``: balance, energy, no load, conjugate teeth, published stiffnesses;
- ``revolution``: whole revolutions beside one pitch, flanks really turned, eccentric axes, stiffnesses of single teeth;
- ``rolling_bearings``: motions and lives of others, Stribeck, ISO 281, rigid analyses with moved gears; a page;
  ``moved_gears``: these analyses, which tests of supports have, too;
- ``cut_contacts``: scatter of contacts that end at faces and tips;
- ``mesh_stiffness``: beside ISO 6336-1, over helix angle, bore, face width, torque and crowning;
- ``bending_line``: a helical pair whose pressure leaves the axis of its grid, beside repeated analyses;
- ``jumps``, ``error_estimates``: what grids do to the transmission error, and what estimates of peak pressures are
  worth, over random scenes of all families, in minutes;
- ``face_ends``: K_Hbeta of half-spaces at sharp face ends, beside fine cells;
- ``face_ends_space``: line load up to the free ends of the face, aligned and misaligned, beside finite elements in
  space of its own;
- ``local_term``: how far the local term of a tooth reaches along the face;
- ``ring_teeth``: deflection and root stress of teeth of rings beside plane-strain finite elements of their own
  (``plane_teeth``); ``internal_cycle``: the mesh cycle of a pinion in a ring beside the same elements of several teeth
  (``plane_pair``); a page;
- ``root_stress``: tooth root stress beside a plane reference, convergence, time and memory of its model;
- ``root_stress_families``: that of helical, bevel and face-milled gears beside finer meshes, in minutes;
  ``root_stress_models``: what both share;
- ``root_stress_cycle``, ``root_stress_space``: root stress over the mesh and in space beside finite elements of another
  program; ``root_face_load``: under uneven loads, beside ISO 6336-3; ``root_stress_fem``: a page of all three;
- ``root_stress_precision``: models whose fronts are of single precision beside those of double;
- ``numbers_to_copy``: load factors, peak pressure and free edges over misalignment, box, grid and defaults; a page;
- ``moving_edges``: derivatives by mounting errors where contacts end at edges, beside differences of analyses;
- ``random_sensitivities``: derivatives of random spur, helical, bevel and face-milled pairs to every key, beside the
  same, in minutes;
- ``random_scenes``: random scenes with every feature against invariances and laws of mechanics, in minutes;
- ``random_errors``: errors of the default grids on such scenes, by figure and family, in minutes; a page;
- ``sensitivities``: against slopes through whole analyses, closed forms, Monte Carlo studies; their cost; a page;
- ``rounded_edges``: pressure at rounded edges over columns, grids and radii; its time, in minutes; a page;
- ``rounded_ends``: transmission error of misaligned pairs with rounded face ends beside fine cells;
- ``user_scenes``: time told and taken of scenes by defaults alone; a page;
- ``cycles``: time of whole mesh cycles before and after a change, and what it is spent on;
- ``one_contact``: time of one contact, before and after a change, and what of it its gaps take;
- ``speed``: time against error of whole analyses.
"""
