"""A notebook from the scene to a workbook
=======================================

What notebooks show of a scene, a result and a comparison, and how their numbers get into pandas and Excel. The link at
the end of this page has it as a notebook.

Writes notebook.png, and notebook.xlsx where the package openpyxl is installed.
"""

from importlib.util import find_spec

from loaded_tca import analyse, parse_scene
from loaded_tca.plots import plot_compared_patterns, save_figure
from loaded_tca.results import compare_results

# %%
# A scene is its file, or a text like it. Its card has what is asked for and the teeth in mesh; more is folded away.

scene = parse_scene("""
title = "Spur pair 25/36"
pair = { type = "cylindrical", normal_module_mm = 3.0 }
material = { youngs_modulus_MPa = 206000.0, poisson_ratio = 0.3 }
load = { pinion_torque_Nm = 150.0 }
analysis = { positions = 9, cells = [20, 24] }
[pinion]
teeth = 25
face_width_mm = 20.0
modifications = { lead_crowning_um = 4.0, tip_relief_um = 25.0, tip_relief_start_mm = 79.0 }
[wheel]
teeth = 36
face_width_mm = 20.0
modifications = { tip_relief_um = 25.0, tip_relief_start_mm = 112.0 }
""")
scene

# %%
# The card of a result: key figures with units and their accuracy, notes, warnings, the contact pattern.

result = analyse(scene)
result

# %%
# Frames of pandas have the heads of the CSV files, which end in the unit.

result.to_pandas("contacts")[["load_share", "peak_pressure_MPa", "line_load_N_per_mm"]].loc[150.0].head(6)

# %%
# A variant beside it: ● marks differences beyond the errors that both results state.

crowned = analyse(scene.with_changes({"pinion.modifications.lead_crowning_um": 12.0}))
comparison = compare_results({"crowned 4 µm": result, "crowned 12 µm": crowned})
comparison

# %%
# All tables as one workbook, and both contact patterns as a picture.

if find_spec("openpyxl"):
    result.to_excel("notebook.xlsx")
save_figure(plot_compared_patterns(comparison), "notebook.png")
