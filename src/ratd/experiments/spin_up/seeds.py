"""Cells, seeds and blocks of the ensemble: which grains the config asks for, and in which files they are.

A cell is one (material, type, size). Its seeds are grown and spun up in blocks, one file and one job each.
"""

from ratd.pipeline.places import any_of, size_label

__all__ = ["Cells", "cell_of", "size_label"]


def cell_of(names):
    """(material, type, size) of a mapping with material, type and size_nm, the size as in `Plan.sizes`."""
    return names["material"], names["type"], size_label(names["size_nm"])


class Cells:
    """The cells of a config, their seeds, and the names of their files.

    Parameters
    ----------
    config : dict
        The checked keys of the spin-up.
    """

    def __init__(self, config):
        self.config = config

    @property
    def sizes(self):
        """Sizes as they stand in names of folders, list of str, the largest first."""
        return [size_label(size) for size in sorted(self.config["sizes_nm"], reverse=True)]

    @property
    def seeds(self):
        """All seeds, a range."""
        first = self.config["seeds"]["first"]
        return range(first, first + self.config["seeds"]["number"])

    @property
    def fewer(self):
        """What `seeds.fewer` says of cells with fewer seeds, list of dict; a later one stands over earlier ones."""
        return self.config["seeds"].get("fewer", [])

    def seeds_of(self, cell, drive=None):
        """Seeds of one cell, a range from the first seed on.

        Parameters
        ----------
        cell : tuple of str
            (material, type, size), one of `cells`.
        drive : str, optional
            Seeds that this drive spins up; default: those that are grown, the most that any drive wants.

        Returns
        -------
        range
        """
        if drive is None:
            return max((self.seeds_of(cell, own) for own in self.config["drives"]), key=len)
        number = len(self.seeds)
        for entry in self.fewer:
            names = {"drives": drive, "materials": cell[0], "types": cell[1]}
            sizes = entry.get("sizes_nm")
            if all(name in entry.get(key, [name]) for key, name in names.items()) and (
                sizes is None or cell[2] in map(size_label, sizes)
            ):
                number = entry["number"]
        return self.seeds[:number]

    def blocks(self, cell=None, drive=None):
        """Blocks of seeds as they stand in names of files.

        Parameters
        ----------
        cell : tuple of str, optional
            See `seeds_of`; default: those of a cell with all seeds.
        drive : str, optional
            See `seeds_of`.

        Returns
        -------
        list of str
            Such as ``"0-9"``; the last one may be shorter than the others.
        """
        return self._split(self.seeds if cell is None else self.seeds_of(cell, drive), cell)

    def _block_size(self, cell):
        small = self.config.get("small_grains")
        if cell is not None and small is not None and float(cell[2]) <= small["up_to_nm"]:
            return small["block_size"]
        return self.config["block_size"]

    def _split(self, seeds, cell):
        step = self._block_size(cell)
        blocks = (seeds[k : k + step] for k in range(0, len(seeds), step))
        return [f"{block[0]}-{block[-1]}" for block in blocks]

    def grown_block(self, cell, block):
        """Block of grown grains in which the grains of a block of some drive are, see `blocks`."""
        first = int(block.partition("-")[0])
        seeds = self.seeds_of(cell)
        return self._block_with(first, seeds if first in seeds else self.seeds, cell)

    def _block_with(self, seed, seeds, cell):
        return self._split(seeds, cell)[(seed - self.seeds[0]) // self._block_size(cell)]

    def files(self, path, drive=None):
        """Names of the files of all blocks of all cells.

        Parameters
        ----------
        path : str
            With the fields ``{material}``, ``{type}``, ``{size}``, ``{seeds}``.
        drive : str, optional
            Cells and seeds that this drive spins up; default: those that are grown.

        Returns
        -------
        list of str
            In the order of `cells`.
        """
        return [
            self.file(path, cell, seeds=block) for cell in self.cells_of(drive) for block in self.blocks(cell, drive)
        ]

    def all_files(self, path, material=None, kind=None):
        """Files of the grown grains of all cells with all seeds, see `files`; `seeds.fewer` leaves none out.

        Those of one material and type, where they are given.
        """
        return [
            self.file(path, cell, seeds=block)
            for cell in self.cells
            if material in (None, cell[0]) and kind in (None, cell[1])
            for block in self._split(self.seeds, cell)
        ]

    def run_files(self, path, cell=None, drive=None):
        """Files of all blocks of one cell, or of all cells, that a drive spins up; `path` as of `files`, with drive."""
        return [
            self.file(path, own, drive=drive, seeds=block)
            for own in ([cell] if cell else self.cells_of(drive))
            for block in self.blocks(own, drive)
        ]

    def mark_files(self, path, drive):
        """Files of the marks of all cells that a drive spins up; `path` with drive, material, type, size."""
        return [self.file(path, cell, drive=drive) for cell in self.cells_of(drive)]

    @property
    def grows_more_anyway(self):
        """Whether all grains are grown for one drive or another, and `seeds.fewer` leaves some out for a drive."""
        grains = "{material} {type} {size} {seeds}"
        return bool(self.fewer) and self.files(grains) == self.all_files(grains)

    def grown_files(self, path, drive):
        """Files of the grown grains that a drive spins up, see `files`; they may hold more seeds than it wants."""
        return [
            self.file(path, cell, seeds=block)
            for cell in self.cells_of(drive)
            for block in self.blocks(cell)[: len(self.blocks(cell, drive))]
        ]

    @staticmethod
    def file(path, cell, **names):
        """Name of one file of a cell, see `files`."""
        return path.format(material=cell[0], type=cell[1], size=cell[2], **names)

    def cells_of(self, drive=None):
        """Those of `cells` that a drive spins up at least one grain of; default: that are grown."""
        return [cell for cell in self.cells if self.seeds_of(cell, drive)]

    @property
    def cells(self):
        """All (material, type, size), the size as in `sizes`."""
        return [
            (material, kind, size)
            for size in self.sizes
            for material in self.config["materials"]
            for kind in self.config["types"]
        ]

    def pattern(self, name):
        """Regular expression of what a wildcard of Snakemake can be.

        Parameters
        ----------
        name : str
            "sizes", "blocks", "calibration_labels", or a key of the config that holds a list of names.

        Returns
        -------
        str
        """
        if name == "blocks":
            drives = (None, *self.config["drives"])
            values = {block for cell in self.cells for drive in drives for block in self.blocks(cell, drive)}
            # a grain that only figure 1 shows is in a block of a cell with all seeds
            values = sorted(values | {block for cell in self.cells for block in self._split(self.seeds, cell)})
        else:
            values = getattr(self, name) if name in ("sizes", "calibration_labels") else self.config[name]
        return any_of(values)
