"""The plan of the compression: a checked config, the settings of each job, and the runs that the figures need."""

from dataclasses import asdict, replace
from functools import partial

from ratd.aggregates.clusters import MONOMER_RADIUS
from ratd.base.errors import InputError
from ratd.base.units import NM
from ratd.pipeline import config as configs

__all__ = ["FIGURES", "Plan", "check", "load"]

TITLES = {
    "figure3": "one cluster among its copies",
    "figure4": "pressure against filling factor",
    "figure5": "strain rates",
    "figure6": "numbers of monomers",
    "figure7": "normal damping",
    "figure8": "where the energy goes",
    "figure9": "rolling displacements",
    "figure10": "where the energy goes, by rolling displacement",
    "figure11": "monomers near a monomer",
    "figure12": "pressure of silicate",
    "figure13": "silicate beside other work",
    "looser": "loose clusters at some strain rates",
    "isotropy": "pressure along the three axes",
    "high_density": "high filling factors",
    "tension": "tensile strength",
    "monomers": "unequal monomers",
    "fewer_steps": "the semi-implicit step beside the explicit one",
}
"""Figure -> what it shows, in the list of the report."""
FIGURES = tuple(TITLES)
CLUSTER = "<results>/clusters/{set}/seed_{seed}.nc"
RUN = "<results>/compression/{set}/seed_{seed}.nc"
TABLE = "<results>/compression/{set}.nc"
SNAPSHOTS = "<results>/compression/snapshots.nc"
SNAPSHOTS_NAME = "snapshots"
"""A set of this name would have the same table as the snapshots of figure 3."""
PRESSED = "<results>/pressed/{set}/phi_{phi}_seed_{seed}.nc"
PULL = "<results>/tension/{pull}/phi_{phi}_seed_{seed}.nc"


def load(*paths, schemas="config/schema"):
    """Plan of some config files, each of which stands over those before it; see `check`."""
    return check(configs.load(*paths), schemas)


def check(config, schemas="config/schema"):
    """Check a config as a whole.

    Parameters
    ----------
    config : dict
        The merged config.
    schemas : path-like, optional
        Folder of the JSON schemas.

    Returns
    -------
    Plan

    Raises
    ------
    InputError
        One sentence for each key that is wrong, with what is allowed.
    """
    shared, own, materials = configs.section(config, "compression", schemas)
    plan = Plan(own, materials, shared["results"])
    configs.together(
        *(partial(_check_names, plan, name) for name in plan.figures),
        partial(_check_further, plan),
        partial(_check_names_of_sets, plan),
    )
    configs.together(*(partial(_check_set, plan, name) for name in plan.sets))
    if "figure3" in plan.figures:
        _check_figure3(plan)
    return plan


def _check_names(plan, figure):
    """Raise InputError unless there are the sets and pulls that a figure names."""
    where = f"config: compression.figures.{figure} names the"
    for pull in plan.config["figures"][figure].get("pulls", ()):
        if pull not in plan.config["pulls"]:
            raise InputError(f"{where} pull {pull!r}; allowed: {', '.join(plan.config['pulls'])}")
    for wanted in plan.sets_of(figure):
        if wanted not in plan.config["sets"]:
            raise InputError(f"{where} set {wanted!r}; allowed: {', '.join(plan.config['sets'])}")


def _check_figure3(plan):
    """Raise InputError unless the run of figure 3 keeps positions at the filling factors that it shows."""
    own = plan.config["figures"]["figure3"]
    of_set = plan.of_set(own["set"])
    kept, end = of_set["snapshots"], of_set["until_phi"]
    unknown = [phi for phi in own["phi"] if phi not in kept]
    if unknown or min(own["phi"]) > end:
        raise InputError(
            f"config: compression.figures.figure3.phi has {(unknown or own['phi'])[0]:g}; allowed: the snapshots "
            f"of the set {own['set']}, {', '.join(f'{phi:g}' for phi in kept)}, one at least up to its end, {end:g}"
        )


def _check_further(plan):
    """Raise InputError unless there are the sets of `further_sets`."""
    for wanted in plan.config["further_sets"]:
        if wanted not in plan.config["sets"]:
            raise InputError(
                f"config: compression.further_sets names the set {wanted!r}; allowed: {', '.join(plan.config['sets'])}"
            )


def _check_names_of_sets(plan):
    """Raise InputError where the table of a set would have the name of another file."""
    if SNAPSHOTS_NAME in plan.config["sets"]:
        raise InputError(f"config: compression.sets has {SNAPSHOTS_NAME!r}; allowed: another name, which no file has")


def _check_set(plan, name):
    """Raise InputError unless the clusters of a set can be grown."""
    material = plan.of_set(name)["material"]
    if material not in plan.materials:
        allowed = ", ".join(plan.materials)
        raise InputError(f"config: compression.sets.{name}.material is {material!r}; allowed: {allowed}")
    plan.grow(name)


