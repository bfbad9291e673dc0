"""Edges of any angle: one image of the pressure against finite elements of a wedge; as a script, a table of factors.

A pressure cos(k x) along the edge leaves a plane problem with three displacements. Lengths scale with 1/k, so that one
solution, k = 1, holds every strip along the edge and, summed up over k, every strip across it. The half-space is solved
with the same elements beside the loaded face, so that errors of the mesh cancel in the difference.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import quad
from scipy.sparse.linalg import splu
from scipy.special import j1, k0
from skfem import Basis, BilinearForm, ElementQuad2, ElementVector, FacetBasis, LinearForm, MeshQuad
from skfem.models.elasticity import lame_parameters

from loaded_tca.contact import wedge_factor
from loaded_tca.contact.edges import extra_displacement
from loaded_tca.material import Material
from validation.table import Row

Array = NDArray[np.float64]
Load = Callable[[Array], Array]

POISSON_RATIO = 0.3
# Angles [deg], and how well the mean displacement is to be met there: nothing long lies along the sharp side of a
# tooth.
ANGLES = {75.0: 8e-2, 105.0: 5e-2, 120.0: 5e-2}
SOURCE = "finite elements of a wedge"
# Radii, over the length of a wave by 2 pi; ratio of one to the next; angles of the elements [rad].
NEAREST, FARTHEST, GROWTH = 5e-4, 25.0, 0.14
FLATTEST, EVEN, ANGLE_GROWTH = 0.015, 0.16, 1.4
# Up to here from the loaded face the mesh is the same for every angle.
SHARED = 0.4
# Half width of strips along the edge times the wave number; a quarter of a wave is half their length.
ALONG = (0.03, 0.1, 0.3)
# Lengths of strips across the edge times the wave number, and their length over their width.
ACROSS, SLENDERNESS = np.geomspace(0.02, 8.0, 12), 5.0
# Angle of a tip [deg]; distances of narrow loads from its edge times the wave number, and how well their tilt is to be
# met: the first is as good as plane strain; standard deviation of the logarithm of their places.
TIP, NARROW, BREADTH = 115.0, {1e-3: 1e-2, 2e-2: 1e-1}, 0.15


def touching(half_width: float) -> Load:
    """Hertz strip along the edge that ends at it."""
    return lambda y: np.sqrt(np.maximum(0.0, 1.0 - (y / half_width - 1.0) ** 2))


def even(length: float) -> Load:
    """Uniform pressure from the edge to a length."""
    return lambda y: (y < length).astype(float)


def radii_and_angles(angle: float, nearest: float = NEAREST) -> tuple[Array, Array]:
    """Logarithms of the radii, and angles of the lines of the mesh."""
    radii = np.linspace(np.log(nearest), np.log(FARTHEST), round(np.log(FARTHEST / nearest) / GROWTH))
    lines = [0.0, FLATTEST]
    while lines[-1] < SHARED:
        lines.append(lines[-1] + min(ANGLE_GROWTH * (lines[-1] - lines[-2]), EVEN))
    rest = np.linspace(lines[-1], angle, int(np.ceil((angle - lines[-1]) / EVEN)) + 1)
    return radii, np.concatenate((lines, rest[1:]))


@dataclass(frozen=True)
class Wedge:
    """Displacements of a loaded wedge, its face along y > 0, times E."""

    angle: float
    poisson_ratio: float
    nearest: float = NEAREST

    def energies(self, loads: list[Load]) -> Array:
        """Displacement weighted with the pressure, for each load."""
        logarithms, lines = radii_and_angles(self.angle, self.nearest)
        flat = MeshQuad.init_tensor(logarithms, lines)
        radius = np.exp(flat.p[0])
        mesh = MeshQuad(np.array([radius * np.cos(flat.p[1]), radius * np.sin(flat.p[1])]), flat.t)
        element = ElementVector(ElementQuad2(), 3)
        basis = Basis(mesh, element)
        loaded = mesh.facets_satisfying(lambda x: (np.abs(x[1]) < 1e-9 * np.abs(x[0])) & (x[0] > 0.0))
        face = FacetBasis(mesh, element, facets=loaded, intorder=12)
        held = basis.get_dofs(lambda x: np.hypot(x[0], x[1]) > (1.0 - 1e-6) * FARTHEST).all()
        free = basis.complement_dofs(held)
        stiffness = elasticity_of_waves(Material(1.0, self.poisson_ratio), 1.0).assemble(basis)
        inverse = splu(stiffness[free][:, free].tocsc())
        forces = [LinearForm(lambda v, w, load=load: load(w.x[0]) * v[2]).assemble(face)[free] for load in loads]
        return np.array([force @ inverse.solve(force) for force in forces])


def elasticity_of_waves(material: Material, wave: float) -> BilinearForm:
    """Energy of displacements (U sin kz, V cos kz, W cos kz) over a section, z the axis along which they go on.

    Parameters
    ----------
    material : Material
    wave : float [1/mm]
        k.
    """
    lame, shear = lame_parameters(material.youngs_modulus, material.poisson_ratio)

    def strains(u):  # type: ignore[no-untyped-def]
        slope = u.grad
        normal = (wave * u[0], slope[1, 0], slope[2, 1])
        return normal, (slope[2, 0] + slope[1, 1], slope[0, 0] - wave * u[1], slope[0, 1] - wave * u[2])

    @BilinearForm
    def energy(u, v, _):  # type: ignore[no-untyped-def]
        (normal, sheared), (virtual, virtually_sheared) = strains(u), strains(v)
        stretched = sum(a * b for a, b in zip(normal, virtual, strict=True))
        twisted = sum(a * b for a, b in zip(sheared, virtually_sheared, strict=True))
        return lame * sum(normal) * sum(virtual) + shear * (2.0 * stretched + twisted)

    return energy


def image_energy(load: Load, length: float) -> float:
    """Displacement (times E*) of a half-space by the image of a load within a length, weighted with the load."""
    nodes, weights = np.polynomial.legendre.leggauss(100)
    root = 0.5 * (1.0 + nodes)
    y, weights = length * root**2, length * root * weights
    loaded = weights * load(y)
    return float(loaded @ k0(y[:, None] + y) @ loaded) * 2.0 / np.pi


def even_energy(length: float) -> float:
    """Displacement (times E*) of a half-space by uniform pressure on a length, weighted with it."""
    return 4.0 / np.pi * quad(lambda apart: (length - apart) * k0(apart), 0.0, length)[0]


@dataclass(frozen=True)
class Comparison:
    """What a strip adds to its displacement at an edge, and what its plain image does; over that of a half-space."""

    load: str
    added: float
    image: float

    @property
    def factor(self) -> float:
        """The factor of the image that would be right."""
        return self.added / self.image


def compared(angle: float, poisson_ratio: float, half_space: Array | None = None) -> list[Comparison]:
    """Strips along the edge and across it, at a wedge of an angle [rad]; ``half_space``: its energies, if known."""
    loads = strips()
    flat = half_space_energies(poisson_ratio) if half_space is None else half_space
    plane_modulus = 1.0 / (1.0 - poisson_ratio**2)
    added = plane_modulus * (Wedge(angle, poisson_ratio).energies(loads) - flat)
    found = []
    for k, half_width in enumerate(ALONG):
        own, image = plane_modulus * flat[k], image_energy(loads[k], 2.0 * half_width)
        slenderness = 0.5 * np.pi / half_width
        found.append(Comparison(f"strip {slenderness:.0f} x 1 along the edge", added[k] / own, image / own))
    images = np.array([image_energy(load, length) for load, length in zip(loads[len(ALONG) :], ACROSS, strict=True)])
    owns = np.array([even_energy(length) for length in ACROSS])
    own, more, image = (_across(values) for values in (owns, added[len(ALONG) :], images))
    return [*found, Comparison(f"strip {SLENDERNESS:.0f} x 1 across the edge", more / own, image / own)]


def strips() -> list[Load]:
    """Loads of every comparison."""
    return [touching(half_width) for half_width in ALONG] + [even(length) for length in ACROSS]


def half_space_energies(poisson_ratio: float) -> Array:
    """Energies of the strips on a half-space, on the same mesh."""
    return Wedge(np.pi, poisson_ratio).energies(strips())


def _across(energies: Array) -> float:
    """Sum over the waves that make up a strip of length 1 across the edge, its pressure a half ellipse in width."""
    waves = np.geomspace(ACROSS[0], 60.0 * SLENDERNESS, 600)
    width = waves * 0.5 / SLENDERNESS
    growth = np.interp(np.log(waves), np.log(ACROSS), energies / ACROSS) * waves
    beyond = waves > ACROSS[-1]
    slope = (energies[-1] - energies[-2]) / (ACROSS[-1] - ACROSS[-2])
    growth[beyond] = energies[-1] + slope * (waves[beyond] - ACROSS[-1])
    return float(np.sum((j1(width) / width) ** 2 * growth / waves))


def short_rows() -> list[Row]:
    """Displacements at the middle one of the angles."""
    return displacements({105.0: ANGLES[105.0]})


def rows() -> list[Row]:
    """Displacements at all angles, and turns of the face."""
    return displacements(ANGLES) + tilts()


def displacements(angles: Mapping[float, float]) -> list[Row]:
    """Displacement weighted with the pressure, over that of a half-space: with the factor, and of the half-space.

    Angles [deg] with the tolerance of each.
    """
    flat, table = half_space_energies(POISSON_RATIO), []
    for degrees, tolerance in angles.items():
        factor = wedge_factor(np.radians(degrees), POISSON_RATIO)
        for strip in compared(np.radians(degrees), POISSON_RATIO, flat):
            case = f"free edge of {degrees:.0f} deg, {strip.load}"
            exact = 1.0 + strip.added
            table += [
                Row(case, SOURCE, f"displacement, factor {factor:.3f}", exact, 1.0 + factor * strip.image, tolerance),
                Row(case, SOURCE, "displacement, half-space", exact, 1.0, None),
            ]
    return table


def tilts() -> list[Row]:
    """Turn of the face about a narrow load, from half to twice its distance, beyond that of a half-space."""
    angle, table = float(np.radians(TIP)), []
    factor, added = extra_displacement(angle), turned(angle) - turned(np.pi)
    for distance, turn in zip(NARROW, added / (1.0 - POISSON_RATIO**2), strict=True):
        image = 2.0 / np.pi * factor * float(k0(1.5 * distance) - k0(3.0 * distance))
        case = f"free edge of {TIP:.0f} deg, a narrow strip along it at k s = {distance:g}"
        what = "displacement from half to twice its distance, image of plane strain"
        table.append(Row(case, SOURCE, what, float(turn), image, NARROW[distance]))
    return table


def turned(angle: float) -> Array:
    """Displacement at half the distance less that at twice, times E, by unit narrow loads at each distance."""

    def narrow(place: float) -> Load:  # of the total 1; smooth, since the elements sample it
        return lambda y: np.exp(-0.5 * (np.log(y / place) / BREADTH) ** 2) / (np.sqrt(2.0 * np.pi) * BREADTH * y)

    loads: list[Load] = []
    for distance in NARROW:
        own, near, far = (narrow(part * distance) for part in (1.0, 0.5, 2.0))
        loads += [near, far, lambda y, a=own, b=near: a(y) + b(y), lambda y, a=own, b=far: a(y) + b(y)]
    near, far, both_near, both_far = Wedge(angle, POISSON_RATIO, 2e-2 * min(NARROW)).energies(loads).reshape(-1, 4).T
    return np.asarray(0.5 * ((both_near - near) - (both_far - far)))


def main() -> None:
    """Print the factors that would be right beside that of the formula."""
    for nu in (0.0, 0.3, 0.45):
        flat = half_space_energies(nu)
        for degrees in (30.0, 45.0, 60.0, 75.0, 90.0, 105.0, 115.0, 120.0, 135.0, 150.0):
            found = compared(np.radians(degrees), nu, flat)
            factors = ", ".join(f"{strip.load} {strip.factor:.3f}" for strip in found)
            print(f"nu {nu:g}, {degrees:g} deg: formula {wedge_factor(np.radians(degrees), nu):.3f}; {factors}")


if __name__ == "__main__":
    main()
