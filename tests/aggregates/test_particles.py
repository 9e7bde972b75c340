"""Spheres in files of other programs: read back by ratd, by OVITO and by ASE."""

import warnings

import numpy as np
import pytest

import ratd
from files import make_grain, make_run
from ratd.aggregates.particles import Particles, read_particles
from ratd.aggregates.write_particles import write_particles
from ratd.base.errors import FileError, InputError

FORMATS = ("txt", "dat", "csv", "xyz", "extxyz", "dump", "lammpstrj")
BOX = np.array([3e-7, 4e-7, 5e-7])


@pytest.fixture(scope="module")
def grain():
    return make_grain(n=5)


def snapshots(n=3):
    """A run with made-up snapshots, in the last of which one monomer has been dropped."""
    run = make_run(n_snapshots=n, n_monomers=4)
    run["snapshot_fragment"][:] = [[0, 0, 0, 0], [0, 0, 1, 1], [0, 0, 1, -1]][:n]
    for axis in "xyz":
        run[f"snapshot_{axis}"] = run[f"snapshot_{axis}"] * 1e-8
    run["monomer_radius"] = run["monomer_radius"] * 1e-8
    run["snapshot_normal_force"] = (run["snapshot_normal_force"] - 5) * 1e-9
    run["snapshot_omega"] = ("snapshot", [1e8, 2e8, 3e8][:n])
    return run


@pytest.mark.parametrize("unit", ["nm", "m", "um"])
@pytest.mark.parametrize("suffix", FORMATS)
def test_a_grain_comes_back(tmp_path, grain, suffix, unit):
    path = tmp_path / f"grain.{suffix}"
    ratd.write_particles(grain, path, unit=unit)
    # the file says its unit
    back = ratd.read_particles(path)
    np.testing.assert_allclose(back.position, grain.position, rtol=1e-10, atol=1e-20)
    np.testing.assert_allclose(back.radius, grain.radius, rtol=1e-10)
    assert back.box is None and back.grain("q-S", seed=3).n_contacts == grain.n_contacts


@pytest.mark.parametrize("suffix", ["xyz", "dump"])
def test_a_box_comes_back(tmp_path, grain, suffix):
    write_particles(Particles(grain.position, grain.radius, BOX), tmp_path / f"grain.{suffix}")
    np.testing.assert_allclose(read_particles(tmp_path / f"grain.{suffix}").box, BOX)
    with pytest.warns(UserWarning, match="grain.csv: a .csv file does not hold the periodic box; use .xyz"):
        write_particles(Particles(grain.position, grain.radius, BOX), tmp_path / "grain.csv")


