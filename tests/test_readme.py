"""The Python of README.md, as a reader would type it."""

from pathlib import Path

import matplotlib.pyplot as plt
import pytest

import ratd

README = Path(__file__).parents[1] / "README.md"


def test_one_grain():
    """With a grain that takes a second, and without the last line, whose spin-up may take long."""
    text = README.read_text(encoding="utf-8").split("\n## One grain\n")[1].split("The same of the pipeline")[0]
    lines = [line[4:] for line in text.splitlines() if line.startswith("    ")]
    assert "ratd.spin_up(own" in lines[-1] and "200e-9" in text
    own = ratd.grow("BA", 60e-9, "q-S", 0)
    names = {"position": own.position, "radius": own.radius}
    exec("\n".join(lines[:-1]).replace("200e-9", "60e-9"), names)
    (line,) = plt.gca().get_lines()
    plt.close()
    assert line.get_ydata() == pytest.approx(names["run"]["mass"].values)
    assert line.get_xdata() == pytest.approx(names["run"]["omega"].values)
    assert names["own"].n_contacts == own.n_contacts
