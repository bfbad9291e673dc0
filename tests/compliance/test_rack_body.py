"""The body of a rack: a piece of the ring that stands for it."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import pytest

from loaded_tca.arrays import Array
from loaded_tca.compliance.body import ToothFrame, gear_nodes
from loaded_tca.compliance.flexibility import key_of
from loaded_tca.compliance.influence import gear_compliance
from loaded_tca.compliance.layout import MeshDensity, RingLayout
from loaded_tca.gears import CylindricalGear, CylindricalMesh, Rack
from loaded_tca.material import Material
from loaded_tca.pairs import rack_pair
from loaded_tca.pairs.gear import Gear
from loaded_tca.tooth.families import ToothForm
from loaded_tca.tooth.rack import Bed, RackTooth

COARSE = MeshDensity(through=2, flank=3, fillet=1, land=1, rim=3, lengthwise=1)


@dataclass(frozen=True)
class _WholeBed(Bed):
    """A bed below a whole ring."""

    def pitches_beyond(self, root: Array, held: Array, teeth: int) -> None:  # type: ignore[override] # noqa: ARG002
        return None


@dataclass(frozen=True)
class _WholeTooth(RackTooth):
    """Teeth on it."""

    def form(self) -> ToothForm:
        form = super().form()
        return replace(form, held=_WholeBed(self.bed_depth))


def test_piece_of_a_ring_bends_as_the_ring() -> None:
    """What lies further away than four depths of the bed carries nothing: 3e-5 at three, see ``REACH``."""
    pinion, wheel = (CylindricalGear(teeth=z, normal_module=3.0, face_width=10.0) for z in (20, 60))
    mesh = CylindricalMesh(pinion, wheel)
    tables = []
    for kind in (RackTooth, _WholeTooth):
        teeth = kind(wheel, mesh.wheel_working_radius, mesh.wheel_active_profile, bed_depth=6.0)
        tables.append(gear_compliance(Gear.of(teeth, 1, Material(), None), COARSE).table.displacement)
    assert np.abs(tables[0] - tables[1]).max() <= 3e-5 * np.abs(tables[1]).max()


def test_piece_has_no_elements_in_its_cut() -> None:
    """Three pitches on either side beyond the modelled neighbours: 9 pitches, the cut beside them."""
    layout = RingLayout(1000, COARSE, beyond=3)
    assert [sector.number for sector in layout.sectors] == [0, 1, 2, 3, 4, 5, -4, -3, -2, -1]
    cut = layout.sectors[5].first
    assert cut not in layout.elements[:, 0]
    assert len(layout.blocks) == len(layout.elements)


def test_thickness_below_the_teeth_makes_a_rack_softer() -> None:
    """And a rack of twice the module, and all lengths, bends as far: displacement per force goes with 1/length."""
    softness = []
    for module, height in ((3.0, 15.0), (3.0, 30.0), (6.0, 30.0)):
        pinion = CylindricalGear(teeth=20, normal_module=module, face_width=10.0 * module)
        rack = Rack(normal_module=module, face_width=10.0 * module, height=height)
        table = gear_compliance(rack_pair(pinion, rack).wheel, COARSE).table.displacement
        softness.append(float(table.max()))
    assert softness[1] > softness[0]
    assert softness[2] == pytest.approx(0.5 * softness[0], rel=1e-6)  # single roundings of the radius are 1e-9 of teeth


def test_kept_models_of_racks_differ_by_parts_of_their_teeth() -> None:
    """Not by parts of the radius of the gear that stands for a rack, 3e6 mm."""
    pinion = CylindricalGear(teeth=20, normal_module=3.0, face_width=20.0)
    keys = set()
    for addendum in (3.0, 3.0 + 2e-7):
        rack = Rack(normal_module=3.0, face_width=20.0, height=12.0, addendum=addendum)
        gear = rack_pair(pinion, rack).wheel
        keys.add(key_of(ToothFrame(gear, gear_nodes(gear, COARSE))))
    assert len(keys) == 2
