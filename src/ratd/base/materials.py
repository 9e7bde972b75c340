"""Materials of the monomers: constants of the bulk and of its surface, and means of several materials."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, fields

from ratd.base.checks import is_number
from ratd.base.errors import InputError
from ratd.base.units import GPA, MJ_PER_M2, NM, PS

__all__ = [
    "COMPOSITION",
    "CO_S_FRACTIONS",
    "MATERIALS",
    "Material",
    "element_ratios",
    "get_material",
    "mix",
    "sphere_mass",
]


PLAUSIBLE = {
    "surface_energy": (0.0, 10.0, "J/m2"),
    "youngs_modulus": (1e4, 1e13, "Pa"),
    "density": (10.0, 3e4, "kg/m3"),
    "viscous_time": (0.0, 1e-7, "s"),
}
"""Between which values a constant of a solid lies, and its unit: what lies outside was given in another one."""


def sphere_mass(radius, density):
    """Mass 4/3 pi rho a^3 [kg] of solid spheres of the radius a [m] and the density rho [kg m-3], broadcast."""
    return 4.0 / 3.0 * math.pi * density * radius**3


@dataclass(frozen=True)
class Material:
    """What a monomer is made of.

    Parameters
    ----------
    name : str
        Name, as in configuration files.
    surface_energy : float
        gamma [J m-2].
    youngs_modulus : float
        E [Pa].
    poisson_number : float
        nu [1], above 0 and at most 0.5 (the damping of Eq. 22 has it in the denominator).
    density : float
        rho [kg m-3] of the solid.
    critical_rolling_displacement : float
        xi_c [m].
    viscous_time : float
        T_vis [s] of the damping (2 E*/nu^2) r T_vis; 0 switches it off.

    Raises
    ------
    InputError
        If a value is not a finite number in its range.

    Notes
    -----
    The defaults are those of Reissl et al. 2024 (A&A 692, A60).
    """

    name: str
    surface_energy: float
    youngs_modulus: float
    poisson_number: float
    density: float
    critical_rolling_displacement: float = 0.2e-9
    viscous_time: float = 5e-12

    def __post_init__(self):
        if not isinstance(self.name, str) or not self.name:
            raise InputError(f"The name of a material is {self.name!r}; it must be a text of at least one character.")
        for field in fields(self):
            if field.name == "name":
                continue
            value = getattr(self, field.name)
            if field.name == "poisson_number":
                allowed, good = "above 0 and at most 0.5", lambda number: 0.0 < number <= 0.5
            elif field.name == "viscous_time":
                allowed, good = "a number of at least 0", lambda number: number >= 0.0
            else:
                allowed, good = "a number above 0", lambda number: number > 0.0
            if not (is_number(value) and good(value)):
                raise InputError(f"Material {self.name!r} has {field.name} = {value!r}; it must be {allowed}.")
            low, high, unit = PLAUSIBLE.get(field.name, (0.0, math.inf, ""))
            if not low <= value <= high:
                raise InputError(
                    f"Material {self.name!r} has {field.name} = {value!r}; it is in {unit}, and no solid has one below "
                    f"{low:g} or above {high:g}."
                )
            object.__setattr__(self, field.name, float(value))  # numbers of numpy would stand in hashes and files

    @property
    def reduced_modulus(self):
        """E* = E/(2(1 - nu^2)) [Pa] of two bodies of this material (Eq. 9)."""
        return self.youngs_modulus / (2.0 * (1.0 - self.poisson_number**2))

    @property
    def shear_modulus(self):
        """G = E/(2(1 + nu)) [Pa]."""
        return self.youngs_modulus / (2.0 * (1.0 + self.poisson_number))


COMPOSITION = {
    "forsterite": {"Mg": 2, "Si": 1, "O": 4},
    "fayalite": {"Fe": 2, "Si": 1, "O": 4},
    "enstatite": {"Mg": 1, "Si": 1, "O": 3},
    "ferrosilite": {"Fe": 1, "Si": 1, "O": 3},
}
"""Atoms of each element in one formula unit of the minerals of co-S."""

CO_S_FRACTIONS = {"forsterite": 0.31, "fayalite": 0.29, "enstatite": 0.20, "ferrosilite": 0.20}
"""Mole fractions of the minerals of co-S (Sect. 2)."""

MATERIALS = {
    material.name: material
    for material in (
        Material("a-C", 50 * MJ_PER_M2, 168 * GPA, 0.16, 2368.0),
        Material("q-S", 20 * MJ_PER_M2, 54 * GPA, 0.17, 2650.0),
        Material("forsterite", 70 * MJ_PER_M2, 204 * GPA, 0.24, 3213.0),
        Material("fayalite", 70 * MJ_PER_M2, 140 * GPA, 0.32, 4393.0),
        Material("enstatite", 70 * MJ_PER_M2, 180 * GPA, 0.21, 3209.0),
        Material("ferrosilite", 70 * MJ_PER_M2, 142 * GPA, 0.31, 4014.0),
        Material("ice", 100 * MJ_PER_M2, 7 * GPA, 0.25, 1000.0, 0.8 * NM, 0.146 * PS),
        Material("silicate", 20 * MJ_PER_M2, 54 * GPA, 0.17, 2650.0, 2.0 * NM, 0.597 * PS),
        Material("silica", 25 * MJ_PER_M2, 54 * GPA, 0.17, 2000.0, 0.1 * NM, 9.63 * PS),
    )
}
"""Materials by name.

