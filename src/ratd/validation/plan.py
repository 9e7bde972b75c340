"""Which independent pieces each check is computed in: one job a piece."""

from itertools import product

from ratd.base.errors import InputError
from ratd.base.units import NM
from ratd.pipeline.config import read_yaml
from ratd.validation import peer_lammps

EXTENTS = ("full", "quick")


class Checks:
    """What `config/validation.yaml` asks for.

    Parameters
    ----------
    path : path-like

    Attributes
    ----------
    config : dict
        As read.
    pieces : dict
        extent -> check -> name of a piece -> its settings, in SI units.

    Raises
    ------
    InputError
        If a key is missing, a check unknown, or a value of another kind than in the file that comes with ratd.
    """

    def __init__(self, path):
        self.config = read_yaml(path)
        try:
            self.results = self.config["results"]
            self.pieces = {
                extent: {check: self._pieces(check, own) for check, own in self.config[extent].items()}
                for extent in EXTENTS
            }
        except KeyError as error:
            raise InputError(f"{path}: the key {error} is missing or not known; see config/validation.yaml") from None
        except (TypeError, AttributeError) as error:
            raise InputError(
                f"{path}: a value is of the wrong kind ({error}); allowed: lists, mappings and numbers where "
                "config/validation.yaml as it comes with ratd has them"
            ) from None

    def files(self, extent, check):
        """Files of all pieces of a check.

        Raises
        ------
        InputError
            If the program that the check is against is missing: it is asked for before any job starts.
        """
        if check in ("lammps", "compression", "dense", "box_at_rest"):
            peer_lammps.load()
        return [f"{self.results}/{extent}/{check}/{piece}.nc" for piece in self.pieces[extent][check]]

    @property
    def names(self):
        """Names of all checks, list of str."""
        return list(dict.fromkeys(check for pieces in self.pieces.values() for check in pieces))

    def tables(self, extent):
        """Tables of all checks of an extent, list of str. Errors as of `files`."""
        for check in self.pieces[extent]:
            self.files(extent, check)
        return [f"{self.results}/{extent}/{check}.csv" for check in self.pieces[extent]]

    def _pieces(self, check, own):
        return {
            "quasi_static": self._quasi_static,
            "remnant": self._remnant,
            "pull_off": self._pull_off,
            "damping": self._damping,
            "literal": self._literal,
            "theory": self._each_type_and_size,
            "mark_rules": self._each_type_and_size,
            "growth": self._growth,
            "relaxation": self._relaxation,
            "energy": self._energy,
            "energy_step": self._free_grain,
            "collision_step": self._collision_step,
            "frames": self._free_grain,
            "forces": self._forces,
            "compression": self._of_cluster,
            "dense": self._of_cluster,
            "box_at_rest": self._of_cluster,
            "spring_back": self._spring_back,
            "lammps": self._lammps,
        }[check](own)

    def _quasi_static(self, own):
        pieces = {}
        for group in own:
            shared = {
                key: value
                for key, value in group.items()
                if key not in ("materials", "types", "sizes_nm", "first", "seeds")
            }
            for material, kind, size in product(group["materials"], group["types"], group["sizes_nm"]):
                first = group.get("first", 0)
                for seed in range(first, first + group["seeds"]):
                    name = f"{group['name']}_{material}_{kind}_{size}nm_{seed}"
                    pieces[name] = shared | {"material": material, "type": kind, "a_eff": size * NM, "seed": seed}
        return pieces

    def _remnant(self, own):
        return _each_grain(own["grains"], {key: own[key] for key in ("material", "drag", "every", "mass_left")})

    def _production(self, kind):
        """epsilon and timestep_factor of a type in the pipeline."""
        production = self.config["production"]
        return {"epsilon": production["epsilon"][kind], "timestep_factor": production["timestep_factor"]}

    def _pull_off(self, own):
        shared = {key: own[key] for key in ("pairs", "ratios", "seed", "damped", "undamped", "undamped_steps")}
        pieces = {material: shared | {"material": material} for material in own["materials"]}
        waiting = {key: own[key] for key in ("pairs", "ratios", "seed")}
        return pieces | {f"waiting_{material}": waiting | {"material": material} for material in own["materials"]}

    def _damping(self, own):
        shared = {key: own[key] for key in ("material", "epsilon", "viscous_time_ps", "timestep_factor")}
        rate = shared | {key: own["rate"][key] for key in ("epsilon", "viscous_time_ps", "timestep_factor")}
        pieces = _each_grain(own["grains"], shared)
        pieces |= {f"rate_{name}": piece for name, piece in _each_grain(own["grains"], rate).items()}
        waiting = {key: own[key] for key in ("material", "viscous_time_ps")}
        return pieces | {f"waiting_{name}": piece for name, piece in _each_grain(own["grains"], waiting).items()}

    def _literal(self, own):
        shared = {key: own[key] for key in ("material", "part_of_limit", "timestep_factor")}
        return _each_grain(own["grains"], shared)

    def _each_type_and_size(self, own):
        shared = {key: value for key, value in own.items() if key not in ("types", "sizes_nm")}
        return {
            f"{kind}_{size}nm": shared | {"type": kind, "a_eff": size * NM}
            for kind, size in product(own["types"], own["sizes_nm"])
        }

    def _growth(self, own):
        pieces = {
            f"{kind}_{number}": {
                "material": own["material"], "type": kind, "monomers": number, "seeds": own["seeds"]
            }
            for kind, number in product(("BA", "BAM1", "BAM2"), own["monomers"])
        }  # fmt: skip
        pieces |= {
            f"{kind}_{size}nm_{grains['migration']}": {
                "material": own["material"], "type": kind, "a_eff": size * NM, "seeds": grains["seeds"],
                "migration": grains["migration"],
            }
            for grains in own["grains"] for kind, size in product(grains["types"], grains["sizes_nm"])
        }  # fmt: skip
        return pieces | {"arrivals": {"material": own["material"], "arrivals": own["arrivals"]}}

    def _relaxation(self, own):
        factor = self.config["production"]["timestep_factor"]
        return {
            name: piece | {"timestep_factor": factor, "damped": way == "damped"} for way, name, piece in _by_way(own)
        }

    def _energy(self, own):
        return {
            name: piece | (self._production(piece["type"]) if way == "paced" else {})
            for way, name, piece in _by_way(own)
        }

    def _free_grain(self, own):
        shared = {key: value for key, value in own.items() if key not in ("types", "size_nm", "seeds")}
        return {
            f"{kind}_{seed}": shared | {"type": kind, "a_eff": own["size_nm"] * NM, "seed": seed}
            for kind, seed in product(own["types"], range(own["seeds"]))
        }

    def _collision_step(self, own):
        shared = {key: own[key] for key in ("number", "filling_factor", "second_contact")}
        shared |= {
            "largest": own["largest_nm"] * NM,
            "timestep": [step * 1e-12 for step in own["timestep_ps"]],
            "duration": own["duration_us"] * 1e-6,
            "early": own["early_us"] * 1e-6,
        }
        each = product(range(own["rotations"]), own["velocities"], range(own["samples"]))
        return {
            f"{sample}_{velocity}_{rotation}": shared
            | {"sample": sample, "velocity": float(velocity), "rotation": rotation}
            for rotation, velocity, sample in each
        }

    def _forces(self, own):
        shared = {key: value for key, value in own.items() if key not in ("materials", "size_nm")}
        shared["a_eff"] = own["size_nm"] * NM
        return {material: shared | {"material": material} for material in own["materials"]}

    def _of_cluster(self, own):
        shared = {key: value for key, value in own.items() if key != "seeds"}
        return {f"{own['material']}_{own['n']}_{seed}": shared | {"seed": seed} for seed in range(own["seeds"])}

    def _spring_back(self, own):
        shared = {key: value for key, value in own.items() if key != "clusters"}
        return {
            f"{group['n']}_{group['until_phi']:g}_{seed}": shared
            | {key: value for key, value in group.items() if key != "seeds"}
            | {"seed": seed}
            for group in own["clusters"]
            for seed in range(group["seeds"])
        }

    def _lammps(self, own):
        pairs = [[a * NM for a in pair] for pair in own["pairs_nm"]]
        forces = {"study": "force", "points": own["points"], "pairs": pairs}
        shared = {key: own[key] for key in ("material", "timestep_factor", "step", "rotations")}
        driven = shared | {"study": "elastic rolling", "rotations": {"driven": own["rotations"]["driven"]}}
        curves = {f"force_{material}": forces | {"material": material} for material in own["materials"]}
        return (
            curves
            | _each_grain(own["grains"], shared | {"study": "rotation"})
            | {f"elastic_{name}": piece for name, piece in _each_grain(own["grains"], driven).items()}
        )


def _each_grain(grains, shared):
    """Pieces of one grain each.

    Parameters
    ----------
    grains : list of dict
        type, size_nm, seeds (number).
    shared : dict
        Settings of all.

    Returns
    -------
    dict
        Name of the piece -> its settings.
    """
    return {
        f"{grain['type']}_{grain['size_nm']}nm_{seed}": shared
        | {"type": grain["type"], "a_eff": grain["size_nm"] * NM, "seed": seed}
        for grain in grains
        for seed in range(grain["seeds"])
    }


def _by_way(own):
    """Way, name and settings of pieces that are a way, a material, a type and a size each, with all their seeds."""
    for way, grains in own.items():
        for material, kind, size in product(grains["materials"], grains["types"], grains["sizes_nm"]):
            piece = {"material": material, "type": kind, "a_eff": size * NM, "seeds": grains["seeds"]}
            yield way, f"{way}_{material}_{kind}_{size}nm", piece
