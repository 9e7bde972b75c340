"""The springs of ratd with the limits of LAMMPS: what is added to the law, and that nothing else is."""

import numpy as np
import pytest

import ratd
from ratd.laws.contact_fields import COMMON, E_TWIST, LANES, N_SCRATCH, NCX, NORMAL, TIX, TJX, WIX
from ratd.laws.jkr_as_in_lammps import ANGLE, N_MORE, STIFFNESS, _twist, jkr_as_in_lammps
from ratd.laws.jkr_with_springs import N_OWN, PULL_OFF, jkr
from ratd.laws.tangential import TWISTING_LIMIT


def test_without_its_limits_it_is_the_law_of_ratd():
    cluster = ratd.grow_bcca(32, material="ice", seed=1)
    how = {"strain_rate": 1e-4, "until_phi": 0.09, "long_steps": None, "snapshots": ()}
    law = jkr_as_in_lammps(follows_load=False, sign_of_rate=False)
    own, other = (ratd.compress(cluster, law=each, **how) for each in (jkr(), law))
    # twisting is integrated along another mean direction
    scale = np.abs(own["pressure"]).max().item()
    np.testing.assert_allclose(other["pressure"], own["pressure"], atol=0.01 * scale)
    assert own["dissipated_rolling"][-1] == pytest.approx(other["dissipated_rolling"][-1].item(), rel=0.01)


@pytest.mark.parametrize(
    ("sign_of_rate", "pulled", "kept"), [(True, True, -0.75), (False, True, 0.75), (True, False, 0.99)]
)
def test_a_torque_beyond_its_limit_keeps_its_sign_or_takes_that_of_the_rate(sign_of_rate, pulled, kept):
    """A contact that holds 0.99 of its limit at equilibrium, pulled with half of F_C or not, while it twists back."""
    contact, scratch = np.zeros((COMMON + N_OWN + N_MORE) * LANES), np.zeros(N_SCRATCH * LANES)
    contact[PULL_OFF], contact[NORMAL] = 2.0, -1.0 if pulled else 0.0
    contact[NCX], contact[STIFFNESS], contact[ANGLE] = 1.0, 3.0, 0.99 * TWISTING_LIMIT
    scratch[WIX] = -1e-9
    _twist(contact, scratch, np.uint64(0), np.uint64(0), 1.0, True, sign_of_rate)
    assert contact[ANGLE] == pytest.approx(kept * TWISTING_LIMIT)
    assert scratch[TIX] == pytest.approx(-3.0 * contact[ANGLE]) and scratch[TJX] == -scratch[TIX]
    stored = 1.5 * TWISTING_LIMIT**2
    assert contact[E_TWIST] == pytest.approx((0.99**2 - kept**2) * stored, rel=1e-4, abs=1e-6 * stored)