a-C, q-S, co-S and the four minerals that co-S is mixed from: Table 2 of Reissl et al. 2024 (A&A 692, A60).

ice, silicate: Table 1 of Kataoka et al. 2013 (A&A 554, A4), meant for monomers of 0.1 and 0.6 um. Their damping is a
constant k_n m_0/t_0; T_vis is what makes the damping of equal monomers of that size the same at rest, k_n = 0.01.

silica: as used by Umstaetter & Urbassek 2020 (A&A 633, A24), recalled from other papers of the group, since they do not
print it; the rolling displacement is their xi_yield. Their damping K A sqrt(delta), the contact being of radius
sqrt(delta R), is (4/3) E* r A; T_vis = (2/3) nu^2 A is that of A = 0.5 ns.
"""


def mix(name, fractions, table=None):
    """Mean of materials by mole fraction.

    Parameters
    ----------
    name : str
        Name of the mixture.
    fractions : dict of str to float
        Mole fraction of each component; they add up to 1.
    table : dict of str to Material, optional
        Where the components are looked up; `MATERIALS` when not given.

    Returns
    -------
    Material
        Every property is the mean weighted with the fractions.

    Raises
    ------
    InputError
        If a fraction is negative, if they do not add up to 1, or if a component is unknown.

    Notes
    -----
    Sect. 2 and Table 2 of Reissl et al. 2024. The table prints co-S rounded (E 169 GPa, nu 0.27, rho 3707 kg m-3);
    the mean of its own four minerals is E 168.2 GPa, nu 0.271, rho 3715 kg m-3.
    """
    fractions = _checked_fractions(fractions, f"of the mixture {name!r}")
    parts = [(float(fraction), get_material(part, table)) for part, fraction in fractions.items()]
    means = {
        field.name: math.fsum(fraction * getattr(part, field.name) for fraction, part in parts)
        for field in fields(Material)
        if field.name != "name"
    }
    return Material(name, **means)


def element_ratios(fractions, composition=None):
    """Ratios of the numbers of atoms in a mixture of minerals (Table 1).

    Parameters
    ----------
    fractions : dict of str to float
        Mole fraction of each mineral; they add up to 1.
    composition : dict of str to dict, optional
        Atoms of each element in one formula unit; `COMPOSITION` when not given.

    Returns
    -------
    dict of str to float
        "Mg/O", "Si/O", "Fe/O", "Mg/Fe", "(Mg+Fe)/Si"; NaN or inf where an element is missing.

    Raises
    ------
    InputError
        If a fraction is negative, if they do not add up to 1, or if the composition of a mineral is unknown.
    """
    composition = COMPOSITION if composition is None else composition
    fractions = _checked_fractions(fractions, "of the minerals")
    for mineral in fractions:
        if mineral not in composition:
            raise InputError(f"The composition of {mineral!r} is unknown; known are {', '.join(composition)}.")

    def atoms(element):
        return math.fsum(part * composition[mineral].get(element, 0) for mineral, part in fractions.items())

    def ratio(above, below):
        if below == 0.0:
            return math.inf if above > 0.0 else math.nan
        return above / below

    mg, fe, si, o = (atoms(element) for element in ("Mg", "Fe", "Si", "O"))
    return {
        "Mg/O": ratio(mg, o),
        "Si/O": ratio(si, o),
        "Fe/O": ratio(fe, o),
        "Mg/Fe": ratio(mg, fe),
        "(Mg+Fe)/Si": ratio(mg + fe, si),
    }


def get_material(material, table=None):
    """Material of a name.

    Parameters
    ----------
    material : str or Material
        A name, or a material, which is returned as it is.
    table : dict of str to Material, optional
        Where the name is looked up; `MATERIALS` when not given.

    Returns
    -------
    Material

    Raises
    ------
    InputError
        If the name is unknown.
    """
    if isinstance(material, Material):
        return material
    table = MATERIALS if table is None else table
    if not isinstance(table, Mapping):
        raise InputError(f"table is of type {type(table).__name__}; it must be a dict, names and what they stand for.")
    if not isinstance(material, str) or material not in table:
        raise InputError(f"The material is {material!r}; allowed are {', '.join(table)}, or a ratd.Material.")
    return table[material]


def _checked_fractions(fractions, what):
    """Mole fractions as a dict of str to float."""
    try:
        fractions = dict(fractions)
    except (TypeError, ValueError):
        fractions = {}
    if not fractions or any(not (is_number(fraction) and fraction >= 0.0) for fraction in fractions.values()):
        raise InputError(
            f"The mole fractions {what} are {fractions}; they must be a dict, each a number of at least 0."
        )
    total = math.fsum(fractions.values())
    if abs(total - 1.0) > 1e-9:
        raise InputError(f"The mole fractions {what} add up to {total:g}; they must add up to 1.")
    return fractions


MATERIALS["co-S"] = mix("co-S", CO_S_FRACTIONS)
