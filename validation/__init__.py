"""Comparisons with numbers from outside the project, and studies of speed against error.

| folder | what is checked |
|---|---|
| `unloaded` | contact path and transmission error of cylindrical pairs: published numbers, mounting errors, starts |
| `contact` | the contact solver and its free edges, without gears: closed forms, finite elements, other solvers |
| `cylindrical` | published cylindrical pairs: geometry, stress factors, pressure |
| `bevel` | straight and spiral bevel pairs: blanks, three methods, mounting errors, pressure |
| `face_milled` | face-milled pairs: machine settings, contact, the bidirectional start |
| `loaded` | the loaded mesh cycle: limits and speed |
| `tribology` | closed forms of friction, film, temperatures and scuffing; losses of loaded contacts |
| `rating` | ratings after standards: factors, strengths, safeties, damage of a spectrum |
| `stages` | planetary stages: closed forms, displaced axes, orders that cancel |
| `studies` | studies: what their engine costs, and how far it carries |
| `calculix` | runs of CalculiX, the numbers kept of them, and the loaded mesh cycle beside them |

``python -m validation`` prints the rows of all comparisons in one table; a script that writes a page of
``docs/studies`` is called by its own name, ``python -m validation.bevel.pressure``, and all of them by ``python -m
validation.pages``. What these scripts share (tables, times, the command line) is in ``page``.
"""
