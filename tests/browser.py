"""Pages in a headless browser, for tests; skipped where there is none."""

import shutil
from contextlib import contextmanager
from io import BytesIO

import numpy as np
import pytest
from PIL import Image

BROWSERS = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable")
WITHOUT_GRAPHICS_CARD = ("--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader")
OFF_LINE = ("--no-first-run", "--disable-background-networking", "--disable-component-update", "--disable-sync")


@contextmanager
def opened(path, width=1000, height=700):
    """A page, opened, as an object of playwright; ends with an error where the page told of one.

    Parameters
    ----------
    path : Path
        Of the HTML file.
    width, height : int
        Of the window.
    """
    playwright = pytest.importorskip("playwright.sync_api")
    browser = next(filter(None, map(shutil.which, BROWSERS)), None)
    if browser is None:
        pytest.skip("there is no chromium")
    wrong = []
    with playwright.sync_playwright() as started:
        options = ["--no-sandbox", *WITHOUT_GRAPHICS_CARD, *OFF_LINE]
        chromium = started.chromium.launch(executable_path=browser, args=options)
        page = chromium.new_page(viewport={"width": width, "height": height})
        page.on("pageerror", lambda error: wrong.append(str(error)))
        page.on("console", lambda said: wrong.append(said.text) if _is_error(said) else None)
        page.on("request", lambda asked: wrong.append(asked.url) if asked.url.startswith("http") else None)
        page.goto(path.resolve().as_uri())
        yield page
        chromium.close()
    assert not wrong, "\n".join(wrong)


def _is_error(said):
    # k3d logs what goes wrong in a script of ours as it logs everything else
    return said.type == "error" or "Error:" in said.text


def picture(page):
    """What is seen, (height, width, 3) array."""
    return np.asarray(Image.open(BytesIO(page.screenshot())).convert("RGB")).astype(int)


def drawn(picture, rows=slice(None), columns=slice(None)):
    """Number of coloured pixels in a part of a picture: text and controls are grey, spheres are not."""
    part = picture[rows, columns]
    return int(np.sum(np.ptp(part, axis=2) > 60))


def wait(page):
    """Until the scene has been drawn: k3d places the camera some time after it has loaded."""
    page.wait_for_function("document.getElementById('of').textContent !== ''", timeout=60_000)
    page.wait_for_timeout(1500)


def fits_a_phone(path):
    """Ends with an error unless a page with an aggregate has all its panels, and the aggregate, on a narrow screen."""
    width, height = 390, 760
    with opened(path, width, height) as page:
        wait(page)
        assert page.evaluate("document.documentElement.scrollWidth") <= width
        boxes = {
            name: page.locator(f"#{name}").bounding_box() for name in ("numbers", "colours", "steps", "picture", "of")
        }
        for box in boxes.values():
            assert box["x"] >= 0 and box["x"] + box["width"] <= width and box["y"] + box["height"] <= height
        assert boxes["colours"]["y"] + boxes["colours"]["height"] <= boxes["steps"]["y"] + 1
        scene = slice(int(boxes["numbers"]["height"]), int(boxes["colours"]["y"]))
        seen = picture(page)
        # the aggregate, and nothing of it beyond the edges
        assert drawn(seen, scene) > 1000
        assert drawn(seen, scene, slice(0, 3)) == drawn(seen, scene, slice(-3, None)) == 0