def dump(style, columns, rows):
    """A dump of two spheres that names the style of its units."""
    return (
        f"ITEM: UNITS\n{style}\nITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n2\nITEM: BOX BOUNDS ff ff ff\n0 1\n0 1\n0 1\n"
        f"ITEM: ATOMS {columns}\n{rows}"
    )


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("a.txt", "0 0 0 20\n0 0 40 20\n"),
        ("A.TXT", "# unit: um\nx y z r\n0 0 0 0.02\n0 0 0.04 0.02\n"),
        ("a.xyz", "1\nProperties=pos:R:3:r:R:1\n0 0 0 9\n\n2\nProperties=pos:R:3:r:R:1\n0 0 0 20\n0 0 40 20\n\n"),
        ("a.txt", "# made by hand\nx y z r\n0 0 0 20  # the first\n\n0 0 40 20\n"),
        ("a.dat", "x [nm]\ty\tz\tr\n0\t0\t0\t20\n0\t0\t40\t20\n".replace(" [nm]", "[nm]")),
        ("a.txt", "# x y z r\n0 0 0 20\n0 0 40 20\n"),
        ("a.txt", "# id x y z r\n1 0 0 0 20\n2 0 0 40 20\n"),
        ("a.csv", "\ufeffx,y,z,radius\n0,0,0,20\n0,0,40,20\n"),
        ("a.csv", "x [um],y [um],z [um],r [um]\n0,0,0,0.02\n0,0,0.04,0.02\n"),
        ("a.txt", "x_µm y_µm z_µm r_µm\n0 0 0 0.02\n0 0 0.04 0.02\n"),
        ("a.xyz", "2\nProperties=pos:R:3:r:R:1 unit=um\n0 0 0 0.02\n0 0 0.04 0.02\n"),
        ("a.csv", "radius,x,y,z,name\n20,0,0,0,a\n20,0,0,40,b\n"),
        ("a.csv", "0,0,0,20\n0,0,4e1,20\n"),
        ("a.xyz", "2\nProperties=pos:R:3:r:R:1\n0 0 0 20\n0 0 40 20\n"),
        # two lines of header, as numpy.savetxt writes them
        ("a.txt", "# made by me\n# r[um] x[um] y[um] z[um]\n0.02 0 0 0\n0.02 0 0 0.04\n"),
        ("a.txt", "x [um] y [um] z [um] r [um]\n0 0 0 0.02\n0 0 0.04 0.02\n"),
        ("a.xyz", "\ufeff2\nProperties=pos:R:3:r:R:1 unit=µm\n0 0 0 0.02\n0 0 0.04 0.02\n"),
        ("a.dump", dump("real", "id radius x y z xu yu zu", "1 200 1 1 1 0 0 0\n2 200 1 1 1 0 0 400\n")),
        ("a.dump", dump("nano", "id radius x y z", "1 20 0 0 0\n2 20 0 0 40\n")),
        ("a.dump", dump("metal", "id radius x y z", "1 200 0 0 0\n2 200 0 0 400\n")),
        ("a.dump", dump("micro", "id radius x y z", "1 0.02 0 0 0\n2 0.02 0 0 0.04\n")),
        ("a.dump", dump("cgs", "id radius x y z", "1 2e-6 0 0 0\n2 2e-6 0 0 4e-6\n")),
        ("a.dump", dump("si", "id radius x y z", "1 2e-8 0 0 0\n2 2e-8 0 0 4e-8\n")),
        (
            "a.dump",
            "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n2\nITEM: BOX BOUNDS ff ff ff\n0 1\n0 1\n0 1\n"
            "ITEM: ATOMS id type radius x y z\n2 1 20 0 0 40\n1 1 20 0 0 0\n",
        ),
    ],
)
def test_files_as_others_write_them(tmp_path, name, text):
    (tmp_path / name).write_text(text)
    read = read_particles(tmp_path / name)
    np.testing.assert_allclose(read.position, [[0, 0, 0], [0, 0, 40e-9]])
    np.testing.assert_allclose(read.radius, 20e-9)


def test_edges_of_the_box_of_a_dump_are_between_its_bounds(tmp_path):
    text = dump("nano", "id radius x y z", "1 20 0 0 0\n2 20 0 0 40\n")
    bounds = "pp pp pp\n-100 200\n0 400\n50 550\n"
    (tmp_path / "a.dump").write_text(text.replace("ff ff ff\n0 1\n0 1\n0 1\n", bounds))
    np.testing.assert_allclose(read_particles(tmp_path / "a.dump").box, BOX)


