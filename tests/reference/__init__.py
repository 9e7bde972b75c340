"""Slow, plain reference for the mechanics of adhesive spheres with friction; nothing is imported from ratd.

`contact.py` holds the two contact laws (JKR of physics.md Sects. 3, 4 and compression.md Sect. 1; DMT of collision.md
Sect. 1) for one pair in scalars and 3-vectors, with constitutive and potential forms side by side. `system.py` holds
`run`, all pairs and a kick-drift-kick leapfrog, free or in a periodic cube that shrinks. `test_reference.py` tests
both against finite differences, conserved quantities and the numbers of the pages. Written from the pages alone;
meant for a few spheres and small steps. `growth.py` grows aggregates, and is its own. Usage:

    out = run(x, radius, v, spin, ICE, law=JKR(), dt=1e-12, steps=1000)
    out = run(..., law=DMT(viscous_time=0.5e-9, friction="spring"), box=Cube(length, rate), contacts=[(0, 1)])
    out["kinetic"], out["potential"]["rolling"], out["dissipated"]["sliding"], out["pressure"], out["residual"]
"""
