"""A gear pair in ROSS
===================

Two rotors of ROSS on rigid bearings, coupled by the mean mesh stiffness of spur gears and excited by the first order of
their transmission error where the tooth-mesh frequency is the natural one: omega^2 = k (r_b1^2/J1 + r_b2^2/J2). Writes
dynamics.csv and dynamics_orders.csv. Needs ``pip install 'loaded_tca[clients]'``.
"""

import re
from pathlib import Path

import numpy as np
import pandas as pd

from loaded_tca import analyse, read_scene
from loaded_tca.output import write_dynamics

SCENE = read_scene(Path(__file__).parent / "scenes" / "mesh_cycle_spur.toml")
INERTIA, DAMPING = (4e-3, 12e-3), 0.08  # of pinion and wheel [kg m^2]; of the critical one
RIGID = 1e13  # [N/m], beside less than 1e9 of the mesh


def main() -> tuple[float, float]:
    """Return the natural frequency and the amplitude of r_b1 phi1 - r_b2 phi2 there, over their closed forms."""
    import ross

    write_dynamics(analyse(SCENE.with_changes({"analysis.torques_Nm": (100.0,)})), "dynamics.csv")
    lines = Path("dynamics_orders.csv").read_text(encoding="utf-8")
    head = {name: float(value) for name, value in re.findall(r"^# (\w+) = ([^:\s]+)", lines, re.MULTILINE)}
    mesh = pd.read_csv("dynamics_orders.csv", comment="#").set_index("order")
    stiffness, error = mesh.mesh_stiffness_amplitude_N_per_m[0], mesh.transmission_error_amplitude_m[1]
    radii = np.array([head["pinion_base_radius_m"], head["wheel_base_radius_m"]])
    mass = 1.0 / (radii**2 / INERTIA).sum()
    natural = np.sqrt(stiffness / mass)

    class Pair(ross.MultiRotor):
        def C(self, frequency):  # noqa: N802  # the mesh of ROSS has no damping
            matrix = super().C(frequency)
            matrix[np.ix_(places, places)] += 2.0 * DAMPING * mass * natural * self.coupling_matrix()
            return matrix

    def rotor(teeth, radius, inertia):  # the gear at the first node of a light shaft
        shaft = ross.ShaftElement(L=0.1, idl=0.0, odl=0.05, material=ross.Material("light", rho=1e-3, E=2e11, G_s=8e10))
        form = {"base_diameter": 2.0 * radius, "pr_angle": head["working_pressure_angle_rad"]}
        gear = ross.GearElement(0, 2.0 * inertia / radius**2, 0.5 * inertia, inertia, int(teeth), **form)
        return ross.Rotor([shaft], [gear], [ross.BearingElement(n, kxx=RIGID, cxx=0.0, kzz=RIGID) for n in (0, 1)])

    teeth = head["pinion_teeth"], head["wheel_teeth"]
    pair = Pair(*map(rotor, teeth, radii, INERTIA), coupled_nodes=(0, 0), gear_mesh_stiffness=stiffness)
    places = [n for gear in (pair.mesh.driving_gear, pair.mesh.driven_gear) for n in gear.dof_global_index.values()]
    length = pair.coupling_matrix()[5] / radii[0]  # by motions of the gears, whose sixth is the pinion's rotation
    force = np.bincount(places, stiffness * error * length, pair.ndof)
    motion = pair.transfer_matrix(speed=natural / teeth[0], frequency=natural) @ force
    ratios = pair.run_modal(0.0, num_modes=2 * pair.ndof, sparse=False).wn / natural
    return float(ratios[np.abs(ratios - 1.0).argmin()]), float(abs(length @ motion[places]) * 2.0 * DAMPING / error)


if __name__ == "__main__":
    print(main())
