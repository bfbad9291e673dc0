"""Planet and ring of the second stage of the NREL 5 MW reference gearbox, against the digits of a printed report.

The KISSsoft report stands beside a public model of the drive train (gfsReboucas/Drivetrain,
@NREL_5MW/stage_02.rtf); the stage is that of Nejad, Guo, Gao, Moan 2016, Wind Energy 19, table V. Tolerances are half a
unit of the last printed digit, or a whole one where the report cuts digits off.
"""

from pathlib import Path

from loaded_tca.scene import read_scene
from validation.table import Row

CASE, SOURCE = "planet and ring, NREL 5 MW, stage 2", "KISSsoft report of the stage"
SCENE = Path(__file__).parents[2] / "examples" / "scenes" / "planet_ring.toml"


def rows() -> list[Row]:
    """Diameters and contact ratio of the pair."""
    mesh = read_scene(SCENE).mesh()
    ring, planet = mesh.ring, mesh.pinion
    values = (
        ("root form diameter of the ring d_Ff [mm]", 1987.879, 2.0 * ring.form_radius, 1e-3),
        (
            "start of the active profile of the ring d_Nf [mm]",
            1969.750,
            2.0 * mesh.wheel_active_profile.start_radius,
            5e-4,
        ),
        (
            "start of the active profile of the planet [mm]",
            738.082,
            2.0 * mesh.pinion_active_profile.start_radius,
            5e-4,
        ),
        ("root diameter of the planet d_f [mm]", 724.663, 2.0 * planet.root_radius, 1e-3),
        ("transverse contact ratio eps_alpha", 1.618, mesh.transverse_contact_ratio, 5e-4),
        ("sum of profile shifts without backlash", 0.6210, mesh.profile_shift_sum_without_backlash, 5e-5),
    )
    return [Row(CASE, SOURCE, name, printed, obtained, digits / printed) for name, printed, obtained, digits in values]
