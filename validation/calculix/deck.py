"""Input decks for CalculiX: two gears in plane strain, one contact pair for each tooth pair, hubs rigid."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from io import StringIO

import numpy as np

from validation.calculix.section import Ints, Section
from validation.calculix.steel import PENALTY, POISSON_RATIO, YOUNGS_MODULUS

THICKNESS = 0.1
"""Thickness of the plane strain slice [mm]; results are per length of face."""
LOAD_STEPS = (0.96, 1.0)
"""Torques of the steps over the nominal one: the last gives the results, their difference the tangent stiffness."""
LAST_ONLY = ",FREQUENCY=1000"
"""Results at the end of a step alone, however many increments it takes."""
CONTROLS = "*CONTROLS,PARAMETERS=FIELD\n1.E-5,1.E-5\n"
"""Residual and correction relative to their means: a thousand times tighter than the default."""


@dataclass(frozen=True)
class PlaneDeck:
    """What one run needs.

    Attributes
    ----------
    pinion, wheel : Section
    wheel_axis : float [mm]
        Place of the wheel's axis on the x axis; the pinion's is the origin.
    flanks : dict
        Elements of the pinion's and of the wheel's flank that each tooth pair may press together, by pair.
    hub_force : float [N]
        Torque on the pinion's slice over its bore radius.
    penalty : float [MPa/mm]
    load_steps : tuple of float
    stress : bool
        Whether the stress of all nodes is asked for.
    """

    pinion: Section
    wheel: Section
    wheel_axis: float
    flanks: dict[int, tuple[Ints, Ints]]
    hub_force: float
    penalty: float = PENALTY
    load_steps: tuple[float, ...] = LOAD_STEPS
    stress: bool = False

    @property
    def hub_node(self) -> int:
        """Node of the pinion's bore whose tangential displacement is that of all of them."""
        return int(self.pinion.bore[0]) + 1

    @property
    def nodes(self) -> int:
        """Nodes of both gears."""
        return len(self.pinion.nodes) + len(self.wheel.nodes)

    def text(self) -> str:
        """The whole deck."""
        out = StringIO()
        self._write_bodies(out)
        write_material(out, f"{THICKNESS}\n")
        self._write_contact(out)
        self._write_hubs(out)
        write_steps(out, self.hub_node, self.hub_force, self.load_steps, self.flanks, self.stress)
        return out.getvalue()

    def _write_bodies(self, out: StringIO) -> None:
        """Nodes and elements, the wheel's numbered after the pinion's."""
        sections = ((self.pinion, 1, 1), (self.wheel, len(self.pinion.nodes) + 1, len(self.pinion.elements) + 1))
        out.write("*NODE,NSET=NALL\n")
        for section, first, _ in sections:
            number = first + np.arange(len(section.nodes))
            np.savetxt(out, np.column_stack([number, section.nodes]), fmt="%d,%.12g,%.12g,0")
        out.write("*ELEMENT,TYPE=CPE8R,ELSET=EALL\n")
        for section, first, first_element in sections:
            number = first_element + np.arange(len(section.elements))
            np.savetxt(out, np.column_stack([number, section.elements + first]), fmt="%d", delimiter=",")

    def _write_contact(self, out: StringIO) -> None:
        """Flanks and contact pairs; the pinion's flank is the slave."""
        for pair, elements in self.flanks.items():
            for gear, first, chosen in zip("PW", (1, len(self.pinion.elements) + 1), elements, strict=True):
                out.write(f"*SURFACE,NAME={surface_name(gear, pair)},TYPE=ELEMENT\n")
                out.writelines(f"{first + element},S1\n" for element in chosen)
        write_contact_pairs(out, self.flanks, self.penalty)

    def _write_hubs(self, out: StringIO) -> None:
        """Bores rigid in cylindrical coordinates: the pinion's turns, the wheel's stands."""
        write_hub(out, "PBORE", self.pinion.bore + 1, 0.0)
        write_hub(out, "WBORE", self.wheel.bore + 1 + len(self.pinion.nodes), self.wheel_axis)
        write_turning_together(out, self.pinion.bore + 1)
        out.write("*BOUNDARY\nPBORE,1,1\nWBORE,1,2\n")


def surface_name(gear: str, pair: int) -> str:
    """Name of the flank of a gear in a tooth pair."""
    return f"{gear}{'M' if pair < 0 else ''}{abs(pair)}"


def write_set(out: StringIO, name: str, nodes: Iterable[int]) -> None:
    """Set of nodes."""
    out.write(f"*NSET,NSET={name}\n")
    out.writelines(f"{node},\n" for node in nodes)


def write_material(out: StringIO, thickness: str) -> None:
    """Steel for all elements."""
    out.write(f"*MATERIAL,NAME=STEEL\n*ELASTIC\n{YOUNGS_MODULUS},{POISSON_RATIO}\n")
    out.write(f"*SOLID SECTION,ELSET=EALL,MATERIAL=STEEL\n{thickness}")


def write_contact_pairs(out: StringIO, pairs: Iterable[int], penalty: float) -> None:
    """Frictionless face-to-face penalty contact."""
    out.write("*SURFACE INTERACTION,NAME=DRY\n*SURFACE BEHAVIOR,PRESSURE-OVERCLOSURE=LINEAR\n")
    out.write(f"{penalty:.6g}\n")
    for pair in pairs:
        out.write("*CONTACT PAIR,INTERACTION=DRY,TYPE=SURFACE TO SURFACE\n")
        out.write(f"{surface_name('P', pair)},{surface_name('W', pair)}\n")


def write_hub(out: StringIO, name: str, nodes: Ints, axis: float) -> None:
    """Cylindrical coordinates of a bore: 1 radial, 2 tangential, 3 axial."""
    write_set(out, name, nodes)
    out.write(f"*TRANSFORM,NSET={name},TYPE=C\n{axis},0,0,{axis},0,1\n")


def write_turning_together(out: StringIO, nodes: Ints) -> None:
    """Tangential displacement of all nodes of a bore equal to that of the first."""
    for node in nodes[1:]:
        out.write(f"*EQUATION\n2\n{node},2,1.,{nodes[0]},2,-1.\n")


def write_steps(
    out: StringIO, hub: int, force: float, load_steps: Iterable[float], pairs: Iterable[int], stress: bool = False
) -> None:
    """One static step a torque, and what is printed for it."""
    write_set(out, "HUB", [hub])
    for factor in load_steps:
        out.write(f"*STEP,INC=200\n*STATIC,SOLVER=SPOOLES\n1.,1.\n{CONTROLS}")
        out.write(f"*CLOAD\n{hub},2,{factor * force:.12g}\n*NODE PRINT,NSET=HUB{LAST_ONLY}\nU\n")
        for pair in pairs:
            out.write(
                f"*CONTACT PRINT,SLAVE={surface_name('P', pair)},MASTER={surface_name('W', pair)}{LAST_ONLY}\nCF\n"
            )
        out.write(f"*CONTACT FILE{LAST_ONLY}\nCDIS,CSTR\n")
        if stress:
            out.write(f"*EL FILE{LAST_ONLY}\nS\n")
        out.write("*END STEP\n")
