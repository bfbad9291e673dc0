"""The loaded mesh cycle by itself; ``validation.calculix`` has it beside finite elements.

- ``limits``: balance, energy, no load, conjugate teeth, published stiffnesses;
- ``cut_contacts``: scatter of contacts that end at faces and tips;
- ``speed``: time against error of whole analyses.
"""
