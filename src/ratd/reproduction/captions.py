"""Captions of the figures of the document that the paper does not have; those of the paper stand in workflow/report."""

from ratd.reproduction.figures import LEAST

CAPTIONS = {
    "overview": (
        "The result in one picture: angular velocities over those of the paper for the same grain (Eq. 33 with A and "
        "alpha as printed in Table 3), against size, a panel a type. Circles and squares: omega_disr of the grains "
        "that the drives prescribed and literal spun up; open triangles: the firm bound of all grown grains, above "
        "which their contacts cannot hold them as they stand. Each is a median over all materials, which have the same "
        "weight; bars hold the middle two thirds of the grains, and say little where these are few (Which grains). The "
        "dashed line is the paper.\n\n"
        "What to see: how far circles and triangles lie below the line, most of all for large BA grains, and that the "
        "squares lie about it and rise: the one free number of their drive, which sets their level, was fixed on one "
        "cell of the paper. Circles of BA above the triangles belong to remnants, which hold more than the whole grain."
    ),
    "bound": (
        "Angular velocities over the cut bound of the same grain, against size, a panel a type. Diamonds: Eq. 33 "
        "with A and alpha as printed in Table 3; triangles upside down: where the mean tension at the mid-plane is the "
        "tensile strength of Tatsuuma et al. (2019); open triangles: the firm bound; all of these are those of all "
        "grown grains. Circles and squares: omega_disr of the grains that the drives prescribed and literal spun up. "
        "Each is a median over all materials, which have the same weight; bars hold the middle two thirds of the "
        "grains. The dashed line is the cut bound itself.\n\n"
        "What to see: which points keep below the firm bound, above which the contacts cannot hold the grain as it "
        "stands, which lie far above it, and how their distance grows with size. Circles of BA above it belong to "
        "remnants, which hold more than the whole grain."
    ),
    "lammps": (
        "Top left: the normal force of two spheres that are drawn apart, over the pull-off force F_C, against their "
        "compression over that in equilibrium. The line is ratd, for one pair, as all pairs lie on it; the dots are "
        "LAMMPS, for all pairs. Other panels: the omega at which a grain parts in LAMMPS against that of the same "
        "grain in ratd. It is set into rigid rotation at once and is free from then on, with LAMMPS in the inertial "
        "frame or in one that turns with the grain, which is the same motion in other coordinates; or it is driven "
        "up by an outer torque. Shape and colour tell the type. Open markers: first loss of mass; small filled "
        "ones: loss of a quarter of the mass. Each omega lies between two that were tried, to which the bars reach "
        "where they are longer than the marker. Line: equal in both codes; grey band: as near to it as the legend "
        "says.\n\n"
        "What to see: whether the markers keep to the line, so that two independent codes agree on what a grain "
        "holds. The dots end before the line does: a contact of LAMMPS ends at the greatest pull."
    ),
    "literal": (
        "The drive literal with two forms of its Coriolis term. A marker is a run; shape and colour tell the type, the "
        "face the size. Left, the Coriolis term at the velocity half a step before: the omega at which a quarter of "
        "the mass is lost over q = (d omega/dt / dt)^(1/3), against q over the omega of the same mark in the "
        "consistent model. Solid lines: what a solid grain gives, one for each grain, in the colour of its type. The "
        "dotted line is the median of the markers: all would lie on it if omega were proportional to q, with the "
        "exponent 1/3 of d omega/dt. Right, the exact Coriolis term: where a grain turns fastest before it loses mass, "
        "how fast its spins would turn it if it had kept its shape, over the omega of the first loss in the consistent "
        "model, against the factor by which its moment of inertia has grown. On the dashed line it turns as fast as "
        "in the consistent model.\n\n"
        "What to see: on the left, that the markers follow the lines of the solid grains, down to the right, and "
        "not the dotted one; on the right, that the markers rise with the dashed line: grains that stretch, BA most "
        "of all, need more omega."
    ),
    "calibration": (
        "Where the mass of grains of the cell of Fig. 4 starts to fall with the drive literal, against d omega/dt "
        "at the printed step: open circles mark the first loss of mass, squares the loss of 1 %, triangles that of "
        "25 %. A run with another step factor f than the printed one stands where d omega/dt over the step is the "
        "same. Runs with one d omega/dt stand side by side, grain by grain, about a vertical line, where they all "
        "belong. The solid line is a power law with one exponent, fitted to the squares; the dashed line is the onset "
        "of mass loss in Fig. 4 of the paper. Where they meet stands the diamond, the calibrated d omega/dt, with the "
        "bar of its standard error.\n\n"
        "What to see: that the onset rises with d omega/dt, how nearly runs of one grain with two steps lie at the "
        "same height, and whether the diamond lies between the vertical lines; outside it is extrapolated."
    ),
    "formulae": (
        "The same grains spun up with one formula at a time as it is printed, named on the left, the rest being the "
        "consistent model: omega_disr (left) and the omega of the loss of a quarter of the mass (right), over those "
        "of the same grain in the consistent model. A row a size. Markers are medians over the grains of a type, "
        "diamonds those over all grains; bars are their standard errors, and where none is seen it is shorter than the "
        "marker. The vertical line is 1, no change.\n\n"
        "What to see: which markers leave the line by more than their bars, and by how much. Other sizes were not "
        "tried."
    ),
    "fragments": (
        "Fragments that leave the largest one, by their mass over that of the grain: the share that lies in "
        "fragments up to this mass. Thick lines with filled markers: share of the lost mass; thin dashed ones with "
        "open markers: share of the number of fragments. The markers tell the types apart and stand at even "
        "distances along the lines. A row a stage of the spin-up, a column a drive; all cells have the same weight. "
        f"The axis leaves out the smallest fragments, {100 * LEAST:g} % of all.\n\n"
        "What to see: where the thick lines rise, the size of the pieces that carry the mass away, and how far the "
        "thin ones lie to their left: in BAM small fragments are many and hold little of the mass, in BA pieces of a "
        "tenth of the grain and more make up most of both. In the smallest grains one monomer is a tenth of the mass."
    ),
}
"""Name of a figure -> what is drawn, and what to see; two paragraphs."""