class Plan:
    """A checked config, and what follows from it.

    Parameters
    ----------
    config : dict
        The checked keys of the compression.
    materials : dict of str to Material
    results : str
        Folder of all results.
    """

    def __init__(self, config, materials, results):
        self.config = config
        self.materials = materials
        self.results = results

    @property
    def figures(self):
        """Names of the figures to draw, list of str."""
        return [name for name, own in self.config["figures"].items() if own is not None]

    @property
    def sets(self):
        """Names of the sets that the figures need, and of those that have a table alone, list of str."""
        of_figures = [wanted for name in self.figures for wanted in self.sets_of(name)]
        return list(dict.fromkeys((*of_figures, *self.config["further_sets"])))

    def sets_of(self, figure):
        """Names of the sets of which a figure is drawn, or whose clusters are pulled for it."""
        own = self.config["figures"][figure]
        if "pulls" in own:
            return [self.config["pulls"][pull]["set"] for pull in own["pulls"]]
        return [own["set"]] if "set" in own else list(own["sets"])

    def of_set(self, name):
        """Keys of a set, with what all sets share."""
        return configs.merge(self.config["all_sets"], self.config["sets"][name] or {})

    def seeds(self, name):
        """Seeds of a set, list of int."""
        own = self.of_set(name)["seeds"]
        return list(range(own["first"], own["first"] + own["number"]))

    def material(self, name):
        """Material of a set, its rolling displacement changed where the set says so."""
        own = self.of_set(name)
        material = self.materials[own["material"]]
        if own["xi_c_nm"] is not None:
            material = replace(material, critical_rolling_displacement=own["xi_c_nm"] * NM)
        return material

    def grow(self, name):
        """Settings of the growth of the clusters of a set."""
        own = self.of_set(name)
        radii = own["radii"]
        radius = own["radius_nm"]
        if radii is None and radius is None and own["material"] not in MONOMER_RADIUS:
            raise InputError(
                f"config: compression.sets.{name}.radius_nm is null; allowed: a number above 0, or null for "
                f"{', '.join(MONOMER_RADIUS)}"
            )
        if radii is not None:
            lengths = {key.removesuffix("_nm"): value * NM for key, value in radii.items() if key.endswith("_nm")}
            radii = {key: value for key, value in radii.items() if not key.endswith("_nm")} | lengths
        return {
            "material": asdict(self.material(name)),
            "n": own["n"],
            "radius": None if radius is None else radius * NM,
            "radii": radii,
            "copies": own["copies"],
        }

    def compress(self, name):
        """Settings of the compression of a set."""
        own = self.of_set(name)
        names = ("strain_rate", "k_n", "until_phi", "timestep_factor", "long_steps", "scheme", "snapshots")
        return {key: own[key] for key in names}

    def work(self, name):
        """A measure of the time that a run of a set takes: monomers over strain rate and step."""
        own = self.of_set(name)
        return own["n"] / (own["strain_rate"] * own["timestep_factor"])

    def press(self, name):
        """Settings of the compression of clusters of a set that are pulled then; the job knows the filling factor."""
        return {key: value for key, value in self.compress(name).items() if key not in ("until_phi", "snapshots")}

    def stretch(self, pull):
        """Settings of a pull, with what it shares with the compression before it."""
        own = self.config["pulls"][pull]
        before = self.compress(own["set"])
        shared = {key: before[key] for key in ("k_n", "timestep_factor")}
        return shared | {"pull": {key: own[key] for key in ("strain_rate", "axes", "unload")}}

    def files(self, path, name):
        """Files of all seeds of a set."""
        return [path.format(set=name, seed=seed) for seed in self.seeds(name)]

    def pull_files(self, pull):
        """Files of a pull."""
        own = self.config["pulls"][pull]
        seeds = self.seeds(own["set"])[: own["number"]]
        return [PULL.format(pull=pull, phi=f"{phi:g}", seed=seed) for phi in own["phi"] for seed in seeds]

    def figure_input(self, name):
        """Files that a figure is drawn from, dict of str to list of str."""
        own = self.config["figures"][name]
        if "pulls" in own:
            return {"pulls": [path for pull in own["pulls"] for path in self.pull_files(pull)]}
        if name == "figure3":
            return {"snapshots": [SNAPSHOTS]}
        return {"sets": [TABLE.format(set=wanted) for wanted in self.sets_of(name)]}

    def snapshots(self):
        """Run and settings of the snapshots of figure 3."""
        own = self.config["figures"]["figure3"]
        return RUN.format(set=own["set"], seed=own["seed"]), {"phi": own["phi"]}

    @property
    def tables(self):
        """Files of all tables, list of str."""
        files = [path for name in self.figures for paths in self.figure_input(name).values() for path in paths]
        files += [TABLE.format(set=wanted) for wanted in self.config["further_sets"]]
        return list(dict.fromkeys(files))