@pytest.mark.parametrize(
    ("name", "text", "said"),
    [
        # more columns than names: pandas would take the first ones for an index, and shift the others
        (
            "a.xyz",
            "1\nProperties=species:S:1:pos:R:3:radius:R:1\nX 0 0 0 30 20\n",
            "names 5 columns, .* and its rows have 6",
        ),
        ("a.dump", dump("nano", "id radius x y z", "1 20 0 0 0 9\n2 20 0 0 40 9\n"), "names 5 columns, .* rows have 6"),
        ("a.txt", "0 0 0 20\n0 0 40 20 7\n", "its rows differ in their number of columns"),
        ("a.csv", "x,x,y,z,r\n0,0,0,0,20\n", "it has more than one column x"),
        ("a.txt", "x y z r\n", "it holds no spheres"),
        ("a.xyz", "1\nProperties=pos:R:3:r:R:1\n0 0 0 20\n0 0 40 20\n", "a frame begins with '0 0 40 20'; allowed"),
        ("a.txt", "0 0 20\n", "is no .txt file of spheres .there is no column radius; the columns are x, y, z"),
        ("a.txt", "", "is no .txt file of spheres .it is empty"),
        ("a.txt", "0,0,0,20\n", "the columns are x; in a .txt file columns are parted by blanks or tabs"),
        ("a.csv", "0;0;0;20\n", "the columns are x; in a .csv file columns are parted by commas"),
        (
            "a.txt",
            "0 0 0 -20\n",
            "holds 1 spheres; allowed: finite numbers x, y, z and radii above 0; sphere 1 has",
        ),
        ("a.txt", "x y z r name\n0 0 0 20\n", "it names 5 columns, x, y, z, radius, name, and its rows have 4"),
        ("a.xyz", "1\nas Newton's apple\n0 0 0 20\n", ".it has no radii; its second line must be"),
        ("a.xyz", "", "it has 0 frames, and frame -1 was asked for"),
        ("a.csv", "x,y,z,r\n0,0,zero,20\n", "is no .csv file of spheres .z of sphere 1 is 'zero', which is no number"),
        ("a.xyz", "3\nProperties=pos:R:3:radius:R:1\n0 0 0 20\n", "the last frame has 3 lines instead of 5"),
        (
            "a.xyz",
            "1\nno properties\n0 0 0 20\n",
            ".it has no radii; its second line must be",
        ),
        ("a.xyz", '1\nProperties=pos:R:3:r:R:1 Lattice="9 1 0 0 9 0 0 0 9"\n0 0 0 2\n', "the box is not rectangular"),
        (
            "a.xyz",
            '1\nProperties=pos:R:3:r:R:1 Lattice="9 0 0 0 9 0 0 0 9" pbc="T T F"\n0 0 0 2\n',
            "only, T T F;",
        ),
        (
            "a.dump",
            "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n1\nITEM: BOX BOUNDS pp ff pp\n0 1\n0 1\n0 1\n"
            "ITEM: ATOMS id x y z radius\n1 0 0 0 100\n",
            "the box is periodic along some axes only, pp ff pp; allowed: all of them, or none",
        ),
        (
            "a.xyz",
            "0 0 0 20\n40 0 0 20\n",
            "its first line must be the number of spheres; columns",
        ),
        ("a.xyz", "-2\n\n", "a frame begins with '-2'; allowed: the number of its spheres"),
        ("a.xyz", "1\nProperties=pos:R:3:r:R:1 unit=pc\n0 0 0 2\n", "its unit is 'pc'; allowed: m, cm"),
        ("a.csv", "x,y,z,r\n0,0,0,20\n0,0,forty,20\n", "z of sphere 2 is 'forty', which is no number"),
        ("a.txt", "0 0 0 20\n0 0 40 20,5\n", "radius of sphere 2 is '20,5', which is no number"),
        ("a.txt", "0 0 0 20\n0 nan 40 20\n", "sphere 2 has 0.0, nan, 40.0, 20.0"),
        ("a.csv", "x,y,z,r\n0,0,0,20\n0,,40,20\n", "sphere 2 has 0.0, nan, 40.0, 20.0"),
        ("a.txt", "1 0 0 0 20\n", "it has 5 columns; more than x y z r need their names"),
        ("a.csv", "x [um],y [nm],z [nm],r [nm]\n0,0,0,1\n", "its columns are in several units, nm, um"),
        ("a.dump", "ITEM: TIMESTEP\n", "it has no line ITEM: ATOMS"),
        (
            "a.dump",
            "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n1\nITEM: ATOMS id x y z radius\n1 0 0 0 100\n",
            "it has no line ITEM: BOX BOUNDS",
        ),
    ],
)
def test_what_is_wrong_with_a_file_is_said_in_one_sentence(tmp_path, name, text, said):
    (tmp_path / name).write_text(text)
    with pytest.raises(FileError, match=said) as error:
        read_particles(tmp_path / name)
    assert str(tmp_path / name) in str(error.value) and "\n" not in str(error.value)


@pytest.mark.parametrize(
    ("name", "length"), [("micron", 1e-6), ("µm", 1e-6), ("A", 1e-10), ("Å", 1e-10), ("nm", 1e-9), ("parsec", None)]
)
def test_a_unit_in_brackets_is_known_or_refused(tmp_path, name, length):
    path = tmp_path / "a.csv"
    path.write_text(f"x [{name}],y [{name}],z [{name}],r [{name}]\n0,0,0,20\n0,0,40,20\n", encoding="utf-8")
    if length is None:
        with pytest.raises(FileError, match="its unit is 'parsec'; allowed: m, cm"):
            read_particles(path)
    else:
        assert read_particles(path).radius == pytest.approx(20 * length)
    xyz = tmp_path / "a.xyz"
    xyz.write_text("1\nProperties=species:S:1:pos:R:3:radius:R:1 units=micron\nX 0 0 0 0.02\n")
    assert read_particles(xyz).radius == pytest.approx(2e-8)


