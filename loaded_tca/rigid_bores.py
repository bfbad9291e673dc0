"""Bores on which the bodies of a scene are held where its teeth bend, known before anything is computed."""

from __future__ import annotations

from loaded_tca.analysis import BORE
from loaded_tca.errors import InputError
from loaded_tca.scene import Scene
from loaded_tca.tooth import tooth_forms
from loaded_tca.tooth_compliance import GearTooth, MeshDensity

GEARS = ("pinion", "wheel")


def rigid_bores(scene: Scene) -> tuple[float, float] | None:
    """Bore diameters of pinion and wheel [mm], given or by default; the smallest one of a cone.

    Parameters
    ----------
    scene : Scene

    Returns
    -------
    (float, float) or None
        None where the scene does not ask for teeth that bend: no bore is held then.

    Raises
    ------
    InputError
        If a bore leaves no rim below the teeth, as the analysis would; every gear that it holds for is named.
    GeometryError
        If a tooth is pointed or cut off.

    Examples
    --------
    >>> from loaded_tca.scene import parse_scene
    >>> scene = parse_scene('''
    ... pair = {type = "cylindrical", normal_module_mm = 3.0}
    ... pinion = {teeth = 25, face_width_mm = 20.0}
    ... wheel = {teeth = 37, face_width_mm = 20.0, bore_diameter_mm = 40.0}
    ... material = {youngs_modulus_MPa = 206000.0, poisson_ratio = 0.3}
    ... load = {pinion_torque_Nm = 40.0}
    ... analysis = {load_sharing = true, compliance = "contact+tooth"}''')
    >>> [round(bore, 3) for bore in rigid_bores(scene)]
    [37.125, 40.0]
    """
    if scene.analysis.compliance == "contact":
        return None
    pair = scene.pair()
    both = sorted((pair, scene.pair("negative" if pair.sense > 0 else "positive")), key=lambda one: -one.pinion.side)
    forms, problems, bores = tooth_forms(scene.mesh()), [], []
    for member, name in enumerate(GEARS):
        given: float | None = getattr(getattr(scene, name), BORE)
        flanks = getattr(both[0], name), getattr(both[1], name)
        try:
            tooth = GearTooth(flanks, forms[member], pair.materials[member], given)
            bores.append(tooth.nodes(MeshDensity()).bore_diameter)
        except InputError as error:
            problems += [f"{name}: {problem}" for problem in error.problems]
    if problems:
        raise InputError(problems)
    return bores[0], bores[1]
