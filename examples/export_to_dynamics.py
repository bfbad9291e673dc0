"""Hand-off to dynamics
====================

Forces over the speed by a model with one degree of freedom, x = r_b1 phi1 - r_b2 phi2: m x'' + c x' + F = F0, F = F0 +
k(t) (x - x_s(t)), never below 0, with x_s = -r_b2 TE and m = 1/(r_b1^2/J1 + r_b2^2/J2). Writes dynamics.csv,
dynamics_orders.csv and export_to_dynamics.png.
"""

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from scipy.integrate import solve_ivp

from loaded_tca import analyse, read_scene
from loaded_tca.output import write_dynamics
from loaded_tca.plots import save_figure

SCENE = Path(__file__).parent / "scenes" / "mesh_cycle_spur.toml"
TORQUE, INERTIA = 100.0, (4e-3, 12e-3)  # N m; of pinion and wheel [kg m^2]
DAMPING = 0.08  # of the critical one
SPEEDS = np.linspace(0.15, 1.5, 109)  # tooth-mesh frequency over the natural one
PHASES = np.linspace(40.0, 50.0, 641)  # pitches whose forces count; those before let the start die away


def main() -> float:
    """Return the speed at which the second order of the tooth mesh has its resonance, over that of the first."""
    result = analyse(read_scene(SCENE).with_changes({"analysis.torques_Nm": (TORQUE,)}))
    write_dynamics(result, "dynamics.csv")
    mesh = result.to_dynamics().isel(pinion_torque_Nm=0)
    radii = np.array([mesh.pinion_base_radius_m, mesh.wheel_base_radius_m])
    mass, force = 1.0 / (radii**2 / INERTIA).sum(), TORQUE / radii[0]
    k = mesh.mesh_stiffness_amplitude_N_per_m.values, mesh.mesh_stiffness_phase_rad.values
    error = mesh.transmission_error_amplitude_m.values, mesh.transmission_error_phase_rad.values
    damping, natural = 2.0 * DAMPING * np.sqrt(k[0][0] * mass), np.sqrt(k[0][0] / mass)

    def series(phase, amplitude, lead):
        return (amplitude * np.cos(2.0 * np.pi * phase * mesh.order.values + lead)).sum()

    def tooth_force(phase, x):
        return np.maximum(force + series(phase, *k) * (x + series(phase, *error)), 0.0)

    def rates(phase, state):  # of all speeds at once, by the mesh phase
        x, velocity = np.split(state, 2)
        acceleration = (force - tooth_force(phase, x) - damping * velocity) / mass
        return np.concatenate([velocity, acceleration]) * np.tile(2.0 * np.pi / (natural * SPEEDS), 2)

    start = np.repeat([-error[0][0], 0.0], len(SPEEDS))
    found = solve_ivp(rates, (0.0, PHASES[-1]), start, t_eval=PHASES, rtol=1e-6, atol=1e-10).y[: len(SPEEDS)]
    factor = np.max([tooth_force(phase, x) for phase, x in zip(PHASES, found.T, strict=True)], axis=0) / force
    axes = (figure := Figure(figsize=(6.4, 3.6), layout="constrained")).subplots()
    axes.plot(SPEEDS, factor)
    axes.set(xlabel="tooth-mesh frequency over natural frequency", ylabel="largest over static tooth force")
    save_figure(figure, "export_to_dynamics.png")
    return float(SPEEDS[np.where(SPEEDS < 0.7, factor, 0.0).argmax()])


if __name__ == "__main__":
    print(main())