def test_a_dump_in_units_without_a_length_needs_one(tmp_path):
    path = tmp_path / "a.dump"
    path.write_text(dump("lj", "id radius x y z", "1 20 0 0 0\n2 20 0 0 40\n"))
    with pytest.raises(InputError, match="is in the units lj of LAMMPS; allowed: si, cgs.* or give the unit of its"):
        read_particles(path)
    assert read_particles(path, unit="nm").radius == pytest.approx(20e-9)


def test_radii_that_seem_to_be_in_another_unit_than_nm_need_one(tmp_path):
    path = tmp_path / "a.txt"
    path.write_text("0 0 0 0.2\n0 0 0.4 0.2\n")
    with pytest.raises(InputError, match="states no unit.* which is um in all likelihood"):
        read_particles(path)
    assert read_particles(path, unit="nm").radius == pytest.approx(0.2e-9)


def test_wrong_arguments(tmp_path, grain):
    write_particles(grain, tmp_path / "a.txt")
    write_particles(grain, tmp_path / "a.xyz", unit="um")
    assert read_particles(tmp_path / "a.xyz").radius == pytest.approx(grain.radius)
    with pytest.raises(InputError, match="states that its lengths are in um, and was to be read in nm"):
        read_particles(tmp_path / "a.xyz", unit="nm")
    with pytest.raises(InputError, match="path is None; it must be the path of a file"):
        read_particles(None)
    with pytest.raises(InputError, match="content is of type NoneType; it must be a ratd.Grain"):
        write_particles(None, tmp_path / "b.xyz")
    with pytest.raises(InputError, match="frame is None; it must be a whole number"):
        read_particles(tmp_path / "a.xyz", frame=None)
    with pytest.raises(
        InputError, match="read in m the radii have the median 21.* m; read in nm they would: give that as the unit."
    ):
        read_particles(tmp_path / "a.txt", unit="m")
    with pytest.raises(InputError, match="unit is 'pc'; allowed: m, cm"):
        read_particles(tmp_path / "a.txt", unit="pc")
    with pytest.raises(InputError, match="LAMMPS has no units with mm; allowed: m, cm, um, nm, angstrom"):
        write_particles(grain, tmp_path / "a.dump", unit="mm")
    with pytest.raises(InputError, match=r"has the suffix '.pdf'; allowed: .csv, .txt"):
        write_particles(grain, tmp_path / "a.pdf")
    with pytest.raises(FileError, match="b.txt: cannot be read"):
        read_particles(tmp_path / "b.txt")
    with pytest.raises(InputError, match="holds one frame, but there are 3; use .xyz"):
        write_particles(snapshots(), tmp_path / "a.csv")
    with pytest.raises(InputError, match="no snapshots to write"):
        write_particles(make_run(), tmp_path / "a.xyz")


@pytest.mark.parametrize("suffix", ["xyz", "dump"])
def test_frames_of_a_run_come_back_one_by_one(tmp_path, suffix):
    run = snapshots()
    write_particles(run, tmp_path / f"run.{suffix}")
    for k, n in enumerate((4, 4, 3)):
        x = run["snapshot_x"].values[k, :n]
        np.testing.assert_allclose(read_particles(tmp_path / f"run.{suffix}", frame=k).position[:, 0], x, rtol=1e-10)
    assert len(read_particles(tmp_path / f"run.{suffix}").radius) == 3
    with pytest.raises(FileError, match="has 3 frames, and frame 3 was asked for"):
        read_particles(tmp_path / f"run.{suffix}", frame=3)


def test_the_end_of_an_evolution_is_written_with_its_box(tmp_path, grain):
    run = ratd.evolve(grain.position, grain.radius, box=ratd.periodic(1e-6), duration=1e-12, records=1)
    write_particles(run, tmp_path / "end.xyz")
    back = read_particles(tmp_path / "end.xyz")
    np.testing.assert_allclose(back.position, run["position"], rtol=1e-10, atol=1e-20)
    np.testing.assert_allclose(back.box, 1e-6)


def test_the_end_of_an_evolution_in_open_space_has_no_box(tmp_path, grain):
    run = ratd.evolve(grain.position, grain.radius, duration=1e-12, records=1)
    write_particles(run, tmp_path / "end.xyz")
    assert 'pbc="F F F"' in (tmp_path / "end.xyz").read_text() and read_particles(tmp_path / "end.xyz").box is None


