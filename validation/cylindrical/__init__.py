"""Published cylindrical pairs.

- ``fzg_c14_geometry``, ``fzg_c14_root_stress``, ``iso_tr_6336_30``: geometry, forces, stress factors and stiffness;
- ``nrel_5mw_stage_3``, ``metric_gear_technology``: tooth thickness, span and ball measurements, backlash;
- ``inches``: pitches, transverse section and a measure over pins of gears given in inches;
- ``sam_paper``: peak pressure of the crowned pairs of the SAM paper;
- ``nrel_planet_ring``: geometry of a planet and a ring, and how two rings are measured, against published reports;
- ``internal_hertz``: pressure of a crowned pinion in a ring against Hertz's point contact;
- ``double_helical``: halves of double helical pairs against one half, closed forms and balance along the axis;
- ``rack``: pressure of a crowned pinion on a rack against Hertz, and wheels of many teeth that tend to it;
- ``undercut``: form circles and contact ratios of few teeth against a rack that is rolled point by point;
- ``line_contact``: pressure in the middle of unmodified pairs against Hertz's line contact.
"""
