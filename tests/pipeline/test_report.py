"""The list of figures in the report."""

import pytest

from ratd.experiments.collision import plan as collision
from ratd.experiments.compression import plan as compression
from ratd.experiments.spin_up import plan as spin_up
from ratd.pipeline.report import figure_labels


@pytest.mark.parametrize("experiment", [spin_up, compression, collision])
def test_figures_stand_in_the_order_of_their_numbers_and_say_what_they_show(experiment):
    """The report sorts by labels as text, and its list is blank where one file has another set of labels."""
    figures = [figure_labels(name, shows, "png") for name, shows in experiment.TITLES.items()]
    assert all(set(own) == {"figure", "shows", "format"} and own["shows"] for own in figures)
    listed = [figure["figure"] for figure in sorted(figures, key=lambda own: list(own.values()))]
    numbers = [int(own) for own in listed if own != "study"]
    assert numbers == sorted(numbers) and listed == [f"{n:>2}" for n in numbers] + ["study"] * (
        len(listed) - len(numbers)
    )


def test_every_figure_has_a_title():
    assert set(spin_up.TITLES) == {*spin_up.FIGURES, *spin_up.COMMON_FIGURES}
    assert set(compression.TITLES) == set(compression.FIGURES) and set(collision.TITLES) == set(collision.FIGURES)