@pytest.mark.parametrize("suffix", ["xyz", "dump"])
def test_ovito_reads_radius_fragment_force_and_box(tmp_path, suffix):
    ovito = pytest.importorskip("ovito.io")
    run = snapshots()
    write_particles(run, tmp_path / f"run.{suffix}")
    pipeline = ovito.import_file(str(tmp_path / f"run.{suffix}"))
    assert pipeline.num_frames == 3
    data = pipeline.compute(2)
    np.testing.assert_allclose(data.particles["Position"][:, 0], run["snapshot_x"].values[2, :3] * 1e9)
    np.testing.assert_allclose(data.particles["Radius"], run["monomer_radius"].values[:3] * 1e9)
    np.testing.assert_array_equal(data.particles["fragment"], [0, 0, 1])
    np.testing.assert_allclose(data.particles["normal_force"], run["snapshot_normal_force"].values[2, :3] * 1e9)
    write_particles(Particles(np.ones((1, 3)) * 1e-8, np.array([1e-8]), BOX), tmp_path / f"box.{suffix}")
    cell = ovito.import_file(str(tmp_path / f"box.{suffix}")).compute().cell
    np.testing.assert_allclose(np.diag(cell[:3, :3]), BOX * 1e9)
    assert all(cell.pbc)


def test_ase_reads_radius_fragment_force_and_box(tmp_path):
    ase = pytest.importorskip("ase.io")
    run = snapshots()
    write_particles(run, tmp_path / "run.extxyz")
    *_, last = frames = ase.read(tmp_path / "run.extxyz", index=":")
    assert len(frames) == 3 and last.info["omega"] == 3e8 and last.info["unit"] == "nm"
    np.testing.assert_allclose(last.arrays["radius"], run["monomer_radius"].values[:3] * 1e9)
    np.testing.assert_array_equal(last.arrays["fragment"], [0, 0, 1])
    np.testing.assert_allclose(last.arrays["normal_force"], run["snapshot_normal_force"].values[2, :3] * 1e9)
    assert not last.pbc.any()
    write_particles(Particles(np.ones((1, 3)) * 1e-8, np.array([1e-8]), BOX), tmp_path / "box.extxyz")
    np.testing.assert_allclose(ase.read(tmp_path / "box.extxyz").cell.lengths(), BOX * 1e9)
    # and what ASE writes comes back
    frames[0].set_array("radius", frames[0].arrays["radius"])
    ase.write(tmp_path / "theirs.xyz", frames[0], format="extxyz")
    np.testing.assert_allclose(read_particles(tmp_path / "theirs.xyz").radius, run["monomer_radius"], rtol=1e-6)


def test_snapshots_of_an_evolution_and_a_compression_are_frames(tmp_path, grain):
    run = ratd.evolve(
        grain.position, grain.radius, box=ratd.periodic(1e-6), duration=1e-12, records=4, snapshot_every=2
    )
    write_particles(run, tmp_path / "film.xyz")
    for k in range(run.sizes["snapshot"]):
        back = read_particles(tmp_path / "film.xyz", frame=k)
        np.testing.assert_allclose(back.position, run["snapshot_position"][k], rtol=1e-10, atol=1e-20)
        np.testing.assert_allclose(back.box, 1e-6)
    cluster = ratd.grow_bcca(16, "ice", seed=3)
    run = ratd.compress(cluster, 1e-3, 0.2, snapshots=(0.16, 0.2), balance=False)
    write_particles(run, tmp_path / "film.dump")
    for k in range(2):
        back = read_particles(tmp_path / "film.dump", frame=k)
        np.testing.assert_allclose(back.position, run["snapshot_position"][k], rtol=1e-10, atol=1e-20)
        np.testing.assert_allclose(back.box, run["snapshot_box_length"].values[k], rtol=1e-10)


def test_contacts_through_the_faces_of_a_box_are_not_lost_in_silence():
    """Four spheres in a row that a box of their length closes to a ring."""
    position = np.array([[100e-9 * k, 0.0, 0.0] for k in range(4)])
    box = np.array([400e-9, 200e-9, 200e-9])
    with pytest.warns(UserWarning, match="1 contact of these spheres reach"):
        assert Particles(position, np.full(4, 50e-9), box).grain("q-S").n_contacts == 3
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        Particles(position, np.full(4, 50e-9), 2.0 * box).grain("q-S")
