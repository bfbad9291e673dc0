"""The result of an analysis: what the tooth pairs carry over the positions of a pitch, under each torque.

Which edges of the two flanks a loaded contact reaches: the tips, the roots, the face ends.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, fields
from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from loaded_tca.arguments import checked
from loaded_tca.errors import require
from loaded_tca.plain import plain, signed
from loaded_tca.results.declared import PAIRS
from loaded_tca.results.derivatives import sensitivities
from loaded_tca.results.dynamics import dynamics_of
from loaded_tca.results.figures import FIGURES
from loaded_tca.results.files import Buffer, variables_of
from loaded_tca.results.key_figures import UnderTorque
from loaded_tca.results.numbers import CycleNumbers
from loaded_tca.results.pressure_map import arrays_of_maps, maps_from
from loaded_tca.results.quantities import IN_FILES, IN_SOME_FILES, MOTIONS, PATH_PARTS, SIZES
from loaded_tca.results.result import AnalysisResult
from loaded_tca.results.root_stress import RootStressMap, root_stress_maps
from loaded_tca.results.summary import limits_of, summary_text
from loaded_tca.results.tables import Columns, contacts_table, positions_table
from loaded_tca.results.warnings import findings_of
from loaded_tca.unloaded import ContactPath

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    import xarray
    from numpy.typing import ArrayLike

    from loaded_tca.arrays import Array
    from loaded_tca.rating import Rating
    from loaded_tca.reports import InteractivePage
    from loaded_tca.results.sensitivities import Sensitivities
    from loaded_tca.scene import Scene
    from loaded_tca.tribology import Lubricant, Tribology


@dataclass(frozen=True, eq=False, kw_only=True, repr=False)
class MeshCycle(CycleNumbers, AnalysisResult):
    """Loaded contact over the positions of a pitch, under each torque.

    Every name of ``QUANTITIES`` and, with root stress, of ``ROOT_PARTS`` is an attribute too: ``result.peak_pressure``
    is the NumPy array of ``result.dataset["peak_pressure"]``, with the axes (torque, position, pair) whatever their
    lengths. NaN where a pair carries nothing, but its ``normal_force`` and ``load_share``, which are zero; flags and
    counts are 0 there. What is computed from these numbers is computed when it is asked for, so that it follows what is
    written into the dataset.

    Attributes
    ----------
    scene : Scene
        What was analysed.
    dataset : xarray.Dataset
        Numbers of ``QUANTITIES`` with their units, over torque [N mm], position (``pinion_angle`` [rad]) and pair.
    path : ContactPath
        The unloaded contact; where pairs share the load, of the pair that leads, in the angles of the gears.
    paths : tuple of ContactPath
        Unloaded contact of each pair, in the angles of the gears; NaN where it is out of reach.
    maps : tuple of tuple of tuple of PressureMap or None
        ``maps[torque][position][pair]`` by index; None where a pair carries nothing.
    states : (Scene, tuple of LoadedStates) or None
        The contact problems behind the maps, of all positions torque by torque, for sensitivities, and the scene they
        belong to; on supports, where the gears stand elsewhere under each torque, those of each by themselves. None if
        the result comes from a file, which does not keep them: they are made again of the maps when needed, to the last
        bit.
    """

    WHAT: ClassVar = "the result of a mesh cycle"
    TITLE: ClassVar = "Loaded tooth contact"
    FIGURES: ClassVar = FIGURES
    BESIDE: ClassVar = IN_FILES
    BESIDE_SOME: ClassVar = IN_SOME_FILES

    def __repr__(self) -> str:
        peak = np.nanmax(self.peak_pressure, initial=0.0)
        torques = f"{len(self.torque)} torque" + "s" * (len(self.torque) > 1)
        return f"MeshCycle({len(self.path)} positions, {torques}, peak {plain(peak, 6)} MPa)"

    @cached_property
    def root_stress(self) -> tuple[RootStressMap, RootStressMap]:
        """Root stress of pinion and wheel over fillet and face: at the largest tension, and envelopes over the mesh.

        Raises
        ------
        NotAskedError
            If the scene does not ask for root stress.
        """
        return root_stress_maps(self)  # without any, this ends as an AttributeError in __getattr__, which says why

    def sensitivities(self, keys: Sequence[str]) -> Sensitivities:
        """Return the derivatives with respect to keys of the scene, all from one linear problem for each state.

        The loaded transmission error changes by the mean of the material removed over the contacts, weighted with the
        growth of the pressure with the torque. See :mod:`loaded_tca.loaded.sensitivity`.

        Parameters
        ----------
        keys : sequence of str
            As of ``scene.with_changes``: of the modifications of either gear, of machine settings and cutters, of
            mounting errors, and ``load.pinion_torque_Nm``, which stands for the torque of each row; numbers of
            [pinion.shaft] and [wheel.shaft], as ``pinion.shaft.bearings.0.at_mm``. Where gears stand on supports, how
            far these move them changes with every key.

        Returns
        -------
        Sensitivities

        Raises
        ------
        InputError
            With every key that is unknown, given twice, or that the scene cannot vary.
        ConvergenceError
            If a linear problem is not solved to its tolerance.
        """
        return sensitivities(self, keys)

    @checked
    def tribology(
        self,
        pinion_speed_rpm: ArrayLike | None = None,
        lubricant: Lubricant | None = None,
        roughness_um: Sequence[float | None] | None = None,
        application_factor: float | None = None,
        dynamic_factor: float | None = None,
        friction: str | float | None = None,
        bulk_temperature_C: float | None = None,
        scuffing_load_stage: float | None = None,
        permissible_film_ratio: float | None = None,
        supply: str | None = None,
    ) -> Tribology:
        """Return loss, temperatures, films and safeties at one speed or several, with an oil and a roughness.

        What is None is taken from [operation], [lubricant] and ``roughness_Ra_um`` of the scene. Slices of the
        contacts are found once: further speeds and oils are formulas on them.

        Parameters
        ----------
        pinion_speed_rpm : float or (s,) array [1/min], optional
            Several add the dimension ``speed``.
        lubricant : loaded_tca.tribology.Lubricant, optional
        roughness_um : (float, float) [um], optional
            Ra of pinion and wheel.
        application_factor, dynamic_factor : float, optional
            K_A, K_v; default: of the scene, or 1. K_Hbeta and K_Halpha are in the contact analysis.
        friction : {"ISO/TS 6336-22", "local", "Xu-Kahraman"} or float, optional
            Mean coefficient of the standard, the default of cylindrical gears; of each slice after Schlenk or after Xu
            and Kahraman; or a number.
        bulk_temperature_C : float [C], optional
            Of the teeth; default: computed, of cylindrical gears.
        scuffing_load_stage : float, optional
            Of the oil in the FZG test A/8.3/90, from 1 to 14.
        permissible_film_ratio : float, optional
            lambda_GFP.
        supply : {"dip", "spray", "submerged"}, optional
            How the oil comes to the gears, for the bulk temperature; default: of the scene, or "dip".

        Returns
        -------
        Tribology
            What lacks an input raises a NotAskedError that names it, when it is asked for.

        Raises
        ------
        InputError
            With every value outside its range.

        Warns
        -----
        AccuracyWarning
            Where an extreme lies at an edge or moves with the positions, a pressure is cut at the cap, the bulk is
            colder than the oil, or the pitch line velocity lies beyond the standards.

        Examples
        --------
        >>> from loaded_tca import analyse, read_scene
        >>> from loaded_tca.tribology import Lubricant
        >>> changes = {"analysis.positions": 17, "analysis.torques_Nm": [130.0], "analysis.compliance": "contact"}
        >>> result = analyse(read_scene("examples/scenes/mesh_cycle_spur.toml").with_changes(changes))
        >>> oil = Lubricant(viscosity_40=220.0, viscosity_100=19.0, density_15=890.0, oil_temperature=80.0)
        >>> tribology = result.tribology(1500.0, oil, (0.6, 0.6))
        >>> tribology.loss_factor.shape, tribology.film_ratio.shape
        ((1,), (1, 17, 3))
        """
        from loaded_tca.tribology import tribology_of  # which stands above results

        return tribology_of(
            self,
            pinion_speed_rpm=pinion_speed_rpm,
            lubricant=lubricant,
            roughness_um=roughness_um,
            application_factor=application_factor,
            dynamic_factor=dynamic_factor,
            friction=friction,
            bulk_temperature_C=bulk_temperature_C,
            scuffing_load_stage=scuffing_load_stage,
            permissible_film_ratio=permissible_film_ratio,
            supply=supply,
        )

    def rating(self, *, coast: MeshCycle | None = None) -> Rating:
        """Return safeties and lives of flanks and roots, after a standard and by the local stresses.

        The standard is ISO 6336, of bevel and hypoid pairs ISO 10300, method B1.

        Materials, required safeties, speed and oil are those of the scene: [pinion.strength], [wheel.strength],
        [rating], [operation], [lubricant]. Each torque is a load case for itself; under a load spectrum of the scene,
        ``load.case``, the cases are its bins, and their damage adds up.

        Parameters
        ----------
        coast : MeshCycle, optional
            Result of ``scene.coast_side()``, whose flanks carry the reversed bins of a load spectrum: they are rated,
            too, as kinds of failure "coast_flank" and "local_coast_flank", and roots carry the loads of both results.

        Returns
        -------
        loaded_tca.rating.Rating
            Under a load spectrum a :class:`loaded_tca.rating.SpectrumRating`.

        Raises
        ------
        InputError
            With every section that is missing; for pairs outside the standard, and results without load sharing, of
            fewer than five positions, or under no torque; for a coast side of another scene, or without reversed bins.

        Warns
        -----
        AccuracyWarning
            Where an edge of a flank, which local safeties leave out, has more than the peak pressure, or stresses
            between the torques that were solved may make the damage of a spectrum wrong by more than 1 %, or by a part
            of which fewer than four solved torques give no estimate.

        Examples
        --------
        >>> from loaded_tca import analyse, read_scene
        >>> changes = {"analysis.positions": 5, "analysis.compliance": "contact", "analysis.root_stress": False}
        >>> changes |= {"load.pinion_torque_Nm": 50.0}
        >>> result = analyse(read_scene("examples/scenes/rated_helical.toml").with_changes(changes))
        >>> result.rating().flank_safety.shape
        (1, 2)
        """
        from loaded_tca.rating import rating_of  # which stands above results

        return rating_of(self, coast=coast)

    def explore(self) -> InteractivePage:
        """Return the interactive page of the result: sliders over positions and torques, all pictures linked.

        As the last line of a cell of a notebook it is shown there; ``save`` writes it as one HTML file. It needs the
        extra ``interactive``.

        Returns
        -------
        loaded_tca.reports.InteractivePage

        Raises
        ------
        InputError
            If jinja2 or plotly is not installed.

        Examples
        --------
        >>> from loaded_tca import analyse, read_scene
        >>> changes = {"analysis.positions": 2, "analysis.torques_Nm": [20.0], "analysis.compliance": "contact"}
        >>> analyse(read_scene("examples/scenes/mesh_cycle_spur.toml").with_changes(changes)).explore()
        InteractivePage(title='Mesh cycle of a spur pair 34/57')
        """
        from loaded_tca.reports import explore  # which stands above results

        return explore(self)

    def to_dynamics(self) -> xarray.Dataset:
        """Return curves over the pitch and their Fourier coefficients in SI units, for models of gear dynamics.

        Every name ends in its unit; ``dataset[name].attrs`` say what it is, and ``dataset.attrs["conventions"]`` how
        angles, phases and signs count. A curve is x(phi1) = amplitude_0 + sum of amplitude_k cos(k z1 phi1 + phase_k),
        with the orders and phases of ``harmonics`` and ``harmonic_phases``.

        Returns
        -------
        xarray.Dataset
            Over ``pinion_torque_Nm`` and ``mesh_phase``, from 0 and without the repeated end of the pitch:
            ``transmission_error_m`` and ``_rad``, ``mesh_stiffness_N_per_m``, ``torsional_stiffness_Nm_per_rad``,
            ``loaded_pairs``, ``normal_force_per_torque_N_per_Nm``; over the torque and ``order``, from 0:
            ``transmission_error_amplitude_m``, ``transmission_error_phase_rad``, and so on; base radii, numbers of
            teeth; of cylindrical gears ``working_pressure_angle_rad`` and ``pinion_base_helix_angle_rad``, whose
            sign is the hand.

        Raises
        ------
        InputError
            If there is one position alone, or no load sharing: the error of one tooth pair has no period.

        Examples
        --------
        >>> from loaded_tca import analyse, read_scene
        >>> changes = {"analysis.positions": 5, "analysis.torques_Nm": [20.0], "analysis.compliance": "contact"}
        >>> scene = read_scene("examples/scenes/mesh_cycle_spur.toml").with_changes(changes)
        >>> dynamics = analyse(scene).to_dynamics()
        >>> dynamics.mesh_phase.values, dynamics.order.values
        (array([0.  , 0.25, 0.5 , 0.75]), array([0., 1.]))
        """
        return dynamics_of(self)

    def key_figures(self) -> tuple[dict[str, float], ...]:
        """Return the figures of the whole cycle for each torque, by names that end in their unit.

        ``peak_pressure_MPa`` is the highest ``peak_pressure``; "at_peak": at its position; "at_edge": at that of the
        highest edge pressure; "there": at that of the highest peak where Hertz holds.
        Means are over the positions. NaN: not known.
        """
        return super().key_figures()

    def under(self, torque: int) -> UnderTorque:
        """What figures are read off: the result under a torque, with its highest pressures and largest force."""
        return UnderTorque(self, torque)

    def summary(self) -> str:
        """Return the key figures in the engineer's units, one column per torque, and the warnings of the analysis."""
        figures = self.key_figures()
        more = [row for row, name in zip(self.rows(figures), self.figures, strict=True) if name not in self.FIGURES]
        about = self.title or self.TITLE, self.scope
        return summary_text(*about, figures, self.warnings or (), self.findings(), more, super().notes())

    def sentences(self) -> dict[str, tuple[str, ...]]:
        """What limits the figures, what edges do to them, and accuracy warnings."""
        return {"note": self.notes(), "finding": self.findings(), "warning": self.warnings or ()}

    def notes(self) -> tuple[str, ...]:
        """Sentences on what limits the figures; none for an ordinary point contact."""
        return (*super().notes(), *limits_of(self.key_figures()))

    def tables(self) -> dict[str, Callable[[], Columns]]:
        """Tables of the result by their names; that of contacts where tooth pairs share the load."""
        tables = super().tables()
        tables["positions"] = lambda: positions_table(self)
        if self.scene.analysis.load_sharing:
            tables["contacts"] = lambda: contacts_table(self)
        return tables

    def findings(self) -> tuple[str, ...]:
        """Return sentences on the largest pressures, if edges make them.

        The largest pressure at an edge, of pairs that carry a thousandth of the torque and more: where, under what
        load, how exact, and which relief takes the load off the edge; of torques that press on the same edge one
        sentence, under the one with the largest pressure, with the range of the others. A peak pressure of slices at an
        edge, on a pair that carries less than a tenth of the torque, beside the peak pressure of other pairs.
        """
        return findings_of(self)

    @property
    def scope(self) -> str:
        """Positions, tooth pairs that carry the load, and whether teeth bend, in words."""
        first, last = (math.degrees(self.pinion_angle[end]) for end in (0, -1))
        count = len(self.path)
        where = f"{count} positions, pinion angle {plain(first)} to {plain(last)} deg" if count > 1 else "1 position"
        if self.scene.analysis.load_sharing:
            numbers = [signed(number) for number in self.pair.tolist()]
            carrying = f"load shared by the tooth pairs {', '.join(numbers)}, at most {self.loaded_pairs.max()} at once"
            if len(numbers) == 1:
                carrying = f"tooth pair {numbers[0]} alone carries the load (load sharing on)"
        else:
            carrying = "one tooth pair carries the whole load (load sharing off)"
        return f"{where}; {carrying}; {self.bending}"

    def to_netcdf(self) -> Buffer:
        """Return the bytes of the file that ``save`` writes, with the same errors."""
        if self.scene.analysis.root_stress:
            self.root_tension  # noqa: B018 (raises a NotAskedError where there is none)
        return super().to_netcdf()

    def stored(self) -> xarray.Dataset:
        """The dataset with paths and maps, as files have them."""
        paths = (self.path, *self.paths)
        arrays = {f"path_{name}": np.stack([getattr(path, name) for path in paths]) for name in PATH_PARTS}
        arrays |= arrays_of_maps(self.maps)
        of_maps = {name: part for name, part in IN_SOME_FILES.items() if name in arrays}
        return self.dataset.assign(variables_of(IN_FILES | of_maps, arrays))

    @classmethod
    def problem_of(cls, file: xarray.Dataset) -> str:
        """That a file, as of sensitivities, has neither paths nor maps."""
        return "" if IN_FILES.keys() & file.variables.keys() else "it has neither paths of contact nor maps"

    @classmethod
    def parts_of(cls, subject: Scene, file: xarray.Dataset, arrays: Mapping[str, Array]) -> dict[str, Any]:  # noqa: ARG003
        """Paths and maps of a file."""
        lengths = {**SIZES, "motion": MOTIONS, "end": 2, "edge": 8, "path": 1 + file.sizes["pair"]}
        expected = {name: length for name, length in lengths.items() if name in file.sizes}
        checks = [(name, file.sizes[name] == length, f"{length}") for name, length in expected.items()]
        checks += [(name, file.sizes[name] > 0, "at least 1") for name in PAIRS]
        require(*((holds, f"{name}: {file.sizes[name]} long, expected {length}") for name, holds, length in checks))
        leading, *paths = (
            ContactPath(**{entry.name: arrays[f"path_{entry.name}"][k] for entry in fields(ContactPath)})
            for k in range(expected["path"])
        )
        return {"path": leading, "paths": tuple(paths), "maps": maps_from(arrays)}


load_result = MeshCycle.load
