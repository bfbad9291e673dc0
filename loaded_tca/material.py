"""Elastic materials and the contact modulus of two of them."""

from dataclasses import dataclass

from loaded_tca.arrays import real
from loaded_tca.errors import require
from loaded_tca.plain import plain

SOFTEST = 1e-3
"""Smallest Young's modulus [MPa], that of gels: contacts of softer bodies outgrow every flank."""
LARGEST_RATIO_IN_BENDING = 0.49
"""Largest Poisson's ratio of teeth that bend: nearer to 0.5 finite elements of displacements lock."""


@dataclass(frozen=True)
class Material:
    """Isotropic, linearly elastic material, with an optional cap on the pressure it carries.

    Parameters
    ----------
    youngs_modulus : float [MPa]
        Young's modulus, 0.001 MPa at least. Default: steel.
    poisson_ratio : float
        Between 0 and 0.5; up to 0.49 where teeth bend.
    max_pressure : float [MPa], optional
        Pressure at which the surface yields (elastic-perfectly plastic cap); None: elastic.
    conductivity : float [W/(m K)]
        Of heat. Default, as of the next two: steel.
    density : float [kg/m3]
    heat_capacity : float [J/(kg K)]

    Raises
    ------
    InputError
        If a value is outside its range.
    """

    youngs_modulus: float = 206000.0
    poisson_ratio: float = 0.3
    max_pressure: float | None = None
    conductivity: float = 50.0
    density: float = 7850.0
    heat_capacity: float = 484.0

    def __post_init__(self) -> None:
        modulus, ratio, cap = self.youngs_modulus, self.poisson_ratio, self.max_pressure
        thermal = {"conductivity": "W/(m K)", "density": "kg/m3", "heat_capacity": "J/(kg K)"}
        finite = SOFTEST <= real(modulus) < float("inf")
        require(
            (finite, f"youngs_modulus: {modulus} MPa is not finite and at least {plain(SOFTEST, 6)} MPa"),
            (0.0 <= real(ratio) <= 0.5, f"poisson_ratio: {ratio} is not between 0 and 0.5"),
            (cap is None or real(cap) > 0.0, f"max_pressure: {cap} MPa is not positive"),
            *(
                (
                    0.0 < real(getattr(self, name)) < float("inf"),
                    f"{name}: {getattr(self, name)} {unit} is not positive",
                )
                for name, unit in thermal.items()
            ),
        )

    @property
    def plane_strain_modulus(self) -> float:
        """E/(1 - nu^2) [MPa]."""
        return self.youngs_modulus / (1.0 - self.poisson_ratio**2)

    @property
    def thermal_contact_coefficient(self) -> float:
        """B_M, the root of conductivity, density and heat capacity [J/(m2 K s^0.5)]: what heat a moving source meets.

        Examples
        --------
        >>> round(Material().thermal_contact_coefficient)
        13783
        """
        return (self.conductivity * self.density * self.heat_capacity) ** 0.5


def contact_modulus(first: Material, second: Material) -> float:
    r"""Contact modulus E* of two half-spaces [MPa].

    .. math:: 1/E^* = (1 - \nu_1^2)/E_1 + (1 - \nu_2^2)/E_2

    References
    ----------
    Johnson 1985, Contact Mechanics, eq. 4.10.

    Examples
    --------
    >>> steel = Material(206000.0, 0.3)
    >>> round(contact_modulus(steel, steel), 1)
    113186.8
    """
    return 1.0 / (1.0 / first.plane_strain_modulus + 1.0 / second.plane_strain_modulus)
