"""A gear pair in Exudyn
=====================

Two bodies of Exudyn turn with a force between spur teeth by tables over the pinion's angle: F = T1/r_b1 + k (x + r_b2
TE), x = r_b1 phi1 - r_b2 phi2, without separation by the mean stiffness and the first order of the error, and by the
whole curves never below 0; and damping c x'. The tooth-mesh frequency is the natural one, omega^2 = k (r_b1^2/J1 +
r_b2^2/J2). Writes dynamics.csv and dynamics_orders.csv. Needs ``pip install 'loaded_tca[clients]'``.
"""

import re
from pathlib import Path

import numpy as np
import pandas as pd

from loaded_tca import analyse, read_scene
from loaded_tca.output import write_dynamics

SCENE = read_scene(Path(__file__).parent / "scenes" / "mesh_cycle_spur.toml")
TORQUE, INERTIA, DAMPING = 100.0, (4e-3, 12e-3), 0.08  # N m; of pinion and wheel [kg m^2]; of the critical one
PITCHES, STEPS = 20, 64  # of a run, the last of which counts; of time in each


def response(mesh, teeth: float, radii, natural: float, damping: float) -> float:
    """Amplitude of the first order of x [m]; ``mesh``: angle of the pinion, x -> force without damping."""
    import exudyn.itemInterface

    items = exudyn.itemInterface
    container = exudyn.SystemContainer()
    system, kind = container.AddSystem(), exudyn.OutputVariableType.Coordinates
    nodes, markers, sensors = [], [], []
    for radius, inertia, sense in zip(radii, INERTIA, (1.0, -1.0), strict=True):
        nodes.append(system.AddNode(items.Node1D(initialVelocities=[natural / teeth * radii[0] / radius])))
        system.AddObject(items.Rotor1D(nodeNumber=nodes[-1], inertia=inertia))
        markers.append(system.AddMarker(items.MarkerNodeCoordinate(nodeNumber=nodes[-1], coordinate=0)))
        system.AddLoad(items.LoadCoordinate(markerNumber=markers[-1], load=sense * TORQUE / radii[0] * radius))
        sensors.append(
            system.AddSensor(items.SensorNode(nodeNumber=nodes[-1], outputVariableType=kind, storeInternal=True))
        )

    def force(system, _time, _item, x, velocity, *_parameters):
        return mesh(float(np.squeeze(system.GetNodeOutput(nodes[0], kind))), x) + damping * velocity

    ends = {"markerNumbers": markers[::-1], "factor0": radii[1], "factor1": radii[0]}  # second less first
    system.AddObject(items.CoordinateSpringDamperExt(**ends, springForceUserFunction=force))
    system.Assemble()
    settings = exudyn.SimulationSettings()
    settings.timeIntegration.numberOfSteps = PITCHES * STEPS
    settings.timeIntegration.endTime = PITCHES * 2.0 * np.pi / natural
    settings.solution.sensors.writePeriod = settings.timeIntegration.endTime / (PITCHES * STEPS)
    settings.solution.file.write = False
    system.SolveDynamic(settings, solverType=exudyn.DynamicSolverType.RK44)
    turned = [system.GetSensorStoredData(sensor)[-STEPS:, 1] for sensor in sensors]
    return 2.0 / STEPS * abs(np.fft.rfft(radii[0] * turned[0] - radii[1] * turned[1])[1])


def main() -> tuple[float, float]:
    """Return the amplitude over that of a linear oscillator: by mean and first order, and by curves and separation."""
    write_dynamics(analyse(SCENE.with_changes({"analysis.torques_Nm": (TORQUE,)})), "dynamics.csv")
    lines = Path("dynamics.csv").read_text(encoding="utf-8")
    head = {name: float(value) for name, value in re.findall(r"^# (\w+) = ([^:\s]+)", lines, re.MULTILINE)}
    curves, orders = (pd.read_csv(name, comment="#") for name in ("dynamics.csv", "dynamics_orders.csv"))
    teeth, radii = head["pinion_teeth"], np.array([head["pinion_base_radius_m"], head["wheel_base_radius_m"]])
    stiffness, (mean, error) = orders.mesh_stiffness_amplitude_N_per_m[0], orders.transmission_error_amplitude_m[:2]
    mass = 1.0 / (radii**2 / INERTIA).sum()
    natural = np.sqrt(stiffness / mass)

    static, lead = TORQUE / radii[0], orders.transmission_error_phase_rad[1]

    def linear(angle, x):
        return static + stiffness * (x + mean + error * np.cos(teeth * angle + lead))

    def whole(angle, x):
        names, phase = ("mesh_stiffness_N_per_m", "transmission_error_m"), teeth * angle / (2.0 * np.pi)
        k, path = (np.interp(phase, curves.mesh_phase, curves[name], period=head["pitches"]) for name in names)
        return max(static + k * (x + path), 0.0)

    shape = teeth, radii, natural, 2.0 * DAMPING * mass * natural
    return tuple(float(response(mesh, *shape) * 2.0 * DAMPING / error) for mesh in (linear, whole))


if __name__ == "__main__":
    print(main())
