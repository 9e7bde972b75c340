"""The pages of a collision and of a compression in a browser: something is drawn, the slider moves, a phone will do."""

import numpy as np
import pytest
from PIL import Image

from browser import drawn, fits_a_phone, opened, picture, wait
from ratd.pictures.box_page import box_page
from ratd.pictures.collision_page import collision_page

SCENE = slice(150, 520)
"""Rows of the window that no panel covers."""
RADIUS = 1e-7


def lattice(edge):
    """Monomers of a simple cubic lattice of 4 x 4 x 4 in a box with an edge [m], (64, 3) array."""
    place = (np.arange(4) - 1.5) * edge / 4
    return np.stack(np.meshgrid(place, place, place, indexing="ij"), axis=-1).reshape(-1, 3)


def compression():
    """A lattice that is touched by its copies at the last of three snapshots."""
    edges = np.array([1.2, 1.0, 0.7999]) * 1e-6
    places = np.array([lattice(edge) for edge in edges]) + 3 * edges[:, None, None]  # boxes away: drawn in the box
    phi = 64 * 4 / 3 * np.pi * RADIUS**3 / edges**3
    return box_page(phi, edges, places, np.full(64, RADIUS), "64 monomers of ice")


def collision():
    """Two pairs of spheres that meet."""
    pair = np.array([[0.0, 0, 0], [2e-7, 0, 0]])
    places = np.array([np.concatenate([pair - [gap, 0, 0], pair + [gap, 0, 0]]) for gap in (6e-7, 4e-7, 2e-7)])
    piece = np.array([[0, 0, 1, 1], [0, 0, 1, 1], [0, 0, 0, 0]])
    origin = np.array([0, 0, 1, 1])
    return collision_page(np.array([0, 1e-7, 2e-7]), places, np.full(4, RADIUS), piece, origin, "two pairs")


@pytest.mark.parametrize(
    ("made", "label", "told", "values"),
    [
        (compression, "all alike", "contacts", ("0.00", "6.00")),
        (collision, "by cluster of origin", "pieces", ("2", "1")),
    ],
)
def test_spheres_are_drawn_and_stepped_through(made, label, told, values, tmp_path):
    path = tmp_path / "page.html"
    path.write_text(made(), encoding="utf-8")
    with opened(path) as page:
        wait(page)
        first = picture(page)
        assert drawn(first, SCENE) > 3000
        assert page.inner_text("#of") == "1 of 3" and page.inner_text(f"#{told}") == values[0]
        page.locator("#step").fill("2")
        page.wait_for_timeout(500)
        last = picture(page)
        assert page.inner_text("#of") == "3 of 3" and page.inner_text(f"#{told}") == values[1]
        assert np.any(first[SCENE] != last[SCENE])
        page.get_by_label(label).check()
        page.wait_for_timeout(500)
        assert np.any(picture(page)[SCENE] != last[SCENE])
        with page.expect_download() as download:
            page.click("#picture")
        download.value.save_as(tmp_path / "saved.png")
    assert drawn(np.asarray(Image.open(tmp_path / "saved.png").convert("RGB")).astype(int)) > 3000


@pytest.mark.parametrize("made", [compression, collision])
def test_the_pages_fit_a_phone(made, tmp_path):
    path = tmp_path / "page.html"
    path.write_text(made(), encoding="utf-8")
    fits_a_phone(path)


def test_the_same_page_for_the_same_input():
    assert compression() == compression() and collision() == collision()
