"""Deliberate faults of the package, each with the test that has to fail with it.

Run from the root of the repository: ``python -m tests.faults [WORD ...]``, all faults or those with a word in their
description; four to five seconds of processor time each. Each is written into a copy of the package, where its test
is run; one that no test notices, or whose text is not there any more, makes the exit code 1. ``tests/test_faults.py``
keeps the texts true.
"""

import argparse
import os
import shutil
import subprocess
import sys
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import NamedTuple

ROOT = Path(__file__).parents[1]
COPIED = ("loaded_tca", "tests", "validation", "examples", "docs/reference", "conftest.py", "pyproject.toml")
PASSED, FAILED = 0, 1
"""Exit codes of pytest: all tests passed, some failed. Others: it could not run them."""


class Fault(NamedTuple):
    """A wrong text in the place of one that stands once in a file of the package, and the test that notices it."""

    what: str
    file: str
    text: str
    wrong: str
    test: str


ROWS = "studies/test_rows.py::test_malformed_row_costs_its_own_variant_and_no_other"
BOXES = "separation/test_box.py"
FREE_EDGES, ROUNDED = "edges/test_free.py", "edges/test_rounded.py"
EDGE_GROWTH = "edges/test_free_growth.py::"
AT_EDGES = "results/test_sensitivities_at_edges.py::"
UNITS = "output/test_units.py::test_every_number_is_an_attribute_times_its_factor"
ARGUMENTS = "test_arguments.py::"
FAULTS = (
    Fault(
        "local synthesis: the path leans to the other end of the face",
        "pairs/mean_point.py",
        "axes = np.array([along, [-along[1], along[0]]])",
        "axes = np.array([along * (-1.0, 1.0), [along[1], along[0]]])",
        "pairs/test_synthesis.py::test_contact_at_the_mean_point_is_as_asked_for",
    ),
    Fault(
        "local synthesis: the other flank of the tooth is left out",
        "pairs/synthesis.py",
        "            rows.append((there.slopes - wanted.slopes) * size)",
        "            rows.append((there.slopes - wanted.slopes) * size * (flank == self.drive))",
        "pairs/test_synthesis.py::test_other_flank_touches_at_its_mean_point_too",
    ),
    Fault(
        "blanks: the pinion's face is counted from the middle of the wheel's",
        "gears/bevel_blank.py",
        "(mean - (1.0 - self.outer_share) * width, mean, mean + self.outer_share * width)",
        "(mean - 0.5 * width, mean, mean + 0.5 * width)",
        "scene/test_bevel_blank.py::test_unequal_faces_meet_at_one_calculation_point",
    ),
    Fault(
        "blanks: measured thicknesses leave no backlash",
        "gears/blank_factors.py",
        "return difference, max(left, 0.0) * cos(pressure_angle)",
        "return difference, 0.0",
        "scene/test_bevel_blank.py::test_means_of_a_blank_give_the_same_blank",
    ),
    Fault(
        "bevel teeth along a circle: its bend is left out of the derivatives",
        "flanks/bevel.py",
        "lambda: slope / along - tangent / along**2",
        "lambda: -tangent / along**2",
        "flanks/test_bevel.py::test_derivatives_along_a_circle_agree_with_differences",
    ),
    Fault(
        "hypoid: the wheel is turned by the offset angle the other way",
        "gears/hypoid.py",
        "zeta = self.pitch_angles, hand * self.offset_angle",
        "zeta = self.pitch_angles, -hand * self.offset_angle",
        "gears/test_hypoid.py::test_pitch_cones_touch_in_the_pitch_plane_at_p",
    ),
    Fault(
        "hypoid: machine centre to back of scenes counts from the pitch apex",
        "scene/hypoid.py",
        "machine_centre_to_back=machine.machine_centre_to_back - beyond",
        "machine_centre_to_back=machine.machine_centre_to_back",
        "scene/test_hypoid_scene.py::test_scene_of_gears_is_their_pair",
    ),
    Fault(
        "hypoid: the offset error moves the wheel along y instead of the common normal",
        "pairs/bevel.py",
        "+ self.offset * frame.common_normal",
        "+ np.array([0.0, self.offset, 0.0])",
        "pairs/test_hypoid_pair.py::test_mounting_errors_move_the_wheel_about_the_common_normal",
    ),
    Fault(
        "hypoid: base radii have the ratio of the pitch radii",
        "pairs/bevel.py",
        "radius * math.cos(pressure) * wheel.teeth / pinion.teeth",
        "cones.radii[1] * math.cos(pressure)",
        "pairs/test_hypoid_pair.py::test_base_radii_have_the_ratio_of_the_teeth_as_levers_have",
    ),
    Fault(
        "hypoid: flanks are turned to the middle of the face instead of the calculation point",
        "flanks/face_milled.py",
        "if blank.calculation_cone_distance is None else blank.mean_cone_distance",
        "if blank.calculation_cone_distance is None else blank.middle_cone_distance",
        "flanks/test_hypoid_synthesis.py::test_pair_touches_in_p_with_the_ratio_of_the_teeth",
    ),
    Fault(
        "local synthesis: the conjugate flank does not bend by its motion",
        "flanks/face_milled.py",
        "(bends - np.outer(bends[1], bends[1]) / bends[1, 1]) / ratio",
        "bends / ratio",
        "flanks/test_hypoid_synthesis.py::test_conjugate_flank_is_what_the_wheel_sweeps",
    ),
    Fault(
        "REXS: axial forces of gears on the same shaft point the other way",
        "exchange/shafts.py",
        "axial = -math.copysign(1.0, torque) * hand",
        "axial = math.copysign(1.0, torque) * hand",
        "exchange/test_public_models.py::test_sew_bearings_of_a_shaft_carry_the_same_whichever_stage_is_asked",
    ),
    Fault(
        "REXS: faces of version 1.0 have their middle where they begin",
        "exchange/gearbox.py",
        'middle = 0.5 * gear.required("face_width", LENGTH) if self.model.version == "1.0" else 0.0',
        "middle = 0.0",
        "exchange/test_public_models.py::test_sew_without_places_in_space_has_the_same_forces",
    ),
    Fault(
        "REXS: helix slopes are turned round",
        "exchange/modifications.py",
        "_um(-teeth.datum * amount)",
        "_um(teeth.datum * amount)",
        "exchange/test_modifications.py::test_helix_slope_removes_material_opposite_to_the_datum_face",
    ),
    Fault(
        "REXS: the flank without load gives its modifications",
        "exchange/gears.py",
        'wanted = "right" if right == side else "left"',
        'wanted = "left" if right == side else "right"',
        "exchange/test_public_models.py::test_modifications_of_the_sun_are_those_of_its_loaded_flank",
    ),
    Fault(
        "rings: modifications have the lower and the upper end of the face exchanged",
        "flanks/cylindrical.py",
        "return Jet(-z, z=-1.0)",
        "return Jet(z, z=1.0)",
        "flanks/test_ring_flank.py::test_ends_of_the_face_are_those_of_the_pinion",
    ),
    Fault(
        "rings: a positive error of the centre distance brings teeth together",
        "pairs/cylindrical.py",
        "[mounting.centre_distance_error - mesh.working_centre_distance, 0.0, mounting.axial_offset]",
        "[-mounting.centre_distance_error - mesh.working_centre_distance, 0.0, mounting.axial_offset]",
        "pairs/test_internal_pair.py::test_positive_centre_distance_error_moves_teeth_apart",
    ),
    Fault(
        "rings: the fillet by a cutter does not turn with the ring",
        "gears/ring.py",
        "turn = (start - place) * cutter.teeth / self.tooth_count",
        "turn = start * cutter.teeth / self.tooth_count + 0.0 * place",
        "gears/test_ring.py::test_cutter_of_two_gears_shapes_the_fillet_by_rolling",
    ),
    Fault(
        "studies of stages: every variant has its mesh cycles computed anew",
        "studies/stage.py",
        "@lru_cache(maxsize=KEPT)\n",
        "@lru_cache(maxsize=0)\n",
        "studies/test_stage_study.py::test_mesh_cycles_are_made_once",
    ),
    Fault(
        "stages: a floating sun goes with planets on one side alone",
        "stages/sections.py",
        "and (gap := _largest_gap(angles)) > 180.0 + WRITTEN_deg",
        "and (gap := _largest_gap(angles)) > 360.0 + WRITTEN_deg",
        "stages/test_bad_stages.py::test_bad_stage_is_refused",
    ),
    Fault(
        "stages: mesh cycles of another stage are taken for those of a result",
        "stages/result.py",
        "if replace(cycle.scene, analysis=scene.analysis) != scene:",
        "if False:",
        "stages/test_bad_stages.py::test_files_that_are_no_stage_are_refused",
    ),
    Fault(
        "stages: planets press sun and ring with the same flank where the carrier drives",
        "stages/kinematics.py",
        "sign = 1.0 if sun_drives else -1.0",
        "sign = 1.0",
        "stages/test_kinematics.py::test_phases_are_those_of_teeth_that_are_counted",
    ),
    Fault(
        "stages: planets whose flanks do not reach each other pull",
        "stages/balance.py",
        "        if approach <= self.first:\n            return 0.0, 0.0, 0.0\n",
        "",
        "stages/test_balance.py::test_planet_whose_pin_is_far_off_carries_nothing",
    ),
    Fault(
        "tribology: both ends of the pitch count as whole positions",
        "tribology/evaluate.py",
        "weights[[0, -1]] *= 0.5",
        "weights[[0, -1]] *= 1.0",
        "tribology/test_even_line_load.py::test_loss_of_an_even_line_load_is_that_of_lines_on_the_plane_of_action",
    ),
    Fault(
        "tribology: friction on the wheel turns with that on the pinion",
        "tribology/slices.py",
        '"torque_2": arms[1],',
        '"torque_2": -arms[1],',
        "tribology/test_tribology.py::test_torques_of_friction_do_the_friction_power",
    ),
    Fault(
        "tribology: slices beside the ends of a grid have twice their line load",
        "tribology/slices.py",
        "force[carrying] / dy,",
        "force[carrying] / dy * (1.0 + one.beside_end.any(axis=0)[carrying]),",
        "tribology/test_slices.py::test_pressure_of_slices_is_that_of_cells_where_contacts_keep_off_edges",
    ),
    Fault(
        "revolution: teeth of the pinion that are set back stand at the nominal angle",
        "unloaded/revolution.py",
        "- pair.pitch * pairs - pair.driving * of_pinion / pair.base_radii[0]",
        "- pair.pitch * pairs - 0.0 * of_pinion",
        "unloaded/test_revolution.py::test_rigid_transmission_error_is_that_of_flanks_really_turned",
    ),
    Fault(
        "revolution: gaps of teeth with flanks of their own are those of the common flanks",
        "loaded/together.py",
        "gears = requests[0].gears or pair",
        "gears = pair",
        "test_revolution.py::test_all_teeth_with_flanks_of_their_own_are_a_gear_with_these_flanks",
    ),
    Fault(
        "sensitivities: contact points on the start of a linear relief have the flank on both sides of it",
        "separation/contact_points.py",
        "        if contacts[0].on_relief_start:  # then it is the only one",
        "        if False:",
        f"{AT_EDGES}test_contact_points_on_the_start_of_a_linear_relief_move_as_by_whole_analyses",
    ),
    Fault(
        "free edges: the angle of the material is taken for that of the air",
        "edges/free.py",
        "np.arccos(np.clip(cosine, -1.0, 1.0))",
        "np.arccos(np.clip(-cosine, -1.0, 1.0))",
        f"{FREE_EDGES}::test_tip_counts_by_the_angle_of_its_material",
    ),
    Fault(
        "bending: results of a file know one part of the model alone",
        "results/derivatives.py",
        "bending = model_of(result.scene, pair, result.coupled_pitches)",
        "bending = model_of(result.scene, pair, result.coupled_pitches).parts[0]",
        "compliance/test_model.py::test_model_twice_as_soft_has_one_answer_in_memory_and_from_a_file",
    ),
    Fault(
        "load sharing: contact laws count from the zero of the gaps",
        "loaded/load_sharing.py",
        "deformation = loaded.contact_deformation - self.first_gaps[index]",
        "deformation = loaded.contact_deformation",
        "loaded/test_load_sharing.py::test_zero_from_which_gaps_count_moves_no_force",
    ),
    Fault(
        "K_Hbeta: what cells lack at a sharp end does not depend on their length",
        "results/load_factors.py",
        "float(force[largest]) * one.spacing[1] / length",
        "float(force[largest]) * 0.05",
        "results/test_load_factors.py::test_face_load_factor_at_sharp_ends_misses_what_is_estimated_on_any_cells",
    ),
    Fault(
        "jamming: nominal teeth without backlash jam at any error of the centre distance",
        "scene/cylindrical.py",
        "nominal = abs(mesh.backlash) <= ROUNDING * module",
        "nominal = False",
        "results/test_gear_warnings.py::test_an_error_of_the_centre_distance_jams_gears_whose_backlash_is_given",
    ),
    Fault(
        "jamming: errors of the centre distance jam nothing",
        "scene/cylindrical.py",
        "nominal = abs(mesh.backlash) <= ROUNDING * module",
        "nominal = True",
        "results/test_gear_warnings.py::test_an_error_of_the_centre_distance_jams_gears_whose_backlash_is_given",
    ),
    Fault(
        "bending: forces act on the axis of the grid",
        "separation/sample.py",
        "return replace(self, force_line=np.interp(self.y, places, line))",
        "return self",
        "loaded/test_tooth_contact.py::test_forces_of_slices_bend_the_tooth_at_the_centres_of_their_pressure",
    ),
    Fault(
        "bending: the line of forces scatters from slice to slice",
        "separation/sample.py",
        "line = smoothed(places, middles, force, LINE_SMOOTHED * module)",
        "line = middles",
        "loaded/test_tooth_contact.py::test_pressure_on_fine_slices_does_not_scatter_as_its_own_forces_bend_the_teeth",
    ),
    Fault(
        "bending: a peak that its lines of forces move keeps the error of the grid",
        "loaded/loaded_contact.py",
        "np.maximum(self.solution.error_estimate.peak_pressure, self.peak_change)",
        "self.solution.error_estimate.peak_pressure",
        "loaded/test_tooth_contact.py::test_peak_that_moves_by_more_than_its_load_has_no_smaller_error",
    ),
    Fault(
        "bending: the distance of places counts along the axis of the grid alone",
        "compliance/compliance.py",
        "np.hypot(grid.y[:, None] - there.y, grid.force_line[:, None] - there.force_line)",
        "np.abs(grid.y[:, None] - there.y)",
        "compliance/test_compliance.py::test_bending_does_not_depend_on_the_axes_of_the_grid",
    ),
    *(
        Fault(f"grids: {what}", file, text, wrong, test)
        for what, file, text, wrong, test in (
            (
                "they lie along the curvatures of the contact point",
                "separation/box.py",
                "MOST_TURNS = 4",
                "MOST_TURNS = 0",
                f"{BOXES}::test_grid_lies_along_a_contact_that_is_askew_on_the_curvatures",
            ),
            (
                "the contact point lies anywhere between the cells of a cut box",
                "separation/box.py",
                "(0.5 * number - below) * spacing",
                "(0.5 * number - below + 0.3) * spacing",
                f"{BOXES}::test_contact_point_lies_on_a_border_of_cells",
            ),
            (
                "an edge that ends the contact on one of two grids ends it",
                "contact/adaptive.py",
                "of_approach = ended and ended_before",
                "of_approach = ended",
                "contact/test_adaptive.py::test_edge_ends_a_contact_where_two_grids_agree_that_it_does",
            ),
            (
                "estimates of a peak leave out the change beside it",
                "contact/solution.py",
                "MOST_OF_CHANGE_BESIDE * beside,",
                "",
                "contact/test_solution.py::test_estimate_sees_a_change_beside_a_peak_that_stays",
            ),
            (
                "a ridge has its peak above its largest cell",
                "contact/patch.py",
                "LIKE_BENDS * bends.min() > bends.max()",
                "bends.max() > 0.0",
                "contact/test_patch.py::test_peak_of_other_shapes_is_their_largest_cell",
            ),
            (
                "estimates of slices see the largest line load alone",
                "loaded/line_load.py",
                "return max(above - 1.0, 1.0 - below, change, ",
                "return max(change, ",
                "loaded/test_tooth_contact.py::test_estimate_of_slices_sees_a_change_beside_the_largest_line_load",
            ),
            (
                "estimates of slices beside a sharp end come from two grids alone",
                "loaded/line_load.py",
                "self.step / self.length if at_end else 0.0",
                "0.0",
                "loaded/test_tooth_contact.py::test_estimate_of_slices_beside_a_sharp_end_grows_with_their_length",
            ),
            (
                "estimates of a peak forget the change before two grids that agree",
                "contact/adaptive.py",
                "coarse.coarser.change_beside_peak",
                "0.0",
                "contact/test_adaptive.py::"
                "test_refined_grid_knows_how_much_the_pressure_changed_between_the_grids_before",
            ),
            (
                "slice pressures are those of the borders of slices alone",
                "results/slice_pressure.py",
                "range(ROUNDS)",
                "range(0)",
                "results/test_slice_pressure.py::test_slice_pressure_at_a_jump_of_the_curvature_is_found_between_the_slices",
            ),
            (
                "a peak beside the end of the material counts as smooth",
                "loaded/loaded_contact.py",
                " or self._peaks_beside_end",
                "",
                "loaded/test_tooth_contact.py::test_peak_beside_the_end_of_the_material_is_that_of_slices",
            ),
            (
                "relief starts at face ends have the pinion's normal",
                "unloaded/path.py",
                "np.asarray(ends + 2 * ",
                "np.asarray(ends + 0 * ",
                "unloaded/test_path.py::"
                "test_levers_are_continuous_where_a_contact_leaves_a_relief_start_at_a_common_face_end",
            ),
        )
    ),
    *(
        Fault(f"rounded edges: {what}", file, text, wrong, test)
        for what, file, text, wrong, test in (
            (
                "a sharp edge that ends one sets no limit aside",
                "edges/rounded.py",
                "return math.inf if self.ends_sharp or self.at_relief_start else self.bound",
                "return self.bound",
                "results/test_rounded_edges.py::test_largest_edge_pressure_and_its_warnings_do_not_depend_on_whether_all_are_asked_for",
            ),
            (
                "a relief start that crosses one sets no limit aside",
                "edges/rounded.py",
                "self.ends_sharp or self.at_relief_start else",
                "self.ends_sharp else",
                f"{ROUNDED}::test_edge_that_a_relief_start_crosses_has_no_bound",
            ),
            (
                "they are looked for in the tangent plane, not on the flanks",
                "edges/rounded.py",
                "place = place - length / (slope @ slope) * slope",
                "place = place - (length - 0.05) / (slope @ slope) * slope",
                f"{ROUNDED}::test_edges_of_bent_flanks_are_where_the_gap_begins_to_open",
            ),
            (
                "the start of a relief that crosses one is not seen",
                "contact/rounded_edge.py",
                "if growth <= MOST_GROWTH else math.inf",
                "if growth < math.inf else math.inf",
                "contact/test_rounded_edge.py::test_edge_crossed_by_a_jump_of_the_slope_has_no_limit",
            ),
            (
                "where an arc begins the slope of the gap is said to jump",
                "contact/slope_jumps.py",
                "np.maximum(bends[:-3], bends[3:])",
                "np.minimum(bends[:-3], bends[3:])",
                "contact/test_samples.py::test_curvature_that_jumps_is_no_jump_of_the_slope",
            ),
            (
                "one that crosses another is solved alone where the other has less",
                "edges/rounded.py",
                "crossing = _crossing_within(loaded, [line for edge in edges for line in edge.lines])",
                "crossing = _crossing_within(loaded, [line for e in edges if e.bound >= at_least for line in e.lines])",
                f"{ROUNDED}::test_edges_that_cross_are_solved_together_whatever_one_of_them_can_come_to",
            ),
            (
                "the cell at a sharp edge counts where the rounding was left out",
                "results/collect.py",
                "cell > (1.0 + EQUAL) * peak.bound",
                "cell > (1.0 + EQUAL) * np.nan_to_num(pressure)",
                "results/test_rounded_edges.py::test_largest_edge_pressure_and_its_warnings_do_not_depend_on_whether_all_are_asked_for",
            ),
            (
                "a corner with a sharp edge counts as rounded",
                "results/collect.py",
                '"edge_is_rounded": at_arc and not peak.ends_sharp',
                '"edge_is_rounded": at_arc',
                "results/test_rounded_edges.py::test_corner_of_a_rounded_and_a_sharp_edge_is_sharp",
            ),
        )
    ),
    Fault(
        "rows of a study: figures are not looked at",
        "studies/rows.py",
        "or {*map(type, values)} != {float}",
        "",
        ROWS,
    ),
    Fault(
        "rows of a study: the checksum is not looked at",
        "studies/rows.py",
        "if separator and end != _checksum(content) + END:",
        "if False:",
        "studies/test_rows.py::test_changed_row_is_found_by_its_checksum",
    ),
    Fault(
        "files: a pipe is read",
        "input_files.py",
        "other = os.path.exists(path) and not (os.path.isfile(path) or os.path.isdir(path))",
        "other = False",
        "test_input_files.py::test_what_is_no_regular_file_is_refused_unopened",
    ),
    Fault(
        "free edges: the same at helical ends",
        "edges/free.py",
        "np.arccos(np.clip(cosine, -1.0, 1.0))",
        "np.arccos(np.clip(-cosine, -1.0, 1.0))",
        f"{FREE_EDGES}::test_helical_end_counts_by_the_angle_of_its_material",
    ),
    *(
        Fault(
            f"free edges: the image varies by {variation} over its places",
            "edges/free.py",
            "PLACE_BELOW = 0.4, 0.9, 0.5",
            f"PLACE_BELOW = {variation}, 0.9, 0.5",
            f"{FREE_EDGES}::test_image_counts_less_away_from_its_own_place_as_in_hetenyis_quarter_space",
        )
        for variation in (0.3, 0.5, 0.8)
    ),
    Fault(
        "free edges: the middle of the tooth is not taken off",
        "edges/free.py",
        "(varied * surface * inverse - below * middle)",
        "(varied * surface * inverse)",
        f"{FREE_EDGES}::test_entries_beside_an_end_are_those_of_hetenyis_quarter_space",
    ),
    Fault(
        "free edges: slices beside a tip give way half as much",
        "edges/free.py",
        "compliances[place] += mean * near.factor",
        "compliances[place] += 0.5 * mean * near.factor",
        f"{FREE_EDGES}::test_tip_that_is_free_takes_up_the_energy_of_its_slices",
    ),
    *(
        Fault(
            f"cut cells: the pressure on their material is the mean over the whole cell ({test})",
            "contact/solution.py",
            "self.pressure if cover is None else self.pressure / np.where(cover > 0.0, cover, 1.0)",
            "self.pressure",
            f"contact/test_cuts.py::{test}",
        )
        for test in (
            "test_contact_conditions_hold_on_cut_cells",
            "test_pressure_on_the_material_of_a_cut_cell_is_near_that_of_a_whole_one",
        )
    ),
    Fault(
        "rounded edges: what other pairs displace has the other sign",
        "edges/rounded.py",
        "np.asarray(heights + (displaced",
        "np.asarray(heights - (displaced",
        f"{ROUNDED}::test_peak_beside_another_pair_with_bending_is_that_of_a_fine_grid",
    ),
    Fault(
        "rounded edges: unlike materials share the compliance evenly",
        "edges/rounded.py",
        "pair.contact_modulus / gear.material.plane_strain_modulus,",
        "0.5,",
        f"{ROUNDED}::test_share_of_a_gear_in_the_compliance_is_that_of_its_material",
    ),
    *(
        Fault(
            f"studies: all keys take the points of the first ({test})",
            "studies/study.py",
            "np.clip(unit, NEVER",
            "np.clip(unit[:, [0] * unit.shape[1]], NEVER",
            f"studies/test_study.py::{test}",
        )
        for test in ("test_points_fill_every_part_of_the_joint_distribution", "test_keys_vary_independently")
    ),
    Fault(
        "sensitivities: a contact that moves is not bent otherwise by other pairs",
        "loaded/force_lines.py",
        "by_shift[at, at] += by_place @ forces[j][loaded[j]]",
        "by_shift[at, at] += (i == j) * (by_place @ forces[j][loaded[j]])",
        "loaded/test_force_lines.py::"
        "test_slices_bend_by_shifts_of_the_forces_under_their_own_load_and_that_of_other_pairs",
    ),
    *(
        Fault(f"growth of free edges: {what}", "edges/free.py", text, wrong, f"{EDGE_GROWTH}{test}")
        for what, text, wrong, test in (
            (
                "slices keep their slope to the edge",
                "weights @ steeper]",
                "0.0 * (weights @ steeper)]",
                "test_deflection_grows_as_differences_of_the_whole_say_where_the_wheel_or_the_slices_move",
            ),
            (
                "slices on an edge count as inside",
                "return 0.5 + 0.5 * np.sign(",
                "return 0.0 + np.sign(1e-300 + ",
                "test_slices_on_an_edge_grow_by_the_mean_of_both_sides",
            ),
        )
    ),
    *(
        Fault(f"sensitivities at edges: {what}", file, text, wrong, f"{AT_EDGES}{test}")
        for what, file, text, wrong, test in (
            (
                "the parts of cut cells are held",
                "results/gap_growth.py",
                "gaps[:, first:last] += _released(grids[i], own)",
                "pass",
                "test_contacts_on_a_relief_start_that_an_edge_cuts_follow_the_start_and_leave_the_edge",
            ),
            (
                "the wheel is not turned back into contact below its edges",
                "separation/gap_change.py",
                "growth[1] -= self.at_points.gaps[:, contact] * levers",
                "growth[1] -= 0.0 * levers",
                "test_helical_flanks_and_centre_distance_as_by_whole_analyses",
            ),
            (
                "grids stay where they are",
                "separation/gap_change.py",
                "following(lines, self.contact[lines.cell], parts[lines.cell], plane[edges], open_to, scales)",
                "0.0",
                "test_helical_flanks_and_centre_distance_as_by_whole_analyses",
            ),
            (
                "teeth bend below the wheel that has not moved",
                "results/gap_growth.py",
                "bending.mounted(gears) if isinstance",
                "bending if isinstance",
                "test_spur_teeth_that_bend_and_centre_distance_as_by_whole_analyses",
            ),
            (
                "the ends of the common face are held",
                "results/face_slopes.py",
                "motions[key] = np.where(at_one_place, by_gear.mean(axis=0), by_gear[ruling])",
                "motions[key] = 0.0",
                "test_ends_of_the_common_face_move_with_the_wheel",
            ),
            (
                "derivatives at cut slices are not warned of",
                "results/sensitivities.py",
                "return marks & any(change is not None",
                "return marks & any(change is None",
                "test_derivatives_at_cut_slices_are_warned_of_with_keys_that_change_the_gears_alone",
            ),
            (
                "grids go half with the contact point between two face ends",
                "separation/pair_change.py",
                "OPEN = 1e-5",
                "OPEN = 1e-2",
                "test_contacts_between_two_face_ends_stay_where_they_are_though_their_point_moves_far",
            ),
            (
                "edges stay in grids that go with a relief start",
                "separation/gap_change.py",
                "of_edges = np.flatnonzero(self.moves_edges | moved)",
                "of_edges = np.flatnonzero(self.moves_edges)",
                "test_contacts_on_a_relief_start_that_an_edge_cuts_follow_the_start_and_leave_the_edge",
            ),
            (
                "peaks stay where the start of a relief was",
                "results/gap_growth.py",
                "if starts.size:",
                "if starts.size < 0:",
                "test_peaks_follow_relief_starts_and_the_length_of_contacts",
            ),
            (
                "the mean over a short contact keeps its length",
                "results/slice_pressure.py",
                "+ by_length * slices.length_slopes",
                "+ 0.0 * slices.length_slopes",
                "test_peaks_follow_relief_starts_and_the_length_of_contacts",
            ),
            (
                "ends at one place are no kink",
                "separation/pair_change.py",
                "kinks = (most - least)[:, kept]",
                "kinks = (most - most)[:, kept]",
                "test_aligned_faces_of_one_width_are_a_kink_without_a_slope",
            ),
            (
                "a strip that carries as much is no kink",
                "results/sensitivities.py",
                "if any(rivals):",
                "if not any(rivals):",
                "test_a_strip_that_carries_as_much_is_a_kink_of_the_face_load_factor",
            ),
        )
    ),
    Fault(
        "sensitivities: both ends of a pitch count fully",
        "results/figure.py",
        "[mean_over_a_pitch(slope) for slope",
        "[slope.mean() for slope",
        "results/test_tolerances.py::test_both_ends_of_a_pitch_count_half_in_the_mean_slope",
    ),
    Fault(
        "root stress: h/b of the lower teeth",
        "scene/cylindrical.py",
        "return max(gear.tip_radius",
        "return min(gear.tip_radius",
        "results/test_root_figures.py::test_height_of_the_higher_teeth_counts",
    ),
    Fault(
        "key figures: body torsion is added instead of taken off",
        "results/numbers.py",
        "1.0 / stiffness - 1e3 * self.face_width",
        "1.0 / stiffness + 1e3 * self.face_width",
        UNITS,
    ),
    Fault(
        "key figures: half the amplitudes of the orders",
        "results/figures.py",
        "under.length * float(under.harmonics",
        "0.5 * under.length * float(under.harmonics",
        "results/test_key_figures.py::test_orders_of_the_transmission_error_are_its_amplitudes_at_the_base_circle",
    ),
    *(
        Fault(
            f"contact ratio counts both ends of the pitch ({file})",
            file,
            text,
            wrong,
            "results/test_dynamics.py::test_contact_ratio_counts_the_end_of_the_pitch_once",
        )
        for file, text, wrong in (
            (
                "results/dynamics.py",
                '"loaded_contact_ratio": curves["loaded_pairs"][:, :-1].mean(axis=-1)',
                '"loaded_contact_ratio": curves["loaded_pairs"].mean(axis=-1)',
            ),
            (
                "results/figures.py",
                "mean_over_a_pitch(under.pairs)",
                "float(np.mean(under.pairs))",
            ),
        )
    ),
    Fault(
        "load factors of bevel gears: strips along the axis instead of the cone",
        "results/load_factors.py",
        "pair.pinion.flank.lengthwise_coordinate(radius, points[..., 2]).value",
        "0.9 * pair.pinion.flank.lengthwise_coordinate(radius, points[..., 2]).value",
        "results/test_load_factors.py::test_face_load_factor_of_bevel_gears_is_that_of_forces_by_their_cone_distance",
    ),
    *(
        Fault(f"units: {text}", file, text, wrong, UNITS)
        for file, text, wrong in (
            *(
                ("results/quantities.py", f'column="{column}"', f'column="{column}", times=1e3')
                for column in ("tooth_deflection_um", "contact_deformation_um")
            ),
            ("results/declared.py", 'ending = "deg" if', 'ending = "rad" if'),
            *(
                ("results/quantities.py", f'column="{column}", times=2.0', f'column="{column}"')
                for column in ("hertz_width_mm", "edge_pinion_diameter_mm")
            ),
            ("results/declared.py", "return MICROMETRES * float(", "return float("),
            ("units.py", '"um": Unit("um", "mm", 1e-3)', '"um": Unit("um", "mm", 1e-6)'),
            ("units.py", '"Nm": Unit("N m", "N mm", 1e3)', '"Nm": Unit("N m", "N mm", 1.0)'),
            ("units.py", "math.radians(1.0 / 3600.0)", "math.radians(1.0 / 60.0)"),
            (
                "results/figures.py",
                '2.0 * under.edge.number("edge_radius")',
                'under.edge.number("edge_radius")',
            ),
            (
                "results/figures.py",
                '2.0 * under.peak.unloaded("pinion_radius")',
                'under.peak.unloaded("pinion_radius")',
            ),
            (
                "results/figures.py",
                "span_of(under.transmission_error, under.result.places_of_mesh) * under.length",
                "span_of(under.transmission_error, under.result.places_of_mesh)",
            ),
            (
                "results/root_stress.py",
                'math.degrees(there("_angle"))',
                'there("_angle")',
            ),
            ("results/dynamics.py", "stiffness = 1e6 * result.face_width", "stiffness = 1e3 * result.face_width"),
            (
                "results/figures.py",
                "length(slopes) * slopes.peak_to_peak",
                "slopes.peak_to_peak",
            ),
        )
    ),
    Fault(
        "rolling bearings: balls without the stiffness of their turning direction",
        "supports/rolling.py",
        "tangent += (radial.T * turning) @ radial + (axial.T * turning) @ axial",
        "tangent += 0.0 * (radial.T @ radial)",
        "supports/test_rolling.py::test_force_and_tangent_are_derivatives_of_the_energy",
    ),
    Fault(
        "rolling bearings: preload of tapered rollers against their side",
        "supports/rolling.py",
        "given = self.preload * sine",
        "given = -self.preload * sine",
        "supports/test_rolling.py::test_preload_is_a_motion_in_the_sense_of_the_side",
    ),
    Fault(
        "rolling bearings: clearance of balls counted on both sides",
        "supports/rolling.py",
        "math.cos(self.contact_angle) - 0.5 * self.clearance + radial @ motion",
        "math.cos(self.contact_angle) - self.clearance + radial @ motion",
        "supports/test_rolling.py::test_balls_give_way_and_last_as_a_commercial_program_has_them",
    ),
    Fault(
        "rolling bearings: motions of the shaft extrapolated from no load",
        "supports/shaft.py",
        "motions[:, -1] = moved - motions[:, :-1] @ given",
        "motions[:, -1] = moved",
        "supports/test_shaft_on_rolling_bearings.py::test_forces_on_bearings_balance_the_load",
    ),
    Fault(
        "rolling bearings: lives of rollers by balls' exponent",
        "supports/bearing_life.py",
        "return float(used.sum() ** (-8.0 / 9.0))",
        "return float(used.sum() ** -0.9)",
        "supports/test_rolling.py::test_lives_fall_with_powers_of_the_load",
    ),
    Fault(
        "rolling bearings: balls tilt with the lever of the pitch circle",
        "supports/rolling.py",
        "middle += (self.inner_groove - 0.5) * self.diameter * math.cos(self.contact_angle)",
        "middle += 0.0 * math.cos(self.contact_angle)",
        "supports/test_rolling.py::test_tilted_balls_have_the_centre_of_the_inner_groove_for_their_lever",
    ),
    Fault(
        "rolling bearings: pressure at the inner ring in the groove of the outer one",
        "supports/rolling.py",
        "(2.0 - 1.0 / self.inner_groove) / self.diameter,",
        "(2.0 - 1.0 / self.outer_groove) / self.diameter,",
        "supports/test_rolling.py::test_pressure_is_hertz_at_the_inner_ring",
    ),
    Fault(
        "rolling bearings: profile of long rollers over their whole length",
        "supports/rolling.py",
        "from_ends = np.maximum(place - (self.length - ends), 0.0) / ends",
        "from_ends = np.maximum(place - (self.length - ends), 0.0) / self.length",
        "supports/test_rolling.py::test_profile_of_long_rollers_takes_off_their_ends_alike",
    ),
    Fault(
        "rolling bearings: ratings of large balls grow like those of small ones",
        "supports/bearing_life.py",
        "of_size = diameter**1.8 if diameter <= LARGE_BALL else 3.647 * diameter**1.4",
        "of_size = diameter**1.8",
        "supports/test_rolling.py::test_large_balls_and_wide_grooves_have_lower_ratings",
    ),
    Fault(
        "shafts: moments of other loads are taken for N mm",
        "supports/of_scene.py",
        "return np.array([*force, *(1e3 * one for one in moment)])",
        "return np.array([*force, *moment])",
        "supports/test_shafts_of_scenes.py::test_units_of_bearings_are_those_of_their_names",
    ),
    Fault(
        "exchange: load of a wheel beside the middle of the common face",
        "exchange/shafts.py",
        "beside = 0.5 * (low + high) - (0.0 if gear == 0 else stage.axial_offset)",
        "beside = 0.5 * (low + high)",
        "exchange/test_public_models.py::test_sew_stage_before_loads_its_wheel_in_the_middle_of_the_common_face",
    ),
    Fault(
        "exchange: every row has the rating of the whole bearing",
        "exchange/bearings.py",
        'if rating and len(reading.model.related("ordered_assembly", "assembly", bearing.id, "part")) == 1:',
        "if rating:",
        "exchange/test_rolling.py::test_two_rows_are_two_bearings_beside_each_other",
    ),
    Fault(
        "exchange: stiffness of an operating point turned the other way",
        "exchange/bearings.py",
        "turned = turn_both @ (0.5 * (matrix + matrix.T)) @ turn_both.T",
        "turned = turn_both.T @ (0.5 * (matrix + matrix.T)) @ turn_both",
        "exchange/test_shafts.py::test_operating_points_are_turned_the_way_of_the_axes",
    ),
    Fault(
        "internal gears: radial assembly asks for both places of the pinion",
        "gears/internal_mesh.py",
        "return max(self.radial_assembly_clearances)",
        "return min(self.radial_assembly_clearances[:2])",
        "gears/test_internal_mesh.py::test_radial_assembly_of_a_pinion_that_fits_in_one_of_two_places",
    ),
    Fault(
        "internal gears: single tooth contact begins beyond the path",
        "gears/internal_mesh.py",
        "B=end - self.pinion.base_pitch",
        "B=end + self.pinion.base_pitch",
        "gears/test_internal_mesh.py::test_points_of_the_path_lie_on_both_gears",
    ),
    Fault(
        "tribology: mean friction with the radius of the transverse section",
        "tribology/evaluate.py",
        "radius = path.C * (path.T2 - path.C) / path.T2 / math.cos(mesh.pinion.base_helix_angle)",
        "radius = path.C * (path.T2 - path.C) / path.T2",
        "tribology/test_tribology.py::test_mean_friction_is_that_of_the_standard",
    ),
    Fault(
        "tribology: arithmetic mean roughness where the root mean square is asked for",
        "tribology/evaluate.py",
        "rough = RMS_OF_MEAN * math.hypot(*self.conditions.roughness)",
        "rough = math.hypot(*self.conditions.roughness)",
        "tribology/test_tribology.py::test_roughness_of_xu_and_kahraman_is_the_root_mean_square_of_both_flanks",
    ),
    Fault(
        "tribology: each gear takes heat at the velocity of the other",
        "tribology/evaluate.py",
        "            self.rolling[0],\n            self.rolling[1],\n",
        "            self.rolling[1],\n            self.rolling[0],\n",
        "tribology/test_tribology.py::test_flash_temperature_is_bloks_with_each_gears_own_coefficient",
    ),
    Fault(
        "tribology: reduced modulus 2 % too small",
        "tribology/evaluate.py",
        "return 2.0 * self.result.gear_pair.contact_modulus",
        "return 1.96 * self.result.gear_pair.contact_modulus",
        "tribology/test_tribology.py::test_flash_temperature_is_bloks_with_each_gears_own_coefficient",
    ),
    Fault(
        "tribology: sliding along the contact is left out",
        "tribology/slices.py",
        '"sliding": np.hypot(across, between.along(number, x)),',
        '"sliding": np.abs(across),',
        "tribology/test_slices.py::test_teeth_on_axes_that_cross_at_a_distance_slide_along_their_contacts_too",
    ),
    Fault(
        "tribology: wear of the wheel by the sliding of the pinion",
        "tribology/tribology.py",
        '"wheel_wear": lambda: parts.line_load * np.abs(parts.specific_sliding[1])',
        '"wheel_wear": lambda: parts.line_load * np.abs(parts.specific_sliding[0])',
        "tribology/test_tribology.py::test_wear_of_both_gears_is_as_their_ways",
    ),
    Fault(
        "revolutions: eccentricity begins at the first teeth whichever come first",
        "unloaded/revolution.py",
        "2.0 * np.pi * first / count",
        "0.0 * np.pi * first / count",
        "unloaded/test_revolution.py::test_revolution_that_begins_with_later_teeth_finds_the_gears_turned_as_far",
    ),
    Fault(
        "revolutions: teeth with the largest root stress are counted backwards",
        "revolution.py",
        'counted = tooth + steps * stresses["root_tension_place"][..., 0]',
        'counted = tooth - steps * stresses["root_tension_place"][..., 0]',
        "test_revolution.py::test_root_stress_is_that_of_one_pitch_and_names_its_teeth",
    ),
    Fault(
        "revolutions: warnings name the column of a tooth pair",
        "revolution.py",
        "place = place_of(float(self.torques[t]), angle, int(self.path.pairs[k]))",
        "place = place_of(float(self.torques[t]), angle, k)",
        "test_revolution.py::test_warnings_of_contacts_name_their_tooth_pairs",
    ),
    Fault(
        "rounded edges: peaks of two grids that agree by chance have no error",
        "edges/rounded.py",
        "error = max(peak.error, left / peak.cells_on_arc)",
        "error = peak.error",
        "edges/test_rounded.py::test_peak_whose_grids_agree_by_chance_has_the_error_of_its_cells",
    ),
    Fault(
        "rounded edges: teeth bend as if forces acted on the slices' axis",
        "edges/rounded.py",
        "forces = np.interp(along, grid.y, grid.force_line)",
        "forces = 0.0 * np.interp(along, grid.y, grid.force_line)",
        "edges/test_rounded.py::test_teeth_bend_under_the_forces_where_they_act",
    ),
    Fault(
        "rounded edges: tilt of a wedge counted from beyond its rounding",
        "contact/rounded_edge.py",
        "return min(max(load_centre, self.first), self.last)",
        "return load_centre",
        "contact/test_rounded_edge.py::test_load_beyond_the_rounding_of_a_wedge_is_one_where_that_begins",
    ),
    Fault(
        "sensitivities: peaks at edges grow by less than the root of the curvature",
        "results/sensitivities.py",
        "by_pair[:, at] += grown * [0.5 * peak.pressure if",
        "by_pair[:, at] += grown * [0.45 * peak.pressure if",
        "results/test_sensitivities.py::test_pressure_at_edges_grows_with_the_root_of_the_relative_curvature",
    ),
    Fault(
        "sensitivities: pairs that only just carry are not marked",
        "results/sensitivities.py",
        "(self.result.load_share < LITTLE)",
        "(self.result.load_share < 0.0)",
        "results/test_sensitivities.py::test_pressures_of_pairs_that_only_just_carry_at_an_edge_are_marked",
    ),
    Fault(
        "accuracy: one that the finest grid misses by little is not told",
        "contact/adaptive.py",
        "        if not size <= accuracy\n",
        "        if not size <= 10.0 * accuracy\n",
        "contact/test_adaptive.py::test_accuracy_that_the_finest_grid_misses_by_little_is_told",
    ),
    Fault(
        "accuracy: change of the approach over the way to first contact",
        "contact/adaptive.py",
        "abs(solution.approach - coarse.approach) / solution.approach_under_load",
        "abs(solution.approach - coarse.approach) / solution.approach",
        "contact/test_adaptive.py::test_bodies_that_stand_apart_have_the_estimate_of_those_that_touch",
    ),
    Fault(
        "line loads: the change of the largest one itself counts half",
        "loaded/line_load.py",
        "return max(above - 1.0, 1.0 - below, change, LEFT",
        "return max(above - 1.0, 1.0 - below, LEFT",
        "loaded/test_tooth_contact.py::test_estimate_of_slices_sees_a_change_beside_the_largest_line_load",
    ),
    Fault(
        "line loads: scatter within a slice counts twice",
        "loaded/line_load.py",
        "+ np.diff(borders) ** 2 / 12.0)",
        "+ np.diff(borders) ** 2 / 6.0)",
        "loaded/test_tooth_contact.py::test_loaded_length_is_that_of_an_even_load_with_the_same_scatter",
    ),
    Fault(
        "line loads: loaded lengths change 2 % too fast",
        "loaded/line_load.py",
        "np.asarray(6.0 / math.sqrt(12.0 * scatter)",
        "np.asarray(6.12 / math.sqrt(12.0 * scatter)",
        "loaded/test_tooth_contact.py::test_loaded_length_is_that_of_an_even_load_with_the_same_scatter",
    ),
    Fault(
        "pressure maps: a flank ends in the middle of its first empty cell",
        "results/pressure_map.py",
        "np.maximum(np.abs(centres) - 0.5 * step, 0.0)",
        "np.abs(centres)",
        "results/test_stress_below.py::test_flank_of_a_map_ends_where_its_last_cell_with_material_does",
    ),
    Fault(
        "pressure maps: cells twice as far from an end are near it",
        "results/pressure_map.py",
        "self.beside_end | (away < distance)",
        "self.beside_end | (away < 2.0 * distance)",
        "results/test_stress_below.py::test_flank_of_a_map_ends_where_its_last_cell_with_material_does",
    ),
    Fault(
        "mesh cycles: wheel angles of other tooth pairs are turned backwards",
        "loaded/cycle.py",
        "wheel_angle=path.wheel_angle + turned",
        "wheel_angle=path.wheel_angle - turned",
        "loaded/test_load_sharing.py::test_paths_of_all_pairs_are_told_in_the_angles_of_the_gears",
    ),
    Fault(
        "mesh cycles: deflection of a single pair without what displaces its slices",
        "loaded/cycle.py",
        "deflection[t, n] += loaded.slice_shares @ loaded.coupling_deflection",
        "deflection[t, n] += 0.0",
        "loaded/test_load_sharing.py::test_deflection_of_a_single_pair_has_what_displaces_its_slices",
    ),
    Fault(
        "line loads: the least error of slices falls with the cube of the cells",
        "loaded/loaded_contact.py",
        "least = LEAST_ERROR_OF_SLICES / min(self.solution.cells_across) ** 2",
        "least = LEAST_ERROR_OF_SLICES / min(self.solution.cells_across) ** 3",
        "loaded/test_tooth_contact.py::test_error_of_slices_that_agree_by_chance_falls_with_the_square_of_the_cells",
    ),
    Fault(
        "sensitivities: other positions are told where derivatives turn by half",
        "results/extremes.py",
        "nearer = (size > TOLD)",
        "nearer = (size > 10.0 * TOLD)",
        "results/test_extremes.py::test_derivatives_that_turn_by_a_twentieth_or_more_are_told",
    ),
    Fault(
        "sensitivities: kinks are told by their part of the largest derivative",
        "results/face_slopes.py",
        "scale = np.where(over_positions > LEVEL * largest, over_positions, largest)",
        "scale = largest",
        "results/test_sensitivities_at_edges.py::test_kinks_are_told_by_their_part_of_what_changes_over_the_positions",
    ),
    Fault(
        "sensitivities: rival strips are those that carry the same to 0.05 %",
        "results/face_slopes.py",
        "(lacking <= AS_LARGE))",
        "(lacking <= BESIDE))",
        "results/test_sensitivities_at_edges.py::test_a_strip_counts_as_a_rival_where_it_carries_as_much",
    ),
    Fault(
        "gap changes: mounting errors hold the lines of force",
        "separation/pair_change.py",
        "return self.of_modifications and self.holds_edges",
        "return self.holds_edges",
        "separation/test_gap_change.py::test_keys_move_edges_and_lines_of_force_or_hold_them",
    ),
    Fault(
        "gap changes: heights of both flanks add up where grids tilt",
        "separation/pair_change.py",
        "return np.asarray(second - first)",
        "return np.asarray(second + first)",
        "separation/test_gap_change.py::test_grid_that_tilts_on_flanks_alike_opens_no_gap",
    ),
    Fault(
        "boxes: ends of flanks that the contact does not reach shift them",
        "separation/box.py",
        "ends = np.where(reached, ends, ends.max(axis=2, keepdims=True))",
        "ends = np.where(reached, ends, ends)",
        "separation/test_box.py::test_box_that_its_contact_does_not_fill_is_as_long_either_way",
    ),
    Fault(
        "line loads: their ratio counts the face instead of the line across it",
        "results/collect.py",
        "loaded.line_load * longest / solution.load",
        "loaded.line_load * pair.face_width / solution.load",
        "results/test_key_figures.py::test_line_load_and_its_ratio_are_of_the_most_loaded_pair",
    ),
    Fault(
        "load factors: strips move with the other end of the common face",
        "results/load_factors.py",
        "own[6:] = 1.0 - share, share",
        "own[6:] = share, 1.0 - share",
        "results/test_load_factors.py::test_strips_of_an_even_load_grow_as_the_ends_of_the_common_face_move_apart",
    ),
    Fault(
        "results: numbers of edges are those of the pair with the peak pressure",
        "results/numbers.py",
        "columns = _column_of_largest(self.edge_pressure)",
        "columns = self.peak_column",
        "results/test_mesh_cycle.py::test_numbers_of_edges_are_those_of_the_pair_with_the_highest_pressure_at_one",
    ),
    Fault(
        "contact: cut cells count half a cell more in widths",
        "contact/patch.py",
        "parts[lines, end] - 0.5)",
        "parts[lines, end])",
        "contact/test_patch.py::test_width_of_a_contact_that_fills_its_material_ends_with_the_parts_of_cut_cells",
    ),
    Fault(
        "contact: far columns have the moments of rows",
        "contact/love.py",
        "(2.0 * wide - long)",
        "(2.0 * long - wide)",
        "contact/test_love.py::test_series_of_wide_columns_meets_the_formula",
    ),
    Fault(
        "stresses below: their largest lies on the other side of the contact point",
        "results/subsurface.py",
        "+ one.y[along] * one.axes[1]\n",
        "- one.y[along] * one.axes[1]\n",
        "results/test_stress_below.py::test_stress_beside_a_spike_is_that_across_the_contact_point",
    ),
    Fault(
        "boxes: ends of parabolas 2 % of what is left of them too far",
        "separation/strips.py",
        "np.sqrt(outer + rest)",
        "np.sqrt(outer + 1.02 * rest)",
        "separation/test_strips.py::test_end_of_a_penetration_that_falls_as_a_parabola_is_where_that_is_zero",
    ),
    Fault(
        "cover: cells at the end of a grid count half their width",
        "separation/sample.py",
        "sums[:, -1] += steps[:, -1]",
        "sums[:, -1] += 0.5 * steps[:, -1]",
        "separation/test_separation.py::test_cover_of_cells_that_an_oblique_edge_cuts_follows_its_distance_up_to_the_end_of_the_grid",
    ),
    Fault(
        "line loads: slopes at their top leave out that the loaded length changes",
        "results/slice_pressure.py",
        " + by_length * slices.length_slopes",
        "",
        "results/test_figure_slopes.py::test_line_load_over_the_loaded_length_changes_as_that_does",
    ),
    Fault(
        "supports: wind-up counts how the gears stand at rest",
        "results/supports.py",
        "for load in loads]) - support.at_rest",
        "for load in loads])",
        "supports/test_shafts_of_scenes.py::test_wind_up_is_that_of_the_torque_alone",
    ),
    Fault(
        "supports: lives of bearings are those of the first position",
        "results/supports.py",
        "bearing.life(own[loaded].mean(axis=0))",
        "bearing.life(own[loaded][0])",
        "supports/test_shafts_of_scenes.py::test_life_of_a_bearing_is_that_under_its_mean_motion_of_the_loaded_positions",
    ),
    Fault(
        "supports: motions of bodies are given on top of those of supports",
        "loaded/moved_gears.py",
        "else support.motion - body)",
        "else support.motion + body)",
        "supports/test_shafts_of_scenes.py::test_teeth_that_move_with_the_body_of_their_gear_are_displaced_by_nothing_else",
    ),
    Fault(
        "hypoid: distances from the root cone without the parabola between points",
        "gears/hypoid.py",
        "bend = before - 2.0 * at + after\n",
        "bend = before - 2.2 * at + after\n",
        "gears/test_hypoid.py::test_points_above_a_root_cone_are_as_far_as_the_parabola_through_them",
    ),
    Fault(
        "blanks: the blade reaches as deep as the mating tip",
        "gears/bevel_blank.py",
        "_TOOL_DEPTH = 1.1",
        "_TOOL_DEPTH = 1.0",
        "gears/test_bevel_blank.py::test_least_profile_shift_of_straight_teeth_is_that_of_their_virtual_gear_at_the_toe",
    ),
    Fault(
        "stages: a sun that moves towards a planet opens that mesh",
        "stages/balance.py",
        "along * tangential + np.sin(pressure_angle) * radial",
        "along * tangential - np.sin(pressure_angle) * radial",
        "stages/test_balance.py::test_sun_that_moves_towards_a_planet_closes_that_mesh_whichever_flank_is_loaded",
    ),
    Fault(
        "overlap ratio without the axial offset",
        "gears/involute.py",
        "return self.common_face_width * sin(abs(self.pinion.helix_angle))",
        "return min(self.pinion.face_width, self.wheel.face_width) * sin(abs(self.pinion.helix_angle))",
        "results/test_load_factors.py::test_overlap_counts_the_face_that_an_axial_offset_leaves_in_common",
    ),
    Fault(
        "a tip clearance of zero gives no warning",
        "results/gear_warnings.py",
        "if clearance < LEAST_CLEARANCE",
        "if 0.0 < clearance < LEAST_CLEARANCE",
        "results/test_gear_warnings.py::test_tip_that_comes_near_to_a_root_is_warned_of",
    ),
    Fault(
        "gearbox models: the kind of a stage that is not covered goes unnamed",
        "exchange/gearbox.py",
        'else f"{kind} stages are not covered"',
        'else "of two gears"',
        "exchange/test_stage.py::test_stages_of_other_kinds_are_named_with_what_is_covered",
    ),
    Fault(
        "planets that stand opposite are sent to places that are not",
        "stages/kinematics.py",
        "place = its_place + half_turns * math.pi",
        "pass",
        "stages/test_kinematics.py::test_places_of_planets_that_stand_opposite_are_opposite",
    ),
    Fault(
        "radial assembly: tip corners pass each other between the points of the way",
        "gears/internal_mesh.py",
        "np.maximum(ring.tip_radius, one) for one in ends",
        "np.maximum(ring.tip_radius + 0.05, one) for one in ends",
        "gears/test_internal_mesh.py::"
        "test_radial_assembly_has_the_room_of_the_ring_s_shadow_and_at_worst_that_of_trimming_interference",
    ),
    Fault(
        "usual factors: beyond the crown wheel the ratio of the teeth counts",
        "gears/blank_factors.py",
        "    if wheel <= 0.0:\n        return inf",
        "    if wheel <= 0.0:\n        return teeth[1] / teeth[0]",
        "scene/test_bevel_blank.py::test_blanks_pass_the_crown_wheel_without_a_jump",
    ),
    Fault(
        "blanks: a slot width that is given meets the usual thickness factor",
        "scene/bevel_blank.py",
        'about["thickness_modification"] = slot - 0.25 * pi',
        "pass",
        "scene/test_bevel_blank.py::test_factors_and_slot_widths_that_are_given_do_not_meet_the_usual_ones",
    ),
    Fault(
        "a gear on a shaft without a bore is held by the default one",
        "scene/model.py",
        "return bare.on_seat(shaft.diameter_at(self.face_middles[number]))",
        "return bare",
        "pairs/test_rigid_bores.py::test_a_gear_without_bore_is_held_at_the_seat_of_its_shaft",
    ),
    Fault(
        "wide bores: their effect is that of the default bore instead of the seat of the shaft",
        "compliance/model.py",
        "usual, difference = scene.without_bores(pair), 0.0",
        "usual, difference = scene.with_changes({'wheel.shaft': None}).without_bores(pair), 0.0",
        "results/test_warnings.py::test_wide_bores_are_warned_of_with_what_they_do_to_the_stiffness",
    ),
    Fault(
        "results of files: cells that edges cut count as whole",
        "results/derivatives.py",
        "return Separation(one.gap, *place, one.cover, cut_gap, one.force_line)",
        "return Separation(one.gap, *place, np.ones(one.gap.shape), 0.0 * cut_gap, one.force_line)",
        "results/test_memory_and_file.py::test_cells_at_the_cap_stay_there_in_the_states_of_a_file",
    ),
    Fault(
        "results of files: teeth of the scene couple neighbours alone",
        "results/derivatives.py",
        "bending = model_of(result.scene, pair, result.coupled_pitches)",
        "bending = model_of(result.scene, pair, 1)",
        "results/test_memory_and_file.py::test_teeth_that_states_of_a_file_couple_are_those_that_the_result_says",
    ),
    Fault(
        "states: tooth pairs in another order than results have",
        "loaded/cycle.py",
        "order = np.argsort(pairs).tolist()",
        "order = np.argsort(-pairs).tolist()",
        "results/test_memory_and_file.py::test_cells_at_the_cap_stay_there_in_the_states_of_a_file",
    ),
    Fault(
        "free edges: of no grid at all",
        "edges/free.py",
        "    if not grids:\n        return []\n",
        "",
        "supports/test_sensitivities.py::test_derivatives_from_a_file_are_those_of_the_analysis",
    ),
    Fault(
        "errors by the grid: of slices that carry nothing",
        "loaded/loaded_contact.py",
        "        if self.solution.load == 0.0:\n            return 0.0\n        if not self.is_rough:",
        "        if not self.is_rough:",
        "results/test_memory_and_file.py::test_contact_on_an_edge_has_no_error_without_load",
    ),
    Fault(
        "cap: cells between the bounds grow with their material, too",
        "results/gap_growth.py",
        "    growth[:, grid.active] = 0.0\n",
        "",
        "loaded/test_sensitivity.py::test_force_of_a_cell_at_the_cap_grows_with_its_part_of_material_and_no_other",
    ),
    Fault(
        "cap: what forces at the cap do to the slices of other pairs is left out",
        "loaded/sensitivity.py",
        "            moved += (self._coupling @ np.concatenate([one.sum(axis=0) for one in forces]))[self._slice]\n",
        "            pass\n",
        "loaded/test_sensitivity.py::test_forces_at_the_cap_that_grow_turn_the_pairs_as_the_dense_problem_solved_anew",
    ),
    Fault(
        "transforms: work arrays that an exception found in use are used again",
        "contact/convolution.py",
        "if kept is None or kept.in_use else kept",
        "if kept is None else kept",
        "contact/test_convolution.py::test_exception_at_any_line_leaves_the_next_convolution_right",
    ),
    Fault(
        "threads: helpers take further parts once the caller has raised",
        "threads.py",
        "        waiting.clear()\n",
        "",
        "test_threads.py::test_nobody_works_on_once_the_caller_has_raised",
    ),
    Fault(
        "threads: a caller that raises does not wait for the part that a helper is amidst",
        "threads.py",
        "            turn.acquire()\n",
        "            turn.locked()\n",
        "test_threads.py::test_nobody_works_on_once_the_caller_has_raised",
    ),
    Fault(
        "threads: no work where no thread can be started",
        "threads.py",
        "        except RuntimeError:\n            pass\n",
        "        except ZeroDivisionError:\n            pass\n",
        "test_threads.py::test_work_is_done_alone_where_no_thread_can_be_started",
    ),
    Fault(
        "designs: an exception as a grid grows leaves the slopes of the smaller one",
        "loaded/held_contacts.py",
        "        if self._is_linear:\n            larger",
        "        self._held[contact] = replace(larger, slopes=one.slopes)\n"
        "        if self._is_linear:\n            larger",
        "studies/test_design.py::test_a_contact_that_outgrows_its_grid_gets_a_larger_one",
    ),
    Fault(
        "area of a contact: cells without material count",
        "contact/patch.py",
        "inside = (square > 0.0) * cover[window]",
        "inside = (square > 0.0) * np.ones(cover[window].shape)",
        "contact/test_patch.py::test_area_and_axes_of_a_flat_punch_are_those_of_its_material",
    ),
    Fault(
        "slope jumps: those of any size on wide cells count",
        "contact/slope_jumps.py",
        "ALIKE = 1.35",
        "ALIKE = 2.5",
        "contact/test_slope_jumps.py::test_smooth_gaps_have_none",
    ),
    Fault(
        "slope jumps: valleys count",
        "contact/slope_jumps.py",
        "ONE_SIGN = 1.4",
        "ONE_SIGN = 0.1",
        "contact/test_slope_jumps.py::test_smooth_gaps_have_none",
    ),
    Fault(
        "slope jumps: the grid is refined as if the peak were smooth",
        "contact/adaptive.py",
        "return smooth and solution.slope_jump == 0.0",
        "return smooth",
        "contact/test_slope_jumps.py::test_both_solvers_warn_of_a_jump",
    ),
    Fault(
        "slope jumps: the estimate falls as if the peak were smooth",
        "contact/solution.py",
        "return self.estimate(self.slope_jump)",
        "return self.estimate(0.0)",
        "contact/test_slope_jumps.py::test_pressure_of_a_ridge_grows_as_the_warning_says",
    ),
    Fault(
        "slope jumps: no warning under a cap that is not reached",
        "contact/solution.py",
        "float(self.pressure.max()) < (self.problem.max_pressure or math.inf)",
        "self.problem.max_pressure is None",
        "contact/test_slope_jumps.py::test_cap_that_is_reached_limits_the_pressure_of_a_jump",
    ),
    Fault(
        "arguments: the mask of an array is dropped",
        "arrays.py",
        "    if has_masked_cells(values):\n        way_out",
        "    if False:\n        way_out",
        f"{ARGUMENTS}test_arrays_that_are_no_plain_numbers_are_refused_by_every_public_function",
    ),
    Fault(
        "arguments: the unit of numbers is dropped",
        "arrays.py",
        "return array if written is None else",
        "return array if True else",
        f"{ARGUMENTS}test_pressure_does_not_depend_on_how_a_gap_is_stored",
    ),
    Fault(
        "arguments: a public function is not among those whose arguments are checked",
        "flank_maps/vh_check.py",
        "@checked\ndef vh_check",
        "def vh_check",
        f"{ARGUMENTS}test_arrays_that_are_no_plain_numbers_are_refused_by_every_public_function",
    ),
    Fault(
        "arguments: measured points are the array of the caller",
        "flanks/topography.py",
        'numbers(name, values, "mm").copy()',
        'numbers(name, values, "mm")',
        f"{ARGUMENTS}test_results_share_no_memory_with_arrays_of_the_caller",
    ),
    Fault(
        "arguments: a warning is given where arguments are checked, not where the function is called",
        "errors.py",
        "stacklevel=_with_checks(stacklevel + 1)",
        "stacklevel=stacklevel + 1",
        f"{ARGUMENTS}test_warning_is_that_of_the_line_that_calls",
    ),
    Fault(
        "text: numbers are what Python takes for them",
        "input_files.py",
        "if len(text) > MOST_DIGITS or NUMBER.fullmatch(text) is None:",
        "if len(text) > MOST_DIGITS:",
        "flanks/test_topography_file.py::test_what_python_alone_takes_for_a_number_is_none",
    ),
    Fault(
        "text: the nearest name of a column with an unknown unit is that in metres",
        "flanks/topography.py",
        "        elif name in LENGTHS:\n            allowed",
        "        elif False:\n            allowed",
        "flanks/test_topography_file.py::test_unknown_unit_of_a_known_column_is_told_as_such",
    ),
    Fault(
        "local term of teeth: no more beside the free ends of the face than at mid-face",
        "compliance/influence.py",
        "_normal(deviation, distance, *images) + _normal(at_end, *images)",
        "_normal(deviation, distance, *images)",
        "compliance/test_influence.py::test_local_term_grows_towards_a_free_end_as_in_finite_elements_in_space",
    ),
    Fault(
        "sensitivities on arcs: places beside contact points are as far as on flanks",
        "separation/contact_points.py",
        "if _beside_arcs(pair, contacts[:1]).any():",
        "if False:",
        "separation/test_moving_edges.py::test_contact_points_and_levers_change_as_those_traced_anew_on_edges_too",
    ),
    Fault(
        "sensitivities on arcs: grids do not stay with the arcs",
        "separation/gap_change.py",
        "border.of_keys(edges).with_others(self.arcs.of_keys(edges))",
        "border.of_keys(edges)",
        "results/test_rounded_sensitivities.py::"
        "test_transmission_error_follows_a_misalignment_where_contacts_end_beside_the_arc_of_a_face_end",
    ),
    Fault(
        "sensitivities: grids go with their contact points through end reliefs",
        "separation/gap_change.py",
        "plane[edges, :, :2], open_to = self._with_gaps(gaps[edges], points.shifts[edges], scales[:, :2])",
        "plane[edges, :, :2], open_to = points.shifts[edges], np.tile(np.eye(MOTIONS), (len(separations), 1, 1))",
        "results/test_sensitivities.py::test_transmission_error_follows_a_misalignment_into_an_end_relief",
    ),
    Fault(
        "findings: every edge that a contact reaches has its edge pressure",
        "results/warnings.py",
        "return np.asarray(reached & (distances <= distances[reached].min() + 2.0 * max(one.spacing)))",
        "return np.asarray(reached)",
        "results/test_reached_edges.py::test_finding_names_the_edge_where_the_pressure_lies_not_every_edge_of_the_contact",
    ),
    Fault(
        "misalignment: both ends of a pitch count as two places in the picture",
        "plots/supports.py",
        "means = [mean_over_a_pitch(over_pitch) for over_pitch in values]",
        "means = np.nanmean(values, axis=1)",
        "supports/test_rolling_of_scenes.py::test_picture_of_the_misalignment_has_the_means_of_the_summary",
    ),
    Fault(
        "sensitivities: contacts count in the norm of the pressure by a power too much",
        "results/sensitivities.py",
        "weights = (parts / whole ** (1.0 / exponent)) ** (exponent - 1.0)",
        "weights = (parts / whole ** (1.0 / exponent)) ** exponent",
        "results/test_sensitivities.py::test_pressure_norm_grows_with_the_torque_as_between_two_analyses",
    ),
    Fault(
        "stages: mesh cycles begin at the pitch point",
        "stages/analyse.py",
        'start = float(cycle.dataset["pinion_angle"].values[0]) / pair.pitch',
        "start = 0.0",
        "stages/test_stage.py::test_phases_of_mesh_cycles_count_from_the_pitch_point",
    ),
    Fault(
        "stages: pressures are those of even shares",
        "stages/analyse.py",
        "largest = factor * torques / base_radius / planets",
        "largest = torques / base_radius / planets",
        "stages/test_stage.py::test_peak_pressure_is_that_of_the_mesh_under_the_largest_share_of_unequal_ones",
    ),
    Fault(
        "stages: a planet has the torque of the sun",
        "stages/analyse.py",
        "force * sun.wheel.base_radius",
        "force * sun.pinion.base_radius",
        "stages/test_stage.py::test_planet_has_the_torque_of_its_own_radius_under_the_force_of_the_sun",
    ),
    Fault(
        "stages: orders have half their amplitude",
        "stages/result.py",
        "2.0 / len(curve) * np.abs(np.fft.rfft(curve))",
        "1.0 / len(curve) * np.abs(np.fft.rfft(curve))",
        "stages/test_stage.py::test_amplitude_of_an_order_is_that_of_its_wave",
    ),
    Fault(
        "search: an ascent that creeps by hardly anything goes on by its model",
        "unloaded/reduced.py",
        "        stuck[rows] = share < HARDLY\n",
        "        stuck[rows] = stays\n",
        "unloaded/test_search.py::test_ascent_of_which_hardly_a_step_is_accepted_rises_along_its_slope_instead",
    ),
    Fault(
        "rigid supports enter the balance, which makes other boxes and grids with them than without",
        "loaded/standing.py",
        "what = grid, standing.giving_way, standing.displacement",
        "what = grid, standing.bending, standing.displacement",
        "supports/test_analysis.py::test_rigid_supports_are_none",
    ),
    Fault(
        "points that were moved off the arc of a face end are looked at although they lie beyond the tip",
        "unloaded/scan.py",
        "there = pair.wheel.flank.inside(rho, z, ON_EDGE)",
        "there = pair.wheel.flank.inside(rho, z, 1.0)",
        "unloaded/test_rounded_edges.py::test_points_off_the_arc_of_a_face_end_are_not_looked_at_beyond_the_tip",
    ),
    *(
        Fault(f"kinks: {what}", file, text, wrong, f"results/test_sensitivities_at_edges.py::{test}")
        for what, file, text, wrong, test in (
            (
                "the wheel tilts alike to both sides",
                "separation/pair_change.py",
                "replace(self, below=pair, difference=half, side=1)",
                "replace(self, side=1)",
                "test_ends_of_faces_of_one_width_are_a_kink_of_the_transmission_error_and_of_the_face_load_factor",
            ),
            (
                "edges that rule to one side rule to the other",
                "separation/pair_change.py",
                "rates = np.where(sides > 0, least, np.where(sides < 0, most, rates))",
                "rates = np.where(sides > 0, most, np.where(sides < 0, least, rates))",
                "test_aligned_faces_of_one_width_are_a_kink_without_a_slope",
            ),
            (
                "ends of the common face are those of the gear that is shorter by micrometres",
                "results/face_slopes.py",
                "at_one_place = np.abs(ends[1] - ends[0]) < AT_ONE_PLACE * width",
                "at_one_place = np.abs(ends[1] - ends[0]) < 0.0 * width",
                "test_ends_of_faces_of_one_width_are_a_kink_of_the_transmission_error_and_of_the_face_load_factor",
            ),
        )
    ),
    *(
        Fault(f"derivatives by grids: {what}", file, text, wrong, f"results/test_sensitivities_at_edges.py::{test}")
        for what, file, text, wrong, test in (
            (
                "gaps do not go with the grids",
                "results/gap_growth.py",
                "gaps = held.slopes.T[:2,",
                "gaps = 0.0 * held.slopes.T[:2,",
                "test_grids_change_no_derivative_of_a_contact_that_reaches_no_edge",
            ),
            (
                "they are not told",
                "results/sensitivities.py",
                "warn_of_grids(self.keys, slopes, self.transmission_error_by_grids,",
                "warn_of_grids(self.keys, slopes, 0.0 * self.transmission_error_by_grids,",
                "test_what_grids_change_is_told_beside_what_derivatives_differ_by_over_the_positions",
            ),
            (
                "few cells below the cap are not told",
                "results/sensitivities.py",
                "and grid.active.sum() < FEW",
                "and grid.active.sum() < 0",
                "test_contacts_with_few_cells_below_the_cap_are_told",
            ),
        )
    ),
    Fault(
        "solve_to_accuracy: a peak that misses the accuracy is not said where that is of the approach",
        "contact/adaptive.py",
        "    if of_approach:\n        limit",
        "    if not figures:\n        limit",
        "contact/test_adaptive.py::test_peak_that_misses_the_accuracy_where_that_is_of_the_approach_is_said",
    ),
    Fault(
        "changes: a file of a measured flank does not take the place of the points",
        "scene/flank_form.py",
        '    alternatives: ClassVar[tuple[str, ...]] = ("file", "measurement")',
        "    alternatives: ClassVar[tuple[str, ...]] = ()",
        "scene/test_flank_form.py::test_another_file_takes_the_place_of_the_points_of_the_first",
    ),
    Fault(
        "measured flanks: a diameter is taken for a radius",
        "flanks/topography.py",
        'factors.append(("radius", 0.5 * UNITS[unit]))',
        'factors.append(("radius", UNITS[unit]))',
        "flanks/test_topography_file.py::test_file_of_windows_is_read",
    ),
    Fault(
        "tables: what a first line says of the separator is not obeyed",
        "input_files.py",
        'marks = ";\\t" if declared is None else declared[1]',
        'marks = ";\\t"',
        "flanks/test_topography_file.py::test_separator_of_the_first_line_rules",
    ),
    Fault(
        "pitch deviations: what stands behind a decimal comma is left out",
        "scene/pitch.py",
        "        require_decimal_points(table)\n",
        "",
        "scene/test_pitch.py::test_refusals",
    ),
    Fault(
        "report: no limit was met, although a note tells one",
        "reports/templates/result.html.j2",
        "{{ parts.warned(warnings, notes=limits + (lubrication.notes if lubrication else [])) }}",
        "{{ parts.warned(warnings) }}",
        "reports/test_report.py::test_result_without_warnings_says_so_and_one_of_an_earlier_version_too",
    ),
    Fault(
        "at a glance: the legend lies on the load over the face",
        "plots/at_a_glance.py",
        'loc="upper center", bbox_to_anchor=(0.5, BELOW))',
        'loc="lower center")',
        "plots/test_at_a_glance.py::test_nothing_of_the_sheet_covers_the_load_over_the_face",
    ),
    Fault(
        "stages: a sun that stays where it is has a picture of its orbit",
        "plots/stage.py",
        "if moves or draw is not plot_stage_sun_orbit}",
        "}",
        "plots/test_stage.py::test_rigid_sun_has_no_orbit",
    ),
    Fault(
        "pictures: what is said in an empty panel reaches into the next",
        "plots/style.py",
        "textwrap.fill(why, longest)",
        "why",
        "plots/test_at_a_glance.py::test_empty_panel_says_why_within_its_width",
    ),
    Fault(
        "vh --loaded: warnings of the analyses are not shown",
        "cli/commands.py",
        'print_summary(study_summary(rows), [directory / "vh_study.nc"',
        'print_summary("", [directory / "vh_study.nc"',
        "test_cli_vh.py::test_vh_under_load_keeps_the_study",
    ),
    Fault(
        "supports: what a shaft is wound up by counts as a tilt of the gear",
        "results/supports.py",
        "(motions[..., :3], motions[..., 3:5])",
        "(motions[..., :3], motions[..., 3:])",
        "supports/test_analysis.py::test_shaft_that_is_wound_up_is_no_soft_support",
    ),
    Fault(
        "pitch deviations: columns that are not read may stand beside them",
        "scene/pitch.py",
        "others = {*table.names} - {*COLUMNS, TOOTH}",
        "others = set[str]()",
        "scene/test_pitch.py::test_refusals",
    ),
    Fault(
        "pitch deviations: teeth may be numbered otherwise than their lines",
        "scene/pitch.py",
        "if cell != str(first + line):",
        "if cell != cell:",
        "scene/test_pitch.py::test_refusals",
    ),
    Fault(
        "load sharing: the wheel alone goes the way of a pair under load",
        "loaded/load_sharing.py",
        "halves = 0.5 * self.pair.driving * (rotation - self.separations[indices])",
        "halves = 0.0 * self.pair.driving * (rotation - self.separations[indices])",
        "loaded/test_load_sharing.py::test_pinion_and_wheel_in_each_others_place_stand_to_each_other_as_before",
    ),
    Fault(
        "load sharing: the middle of the way on the wrong side where the wheel drives",
        "loaded/load_sharing.py",
        "halves = 0.5 * self.pair.driving * (rotation - self.separations[indices])",
        "halves = 0.5 * (rotation - self.separations[indices])",
        "loaded/test_load_sharing.py::test_pinion_and_wheel_in_each_others_place_stand_to_each_other_as_before",
    ),
    Fault(
        "load sharing: a pair at the middle of its way keeps the lever of first contact",
        "loaded/load_sharing.py",
        "self.levers[1, index] = middle.wheel_lever",
        "self.levers[1, index] = contact.wheel_lever",
        "loaded/test_load_sharing.py::test_pinion_and_wheel_in_each_others_place_stand_to_each_other_as_before",
    ),
    Fault(
        "sensitivities: levers leave where a pair at the middle of its way touches as it is",
        "results/gap_growth.py",
        "turns = points.turns - pair.driving * ways * rates",
        "turns = points.turns + 0.0 * ways * rates",
        "results/test_sensitivities.py::test_bending_follows_a_contact_that_a_relief_moves_up_the_tooth",
    ),
    Fault(
        "bending model: its teeth are the next ones, however many can be in contact",
        "analysis.py",
        "apart = pitches_apart(pair, supports, scene.torques) if wanted.load_sharing else 1",
        "apart = 1",
        "test_analysis.py::test_ends_of_a_pitch_agree_where_the_pressure_lies_beside_the_axis_of_its_grid",
    ),
    Fault(
        "reach: teeth that are within it at some places of a pitch alone count as apart",
        "unloaded/tooth_cycle.py",
        "(near[0] & near[-1]).any()",
        "(near[0] & near[-1]).all()",
        "unloaded/test_tooth_cycle.py::test_pitches_within_reach_are_those_of_many_positions",
    ),
    Fault(
        "load sharing: tooth pairs are solved in the order of their distance from the pitch point",
        "loaded/load_sharing.py",
        "key=lambda tooth_pair: tooth_pair.pair, reverse=True",
        "key=lambda tooth_pair: -abs(tooth_pair.pair), reverse=True",
        "test_random_scenes.py::test_what_holds_of_every_scene_holds_of_a_random_one",
    ),
    Fault(
        "command line: a new result leaves what was written of parts of the old one",
        "cli/directories.py",
        """places = ["", *(part.name for part in _parts_of(directory))]""",
        """places = [""]""",
        "test_cli.py::test_run_leaves_no_file_of_an_earlier_result_and_each_of_the_user",
    ),
    Fault(
        "command line: a study goes beside a result",
        "cli/directories.py",
        "if name != main and (directory / name).exists():",
        "if name != main and main != STUDY_FILE and (directory / name).exists():",
        "test_cli_study.py::test_study_goes_into_no_directory_of_a_result",
    ),
    Fault(
        "load factors: halves of the positions are one behind the other, not every second one",
        "results/load_factors.py",
        "strips[place % 2] +=",
        "strips[2 * place // places] +=",
        "results/test_load_factors.py::test_positions_that_load_unlike_parts_of_the_face_move_its_strips",
    ),
    Fault(
        "scenes: keys that say the same in several ways are not told apart in lists",
        "scene/section.py",
        "section = entry.kind.section\n        else:\n            return ()",
        "return ()\n        else:\n            return ()",
        "scene/test_flank_form.py::test_another_file_takes_the_place_of_the_points_of_the_first",
    ),
    Fault(
        "scenes: the seed of a class stays behind where deviations are given",
        "scene/section.py",
        "    others += [companion for other in others for companion in section.companions.get(other, ())]\n",
        "",
        "scene/test_pitch.py::test_deviations_of_one_key_take_the_place_of_those_of_another",
    ),
    Fault(
        "stages: another file does not take the place of the points of the first",
        "stages/sections.py",
        "(dict.fromkeys(replaced_by(type(self), changes)) | dict(changes)).items()",
        "dict(changes).items()",
        "stages/test_stage.py::test_another_file_takes_the_place_of_the_points_of_a_planet",
    ),
    Fault(
        "pictures: the mark of the unloaded contact point is the middle of a map, wherever gears stand",
        "plots/pressure_map.py",
        "result.paths[at[1]].point[at[0]] - one.origin)",
        "0.0 * one.origin)",
        "plots/test_plots.py::test_pressure_map_marks_the_point_that_its_title_names",
    ),
    Fault(
        "results: the place of the peak without load is a corner of the grid",
        "loaded/loaded_contact.py",
        "if not pressure.any():\n            x, y, z = self.separation.origin",
        "if pressure.size == 0:\n            x, y, z = self.separation.origin",
        "results/test_mesh_cycle.py::test_peak_without_load_lies_at_the_contact_point",
    ),
    Fault(
        "results: the place of the edge pressure without load is a corner of the grid",
        "results/collect.py",
        "(across, along)) if loaded.solution.load > 0.0 else (0.0, 0.0)",
        "(across, along))",
        "results/test_mesh_cycle.py::test_peak_without_load_lies_at_the_contact_point",
    ),
    Fault(
        "edges of both flanks: cells on the arc of one are beside all others",
        "edges/places.py",
        "for axis in steps * (0, 1):",
        "for axis in steps * tuple(range(np.ndim(cells))):",
        "edges/test_places.py::test_cells_beside_an_edge_stay_with_that_edge",
    ),
    Fault(
        "edges of both flanks: arcs of the wheel count as the pinion's",
        "edges/places.py",
        "for first, gear in ((0, pair.pinion), (len(EDGE_NAMES), pair.wheel))",
        "for first, gear in ((0, pair.wheel), (len(EDGE_NAMES), pair.pinion))",
        "edges/test_places.py::test_arcs_have_the_numbers_of_their_edges_and_begin_a_radius_before_the_end_of_a_face",
    ),
    *(
        Fault(f"numbers of results: {what}", file, text, wrong, f"results/test_result.py::{test}")
        for what, file, text, wrong, test in (
            (
                "figures of numbers are in the units of the dataset",
                "results/result.py",
                "of=partial(_number, name, number.factor(head))",
                "of=partial(_number, name, 1.0)",
                "test_numbers_are_where_they_are_declared_to_be_and_one_more_is_declared_once",
            ),
            (
                "a file need not have what all results have",
                "results/result.py",
                "if number.asked is None or number.asked.by(",
                "if number.asked is not None and number.asked.by(",
                "test_numbers_are_where_they_are_declared_to_be_and_one_more_is_declared_once",
            ),
            (
                "the file of tribology keeps no warnings",
                "tribology/tribology.py",
                '"warnings": "\\n".join(self.warnings)',
                '"warnings": ""',
                "test_numbers_of_tribology_are_where_they_are_declared_to_be",
            ),
        )
    ),
    Fault(
        "designs: contacts of every torque are held in the boxes of the largest one",
        "studies/design_model.py",
        "HeldContacts(scene, mesh, ranges, t, self.cells, *bending) for t in",
        "HeldContacts(scene, mesh, ranges, float(self.torques.max()), self.cells, *bending) for t in",
        "studies/test_design.py::test_figures_under_a_torque_are_those_without_a_larger_one_beside_it",
    ),
    Fault(
        "tables: counts and numbers of teeth are no whole numbers",
        "results/result.py",
        "return values if factor == 1.0 else factor * values",
        "return factor * values",
        "test_revolution.py::test_root_stress_is_that_of_one_pitch_and_names_its_teeth",
    ),
    Fault(
        "sensitivities: contacts stay on their paths as a key changes the ways of their pairs",
        "results/gap_growth.py",
        "gaps[:count] += along[:, tangents.grid] * path",
        "pass",
        "results/test_sensitivities.py::test_contacts_go_along_their_paths_by_half_of_what_a_key_adds_to_their_ways",
    ),
    Fault(
        "boxes of gears on supports are those of another load than of rigid gears",
        "loaded/load_sharing.py",
        "count == 2 and self.teeth_bend and not self.grid.forces_on_grid_axis",
        "count == 2 and self.teeth_bend and not self.on_moved_gears",
        "supports/test_analysis.py::test_supports_next_to_rigid_keep_boxes_and_grids",
    ),
    Fault(
        "rows beside a rounded edge depend on rounding",
        "contact/rounded_edge.py",
        "int(whole_cells(per_length * length))",
        "math.ceil(per_length * length)",
        "contact/test_rounded_edge.py::test_rows_of_a_box_of_whole_rows_do_not_depend_on_rounding",
    ),
    Fault(
        "stresses below a line are those below an ellipse",
        "results/subsurface.py",
        "if over_mean < 1.25:",
        "if result.paths[self.column].on_line[self.position]:",
        "results/test_stress_below.py::test_unloaded_contact_decides_nothing",
    ),
    Fault(
        "the tooth of the largest share of a revolution is a rounding tie",
        "results/revolution.py",
        "for numbers in (values, self.peak_pressure) if",
        "for numbers in (values,) if",
        "test_revolution.py::test_tooth_of_shares_that_tie_is_that_of_the_highest_pressure",
    ),
    Fault(
        "estimated error of a peak: the cells from which its neighbours follow are cut off",
        "contact/solution.py",
        "NEAR_PEAK = 4",
        "NEAR_PEAK = 1",
        "contact/test_solution.py::test_change_beside_a_peak_is_that_of_whole_grids",
    ),
    Fault(
        "dissection: what a half leaves is added above the diagonal where its unknowns stand the other way round",
        "compliance/dissection.py",
        "if row >= column:",
        "if True:",
        "compliance/test_dissection.py::test_parts_that_are_alike_are_eliminated_once",
    ),
    Fault(
        "dissection: blocks on the diagonal of what is left are not updated",
        "compliance/dissection.py",
        "rest[rows, : rows.stop] -= coupling[rows] @ coupling[: rows.stop].T",
        "rest[rows, :first] -= coupling[rows] @ coupling[:first].T",
        "compliance/test_dissection.py::test_solution_is_that_of_a_sparse_solver",
    ),
    Fault(
        "dissection: of a load and a reading the last front that has both counts alone",
        "compliance/dissection.py",
        "result[used[middle:, None] - split, used[:middle]] += products",
        "result[used[middle:, None] - split, used[:middle]] = products",
        "compliance/test_dissection.py::test_flexibility_is_read_from_the_solution",
    ),
    Fault(
        "works done at once: helpers go on after an interrupt",
        "threads.py",
        "            state.last_wanted = -1\n            raise",
        "            raise",
        "test_threads.py::test_interrupt_ends_works_at_their_next_step",
    ),
    Fault(
        "works done at once: warnings are told as they come",
        "threads.py",
        "noted_accuracy_warnings(given=False, alone=True) as self",
        "noted_accuracy_warnings(given=False, alone=False) as self",
        "test_threads.py::test_warnings_of_works_are_given_in_their_order",
    ),
    Fault(
        "works done at once: the caller takes the threads of helpers, too",
        "threads.py",
        "jobs() - _under_way.count",
        "jobs()",
        "test_threads.py::test_works_are_done_at_once_the_last_by_the_caller",
    ),
    Fault(
        "sensitivities: grids on edges go along them as if no edge held them",
        "separation/gap_change.py",
        "open_to[on_edges, :2, :2] = forms[on_edges]",
        "open_to += 0.0",
        "separation/test_moving_edges.py::test_grid_of_a_contact_on_a_tip_edge_goes_along_it_with_the_crown",
    ),
    Fault(
        "a curvature that grows along a contact is taken for one that jumps",
        "results/figure_slopes.py",
        "changes[3:-3] - np.maximum(changes[:-6], changes[6:])",
        "changes[3:-3]",
        "results/test_figure_slopes.py::test_curvature_that_jumps_beside_the_peak_is_seen",
    ),
    Fault(
        "expected time: models of roots are counted as if one followed the other",
        "effort.py",
        "            first = ends.index(min(ends))",
        "            first = 0",
        "test_effort.py::test_time_is_that_of_what_ends_last",
    ),
    Fault(
        "expected time: the speed of another machine holds for this one",
        "machine_speed.py",
        "{versions} {machine}",
        "{versions}",
        "test_effort.py::test_speed_is_measured_once_on_a_machine",
    ),
    Fault(
        "Checking a scene loads all of SciPy's optimisation",
        "gears/ring.py",
        "import scipy\n",
        "import scipy.optimize\n",
        "test_public_names.py::test_check_and_the_imports_of_run_load_no_heavy_library",
    ),
    Fault(
        "Pictures of antialiased lines in many colours are files of 700 kB",
        "plots/style.py",
        "return content if len(content) <= LARGEST_PICTURE else _png_content(_with_palette(pixels))",
        "return content",
        "plots/test_plots.py::test_picture_of_too_many_colours_has_a_palette_and_stays_white_and_small",
    ),
    Fault(
        "The white of pictures with a palette is grey",
        "plots/style.py",
        "picture.putpalette((palette | (palette >> 6)).tolist())",
        "picture.putpalette(palette.tolist())",
        "plots/test_plots.py::test_picture_of_too_many_colours_has_a_palette_and_stays_white_and_small",
    ),
    Fault(
        "The dataset of a study makes an array as long as the study for each row and figure",
        "studies/rows.py",
        "            if name not in arrays:",
        "            if np.full((count, torques), np.nan) is not None and name not in arrays:",
        "studies/test_rows.py::test_dataset_has_one_array_for_each_figure_however_many_rows",
    ),
    Fault(
        "S-N curves: a life factor below 1 is interpolated towards the static strength, too",
        "reference/iso6336_6.py",
        "np.log(np.maximum(factors, 1.0)) / log(factors[0])",
        "np.log(factors) / log(factors[0])",
        "reference/test_iso6336_6.py::test_example_of_the_standard_has_its_lives_its_damage_and_its_safety",
    ),
    Fault(
        "S-N curves: nothing is broken by a stress above the static strength",
        "reference/iso6336_6.py",
        "return np.where((log_stress > levels[0]) & self.static_limit, -inf, life)",
        "return life",
        "reference/test_iso6336_6.py::test_beyond_the_ends_of_a_curve_a_tooth_breaks_or_lives_for_ever",
    ),
    Fault(
        "flank strength: constants of Z_L, Z_v and Z_R are those of the harder gear",
        "reference/iso6336_2.py",
        "softer = min(gear.limit_stress for gear in gears)",
        "softer = max(gear.limit_stress for gear in gears)",
        "reference/test_iso6336_2.py::test_kisssoft_report_of_a_planet_in_a_through_hardened_ring_has_its_factors",
    ),
    Fault(
        "root strength: through-hardened steel has the size factor of hardened teeth",
        "reference/iso6336_3_strength.py",
        'dict.fromkeys(("St", "V", "GTS", "GGG"), (1.03, 0.006, 30.0))',
        'dict.fromkeys(("St", "V", "GTS", "GGG"), (1.05, 0.010, 25.0))',
        "reference/test_iso6336_3_strength.py::test_kisssoft_reports_have_their_factors",
    ),
    Fault(
        "dynamic factor: relief counts as if it always took load away",
        "reference/iso6336_1.py",
        "np.abs(1.0 - softness * tip_relief)",
        "1.0 - softness * tip_relief",
        "reference/test_iso6336_1.py::test_relief_beyond_the_deflection_excites_as_that_below_it",
    ),
    Fault(
        "flank strength: strengths of two gears are those of two bins beside stresses of bins",
        "reference/iso6336_2.py",
        "each.reshape(*each.shape[:1], *[1] * (most - each.ndim), *each.shape[1:])",
        "each",
        "reference/test_iso6336_2.py::test_safeties_of_bins_are_those_of_each_gear_for_any_number_of_bins",
    ),
    Fault(
        "equivalent stress: one number of load cycles for all bins is summed as that of one bin",
        "reference/iso6336_6.py",
        "float(number_of_each.sum())",
        "float(np.sum(cycles))",
        "reference/test_iso6336_6.py::test_equivalents_have_one_number_of_load_cycles_for_all_bins_or_one_level",
    ),
    Fault(
        "hardness: an end of a line that is converted is off it by rounding",
        "reference/iso6336_5.py",
        "abs(level - ends) <= _ROUNDING * level",
        "level == ends",
        "reference/test_iso6336_5.py::test_ends_of_a_line_are_on_it_in_any_scale",
    ),
    Fault(
        "studies: torques of most variants are the coordinate of one with fewer, too",
        "studies/rows.py",
        "torque[np.isfinite(torque).any(axis=1)]",
        "torque[np.isfinite(torque).all(axis=1)]",
        "studies/test_rows.py::test_torques_are_a_coordinate_where_all_variants_that_were_analysed_have_the_same",
    ),
    Fault(
        "the bytes of a result's file stay in memory beside its arrays",
        "results/files.py",
        "            del store.ds.variables[name]\n",
        "",
        "results/test_files.py::test_reading_takes_no_more_memory_than_the_result",
    ),
    Fault(
        "the digest of a file is not seen where two portions meet",
        "results/files.py",
        "rest = portion[1 - len(DIGEST) :]",
        'rest = b""',
        "results/test_files.py::test_digest_is_the_same_wherever_portions_of_the_file_end",
    ),
    Fault(
        "every row of a study has texts of its own in memory",
        "results/files.py",
        "same.setdefault(text, text)",
        "text",
        "results/test_files.py::test_texts_that_are_alike_are_one_object",
    ),
    Fault(
        "slow variants share tasks of the executor, quick ones do not",
        "studies/run.py",
        "TASK_SECONDS * len(seconds) / max(sum(seconds), 1e-9)",
        "max(sum(seconds), 1e-9) / (TASK_SECONDS * len(seconds) + 1e-9)",
        "studies/test_run.py::test_quick_variants_share_tasks",
    ),
    Fault(
        "pictures: ticks stay where they were before the layout",
        "plots/layout.py",
        "        if now != place:",
        "        if not place:",
        "plots/test_layout.py::test_ticks_measured_once_at_a_place_draw_the_same_picture",
    ),
    Fault(
        "pictures: contacts on the flanks are joined by the cells between two maps",
        "plots/flanks.py",
        "np.pad(loaded, ((0, 1), (0, missing)), constant_values=np.nan)",
        'np.pad(loaded, ((0, 1), (0, missing)), mode="edge")',
        "plots/test_plots.py::test_contact_areas_lie_around_the_path_within_the_flank",
    ),
    Fault(
        "search: an ascent goes on without any step",
        "unloaded/reduced.py",
        "ended = settled | repeats | ",
        "ended = settled | ",
        "unloaded/test_search.py::test_ascent_outside_both_flanks_without_any_step_left_ends",
    ),
    Fault(
        "rating: roots take the face load factor of flanks",
        "rating/evaluate.py",
        'loads["K_Fbeta"] * loads["K_Falpha"]',
        'loads["K_Hbeta"] * loads["K_Falpha"]',
        "rating/test_rating.py::test_stresses_are_nominal_ones_times_load_factors",
    ),
    Fault(
        "rating: both gears turn as often as the pinion",
        "rating/inputs.py",
        "np.array([1.0, ratio])",
        "np.array([1.0, 1.0])",
        "rating/test_rating.py::test_load_cycles_count_turns_of_each_gear",
    ),
    Fault(
        "rating: contact pressure grows as the load",
        "rating/evaluate.py",
        'stress = pressure * np.sqrt(loads["K_A"] * loads["K_v"])',
        'stress = pressure * loads["K_A"] * loads["K_v"]',
        "rating/test_rating.py::test_stresses_are_nominal_ones_times_load_factors",
    ),
    Fault(
        "rating: the transverse load factor of the analysis has no bound",
        "rating/loads.py",
        "np.clip(of_analysis, 1.0, max(1.0, bound))",
        "np.maximum(of_analysis, 1.0)",
        "rating/test_rating.py::test_transverse_load_factor_of_the_analysis_stays_within_its_bounds",
    ),
    Fault(
        "rating: hardness of a named material counts in the scale of its kind",
        "scene/rating.py",
        "named_material(material, quality, hardness=hardness, scale=scale)",
        "named_material(material, quality, hardness=hardness)",
        "scene/test_rating_sections.py::test_hardness_counts_in_the_scale_of_its_key",
    ),
    Fault(
        "spectra: reversed bins wear the flanks that are analysed",
        "rating/evaluate.py",
        "np.where(idle.reshape(-1, *[1] * (stress.ndim - 1)), 0.0, stress)",
        "stress",
        "rating/test_spectrum.py::test_reversed_bins_load_the_other_flanks_and_bend_roots_both_ways",
    ),
    Fault(
        "spectra: hours of bins are those of the whole life, however long they are together",
        "rating/cases.py",
        "life * parts / parts.sum(),",
        "parts,",
        "rating/test_spectrum.py::test_damage_of_two_bins_adds_up_by_hours",
    ),
    Fault(
        "spectra: every bin turns as fast as the first",
        "rating/inputs.py",
        "60.0 * self.cases.speed[:, None]",
        "60.0 * self.cases.speed[0]",
        "rating/test_spectrum.py::test_speed_of_a_bin_counts_its_load_cycles_beside_quicker_ones",
    ),
    Fault(
        "spectra: torques between those that are solved stand in equal ratios",
        "scene/load.py",
        "np.linspace(smallest, largest, SOLVED)",
        "np.geomspace(smallest, largest, SOLVED)",
        "scene/test_load.py::test_many_torques_are_a_dozen_in_equal_steps_up_to_the_largest",
    ),
    Fault(
        "spectra: below the smallest torque solved stresses grow as at it",
        "rating/solved.py",
        "logarithms + slope * (wanted - inside).reshape(shape)",
        "logarithms",
        "rating/test_spectrum.py::test_powers_of_the_torque_are_interpolated_without_error",
    ),
)


