"""Common ropes: axial stiffness and mass per metre from construction and diameter, until both are measured.

EA = f pi d^2 / 4 E and mu = f pi d^2 / 4 gamma k: f is the share of the circle that carries load, E the modulus of the
rope referred to that material, gamma its density, and k the length of wire or fibre per length of rope.
"""

import math
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class RopeKind:
    """Construction of a rope.

    name : in words;  fill : f [-];  lay : k [-];  density : gamma [kg/m^3];  modulus : E [Pa]
    """

    name: str
    fill: float
    lay: float
    density: float
    modulus: float

    def section(self, diameter: float) -> float:
        """Load-carrying section [m^2] at a nominal diameter [m]."""
        return self.fill * math.pi / 4.0 * diameter**2

    def axial_stiffness(self, diameter: float) -> float:
        """EA [N]."""
        return self.section(diameter) * self.modulus

    def linear_density(self, diameter: float) -> float:
        """mu [kg/m]."""
        return self.section(diameter) * self.density * self.lay


ROPES = {
    "steel-6x19": RopeKind("steel 6x19, fibre core", 0.49, 1.08, 7850.0, 80e9),
    "steel-7x19": RopeKind("steel 7x19", 0.61, 1.06, 7850.0, 75e9),
    "steel-1x19": RopeKind("steel 1x19", 0.77, 1.03, 7850.0, 110e9),
    "dyneema": RopeKind("UHMWPE (Dyneema), braided", 0.65, 1.07, 970.0, 50e9),
    "aramid": RopeKind("aramid, braided", 0.65, 1.07, 1440.0, 40e9),
}
