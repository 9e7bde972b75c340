"""Contact laws: what two spheres do to each other.

A law is a NamedTuple marked by `ratd.base.parts.part`. Its fields are its options; its methods, compiled together with
the time loop, are (``at`` is where the fields of a contact begin, see `ratd.laws.contact_fields`):

n_fields()
    Number of fields of a contact: `COMMON` and those of the law, taken from `law_fields`.
vectors()
    Where the first components of the law's own vectors stand, which turn when an aggregate is turned as a whole.
idle(contact, at)
    Fill the law's own fields, all 0, such that a contact between two spheres at rest, 1 m apart, does nothing.
begin(contact, at, pair, mass_i, mass_j, normal, distance, spin_i, spin_j, back, at_rest)
    Fill the law's own fields of a new contact, and `NORMAL` and `STEP`; the energy [J] that it radiates by forming.
forces(contact, scratch, start, count, dt_drift, dt)
    Advance a block of contacts by the last move and leave its forces and torques in the scratch space; the number of
    contacts that have ended.
ended(contact, at)
    Whether a contact has ended.
energies(contact, at)
    Potential energies [J]: normal, sliding, rolling, twisting.
damping_coefficient(contact, at)
    Damping coefficient [kg/s] by which the implicit damping is weighted; for DMT over sqrt(overlap), [kg/(s m^0.5)].
damping_now(contact, at)
    Damping coefficient [kg/s] of the contact as it is.
contact_radius(contact, at)
    Radius of the contact area [m].
pointers(contact, at)
    Unit vectors, fixed in the monomers, from the contact to the centre of i, and from the centre of j to the contact.
stiffness(contact, at)
    k_n, k_s [N/m] and k_r, k_t [N m] of a contact, not below those of any state that it may reach in a step.

What a law does not have is an error when it is compiled: the semi-implicit step asks for `pointers`,
`stiffness` and `damping_now`, stresses for `contact_radius`. `tests/laws/test_own_law.py` adds a law in one file. A
contact begins when two surfaces touch.

jkr_with_springs         the law of Johnson, Kendall & Roberts with springs of limited displacement: `jkr`
dmt_with_friction        the law of Derjaguin, Muller & Toporov with friction of limited force: `dmt`
johnson_kendall_roberts  formulae of the normal contact of the first
derjaguin_muller_toporov formulae of the normal contact of the second
tangential               formulae of sliding, rolling and twisting of the first
material_pair            the constants of a contact between two materials
contact_constants        constants of an adhesive contact at rest
contact_fields           where each number of a contact stands
thermal                  how long a contact holds a pull against heat; no run uses it
"""

from importlib import import_module

# Loaded on first use: a run depends on the law that it uses, not on the others.
_HOME = {"jkr": "jkr_with_springs", "dmt": "dmt_with_friction"}
__all__ = sorted(_HOME)


def __getattr__(name):
    if name in _HOME:
        value = globals()[name] = getattr(import_module(f"ratd.laws.{_HOME[name]}"), name)
        return value
    raise AttributeError(f"module 'ratd.laws' has no attribute {name!r}")
