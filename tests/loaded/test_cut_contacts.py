"""Contacts that end at faces and tips: deformation and stiffness do not jump with the grid, nor with the load."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca import trace_contact
from loaded_tca.flanks import FlankModifications
from loaded_tca.loaded.tooth_contact import GridChoice, solve_under_load
from loaded_tca.pairs.cylindrical import Mounting
from tests.samples.gear_pairs import gear_pair
from tests.samples.tangents import stiffness

SCATTER = 1e-3
GRIDS = (24, 28, 32, 40, 48, 64)
PAIRS = {
    "one end of the face": lambda: gear_pair(
        FlankModifications(lead_crowning=0.003), mounting=Mounting(out_of_plane=1e-4), teeth=(25, 37), width=20.0
    ),
    "tips and faces": lambda: gear_pair(teeth=(23, 81), width=30.0, helix_deg=20.0),
}
CASES = [("one end of the face", 0.0, 9e3), ("tips and faces", 0.3, 4e3), ("tips and faces", -0.2, 3e3)]


def solved(pair, turn, load, cells):
    contact = trace_contact(pair, [turn * pair.pitch])[0]
    return solve_under_load(pair, contact, load, GridChoice(cells=(cells, cells), tolerance=1e-7))


@pytest.mark.quick_cases(every=3)
@pytest.mark.parametrize(("name", "turn", "load"), CASES)
def test_contact_deformation_converges_without_scatter(name, turn, load):
    """Of first order in the cells, as the pressure at an end is singular: a straight line over their width."""
    pair = PAIRS[name]()
    contacts = [solved(pair, turn, load, cells) for cells in GRIDS]
    widths = np.array([contact.separation.spacing[1] for contact in contacts])
    found = np.array([contact.contact_deformation for contact in contacts])
    assert_allclose(found, np.polyval(np.polyfit(widths, found, 1), widths), rtol=SCATTER)


@pytest.mark.quick_cases("one end of the face-0.0-9000.0")
@pytest.mark.parametrize(("name", "turn", "load"), CASES)
def test_contact_deformation_grows_smoothly_with_the_load(name, turn, load):
    pair, over = PAIRS[name](), np.linspace(0.96, 1.04, 9)
    found = np.array([solved(pair, turn, load * part, 32).contact_deformation for part in over])
    smooth = np.polyval(np.polyfit(over - 1.0, found, 2), over - 1.0)
    assert_allclose(found, smooth, rtol=SCATTER)
    expected = load / np.gradient(smooth, over)
    assert_allclose([stiffness(solved(pair, turn, load, 32))], expected[4:5], rtol=2e-2)  # slope of nine values


def test_length_at_an_edge_is_that_of_the_material():
    pair = PAIRS["one end of the face"]()
    for cells in GRIDS:
        assert_allclose(solved(pair, 0.0, 9e3, cells).extent[1], 20.0, rtol=1e-3)
