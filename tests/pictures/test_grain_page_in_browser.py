"""The page of a grain in a browser: something is drawn, the slider moves, a picture is saved, a phone will do."""

import numpy as np
import pytest
from PIL import Image

from browser import drawn, fits_a_phone, opened, picture, wait
from ratd.pictures.grain_page import grain_page
from synthetic_runs import run_with_snapshots

OMEGA_DISR = 4e8
SCENE = slice(130, 520)
"""Rows of the window that no panel covers."""


@pytest.fixture(scope="module")
def path(tmp_path_factory):
    path = tmp_path_factory.mktemp("page") / "page.html"
    path.write_text(grain_page(run_with_snapshots(), OMEGA_DISR), encoding="utf-8")
    return path


def test_the_grain_is_drawn_turned_stepped_through_and_saved(path, tmp_path):
    with opened(path) as page:
        wait(page)
        first = picture(page)
        assert drawn(first, SCENE) > 3000
        assert page.inner_text("#of") == "1 of 5" and page.inner_text("#fragments") == "1"

        page.locator("#step").fill("4")
        page.wait_for_timeout(500)
        last = picture(page)
        assert page.inner_text("#of") == "5 of 5" and page.inner_text("#fragments") == "2"
        assert np.any(first[SCENE] != last[SCENE])
        page.keyboard.press("Home")
        assert page.inner_text("#of") == "1 of 5"

        page.get_by_label("by greatest normal force").check()
        page.wait_for_timeout(500)
        assert page.locator("#legend-force").is_visible() and np.any(picture(page)[SCENE] != first[SCENE])

        before = picture(page)
        page.mouse.move(500, 300)
        page.mouse.down()
        page.mouse.move(650, 350, steps=5)
        page.mouse.up()
        page.wait_for_timeout(500)
        assert np.any(picture(page)[SCENE] != before[SCENE])

        with page.expect_download() as download:
            page.click("#picture")
        assert download.value.suggested_filename == "q-S_BAM2_350_nm_seed_0_1.png"
        download.value.save_as(tmp_path / "saved.png")
    saved = np.asarray(Image.open(tmp_path / "saved.png").convert("RGB")).astype(int)
    assert drawn(saved) > 3000


def test_the_page_fits_a_phone(path):
    fits_a_phone(path)
