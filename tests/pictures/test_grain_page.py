"""The page on which a grain is turned: it holds what the run says, loads nothing, and repeats to the last byte."""

import base64
import re
import zlib
from html.parser import HTMLParser

import msgpack
import numpy as np
import pytest

from ratd.base.errors import InputError
from ratd.pictures.grain_page import OPENING, SCRIPT, SPHERES, TEMPLATE, grain_page
from ratd.pictures.snapshots import FARTHEST, force_colours, force_scale, fragment_colours, frames
from ratd.pictures.stepper import CONTROLS
from synthetic_runs import make_run, run_with_snapshots

OMEGA_DISR = 1.02e8


@pytest.fixture(scope="module")
def page():
    return grain_page(run_with_snapshots(), OMEGA_DISR)


def scene(page):
    """What k3d reads from a page."""
    data = re.search(r"var data = '([A-Za-z0-9+/=]+)';", page).group(1)
    return msgpack.unpackb(zlib.decompress(base64.b64decode(data)))


def spheres(page):
    return next(found for found in scene(page)["objects"] if found["id"] == SPHERES)


def series(of_k3d, width=1):
    """Arrays of a time series of k3d, one a snapshot."""
    steps = [of_k3d[str(k)] for k in range(len(of_k3d))]
    arrays = [np.frombuffer(step["data"], step["dtype"]) for step in steps]
    return [array.reshape(-1, width) if width > 1 else array for array in arrays]


def test_spheres_have_the_places_and_radii_of_the_run(page):
    run, found = run_with_snapshots(), spheres(page)
    places, sizes = series(found["positions"], 3), series(found["point_sizes"])
    assert len(places) == len(sizes) == 5
    for k, (place, size) in enumerate(zip(places, sizes, strict=True)):
        there = run["snapshot_fragment"].values[k] >= 0
        x = run["snapshot_x"].values[k][there] / 1e-9
        np.testing.assert_allclose(np.diff(place[:, 0]), np.diff(x), atol=0.01)
        np.testing.assert_allclose(place[:, 1:], 0, atol=0.01)
        np.testing.assert_allclose(size, 2 * run["monomer_radius"].values[there] / 1e-9, rtol=1e-6)
    np.testing.assert_allclose(places[3].mean(axis=0), places[3][2] / 3, atol=0.01)  # the two of the largest at 0
    assert len(places[4]) == 2


def test_the_numbers_beside_the_grain_are_those_of_the_run(page):
    steps = spheres(page)["custom_data"]["steps"]
    omega = run_with_snapshots()["snapshot_omega"].values
    assert steps["omega"] == omega.tolist()
    np.testing.assert_allclose(steps["ratio"], omega / 1.02e8)
    np.testing.assert_allclose(steps["largest"], [1, 1, 1, 2 / 3, 1 / 3])
    assert steps["fragments"] == [1, 1, 1, 2, 2] and steps["dropped"] == [0, 0, 0, 0, 1]


def test_colours_are_those_of_figure_5(page):
    shown = frames(run_with_snapshots())
    scale = force_scale(shown)
    colours = spheres(page)["custom_data"]["colours"]
    wanted = {
        "fragment": [fragment_colours(frame.fragment) for frame in shown],
        "force": [force_colours(frame.force, scale) for frame in shown],
    }
    for name, steps in wanted.items():
        for packed, colour in zip(series(colours[name]), steps, strict=True):
            channels = np.stack([packed >> 16, packed >> 8 & 255, packed & 255], axis=1)
            np.testing.assert_array_equal(channels, np.rint(255 * colour))
    assert "&minus;1</span>" in page and "1 nN" in page


@pytest.mark.parametrize("stretch", [1.0, 1.3, 9.0])
def test_the_camera_shows_the_largest_fragment_at_all_steps(stretch):
    run = run_with_snapshots()
    run["snapshot_x"][2] *= stretch
    reach = np.abs(run["snapshot_x"].values[:3]).max(axis=1) + 20e-9  # while the chain is whole, about its middle
    found = scene(grain_page(run, OMEGA_DISR))["plot"]
    half_width = np.linalg.norm(found["camera"][:3]) * np.sin(np.radians(OPENING / 2)) * 1e-9
    assert found["cameraFov"] == OPENING and not found["cameraAutoFit"]
    assert half_width == pytest.approx(1.05 * min(reach.max(), FARTHEST * reach[0]))


def test_same_run_same_bytes(page):
    assert grain_page(run_with_snapshots(), OMEGA_DISR) == page
    assert not re.search(r"\d{4}-\d\d-\d\d", page.replace(SCRIPT.read_text(), ""))


class Loads(HTMLParser):
    """Tags of a page that make a browser load something."""

    def __init__(self, page):
        super().__init__()
        self.found = []
        self.feed(page)

    def handle_starttag(self, tag, attributes):
        names = {name for name, _ in attributes}
        if names & {"src", "href", "srcset", "action"} or tag in ("link", "iframe", "object", "embed"):
            self.found.append((tag, attributes))


def test_the_page_loads_nothing(page):
    assert Loads('<script src="https://example.org/a.js"></script>').found
    assert Loads(page).found == []
    own = TEMPLATE.read_text() + CONTROLS.read_text() + SCRIPT.read_text()
    assert not re.search(r"https?:|url\(|@import|import\(|fetch", own)
    assert scene(page)["plot"]["snapshotType"] == "full"


def test_script_and_page_fit_together(page):
    ids = set(re.findall(r'id="([\w-]+)"', TEMPLATE.read_text() + CONTROLS.read_text())) | {"canvasTarget"}  # k3d's own
    assert set(re.findall(r'element\("([\w-]+)"\)', SCRIPT.read_text())) <= ids
    assert page.count('<div id="canvasTarget"></div>') == page.count('<div id="numbers"') == 1
    assert SCRIPT.read_text() in page and "<title>q-S BAM2 350 nm, seed 0</title>" in page
    assert "driven" in page and "printed terms" in grain_page(run_with_snapshots(), OMEGA_DISR, "literal")


def test_a_run_without_what_the_page_needs():
    with pytest.raises(InputError, match="grain_page: the run has no snapshots"):
        grain_page(make_run(1e8), OMEGA_DISR)
    unknown = spheres(grain_page(run_with_snapshots(), np.nan))
    assert unknown["custom_data"]["steps"]["ratio"] == [None] * 5