def copy_to(folder: Path) -> None:
    """Copy what tests need."""
    for name in COPIED:
        if (ROOT / name).is_dir():
            shutil.copytree(ROOT / name, folder / name, ignore=shutil.ignore_patterns("__pycache__"))
        else:
            shutil.copy(ROOT / name, folder / name)


def tested(folder: Path, tests: list[str]) -> int:
    """Exit code of pytest for tests of a copy."""
    command = [sys.executable, "-m", "pytest", "--quiet", "--exitfirst", "--tb=no", "-p", "no:cacheprovider"]
    environment = {**os.environ, "PYTHONPATH": str(folder), "PYTHONDONTWRITEBYTECODE": "1"}
    paths = [f"tests/{test}" for test in tests]
    return subprocess.run([*command, *paths], cwd=folder, env=environment, capture_output=True, check=False).returncode


def main(words: list[str]) -> int:
    """Try the faults with any of the words in their description; without words, all."""
    faults = [fault for fault in FAULTS if not words or any(word in fault.what for word in words)]
    missed = 0
    with TemporaryDirectory() as name:
        folder = Path(name)
        copy_to(folder)
        if tested(folder, sorted({fault.test for fault in faults})) != PASSED:
            print("the tests fail without any fault")
            return 1
        for fault in faults:
            path = folder / "loaded_tca" / fault.file
            sound = path.read_text(encoding="utf-8")
            if sound.count(fault.text) == 1:
                path.write_text(sound.replace(fault.text, fault.wrong), encoding="utf-8")
                code = tested(folder, [fault.test])
                path.write_text(sound, encoding="utf-8")
                verdict = {FAILED: "noticed", PASSED: "NOT NOTICED"}.get(code, f"pytest ends with {code}")
            else:
                verdict = "ITS TEXT IS NOT THERE ONCE"
            missed += verdict != "noticed"
            print(f"{verdict}: {fault.what}", flush=True)
    print(f"{len(faults)} faults, {missed} of them not noticed")
    return 1 if missed else 0


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description="Deliberate faults of the package, and the tests that notice them.")
    parser.add_argument("words", nargs="*", help="those faults alone with one of these words in their description")
    sys.exit(main(parser.parse_args().words))
