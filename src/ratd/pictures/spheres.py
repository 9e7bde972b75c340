"""Shaded pictures of spheres, seen from infinitely far away.

Drawn pixel by pixel with a depth buffer: a picture needs no display, no graphics library of the system and no graphics
card, and its bytes are the same on every machine.
"""

import numpy as np

from ratd.base.jit import jit

LIGHT = np.array([-0.45, 0.55, 0.70]) / np.linalg.norm([-0.45, 0.55, 0.70])
"""Direction towards the light: from the upper left, on the side of the viewer."""
AMBIENT = 0.40
"""Brightness of a surface that the light does not reach."""
FADE = 0.35
"""Loss of brightness from the nearest to the farthest sphere, which tells depth."""
EDGE = 0.30
"""Cosine of the angle of view below which a sphere is darkened, so that each stands out from those behind."""
SUPERSAMPLING = 3
"""Pixels are drawn this many times finer along each axis and averaged."""


def view_axes(forward, up):
    """Axes of a picture: right, up, and towards the viewer.

    Parameters
    ----------
    forward : (3,) array_like
        Direction towards the viewer.
    up : (3,) array_like
        Direction that points upwards in the picture, not along `forward`.

    Returns
    -------
    (3, 3) numpy.ndarray
        Unit vectors as rows, right-handed; `position @ view_axes(...).T` are coordinates in the picture.
    """
    forward = np.asarray(forward, dtype=float) / np.linalg.norm(forward)
    right = np.cross(up, forward)
    right /= np.linalg.norm(right)
    return np.stack([right, np.cross(forward, right), forward])


def render(position, radius, colour, half_width, pixels=360):
    """Picture of spheres.

    Parameters
    ----------
    position : (n, 3) array_like
        Centres in the coordinates of the picture: right, up, towards the viewer [m].
    radius : (n,) array_like
        Radii [m].
    colour : (..., n, 3) array_like
        Red, green, blue of each sphere, 0 to 1; several pictures of the same spheres cost little more than one.
    half_width : float
        The picture shows -half_width to half_width along both axes [m].
    pixels : int
        Width and height.

    Returns
    -------
    (..., pixels, pixels, 4) numpy.ndarray of uint8
        Red, green, blue, opacity; the first row is at the top. Where there is no sphere the picture is transparent.
    """
    position, radius, colour = (np.asarray(values, dtype=float) for values in (position, radius, colour))
    fine = SUPERSAMPLING * pixels
    owner, bright = _seen(position, radius, ((np.arange(fine) + 0.5) / fine * 2 - 1) * half_width)
    blocks = np.zeros((*colour.shape[:-2], pixels, pixels, 4))
    for row, column in np.ndindex(SUPERSAMPLING, SUPERSAMPLING):
        own = (slice(row, None, SUPERSAMPLING), slice(column, None, SUPERSAMPLING))
        blocks[..., :3] += colour[..., owner[own], :] * bright[own][..., None]
        blocks[..., 3] += owner[own] >= 0
    blocks /= SUPERSAMPLING**2
    opacity = blocks[..., 3:]
    np.divide(blocks[..., :3], opacity, out=blocks[..., :3], where=opacity > 0)
    return np.rint(255 * np.clip(blocks, 0, 1)).astype(np.uint8)


def _seen(position, radius, centre):
    """Which sphere is seen in each pixel, -1 for none, and how bright it is there: (n, n) each, row 0 at the top.

    `centre` (n,) are the places of the pixels along both axes.
    """
    depth = np.full((len(centre), len(centre)), -np.inf)  # row 0 at the bottom
    owner = np.full(depth.shape, -1)
    bright = np.zeros(depth.shape)
    _find_nearest(np.ascontiguousarray(position), radius, centre, depth, owner)
    covered = np.nonzero(owner >= 0)
    if len(covered[0]):
        seen, depth = owner[covered], depth[covered]
        nx, ny = ((centre[place] - position[seen, k]) / radius[seen] for k, place in enumerate(covered[::-1]))
        nz = np.sqrt(1.0 - nx**2 - ny**2)
        light = np.maximum(0.0, nx * LIGHT[0] + ny * LIGHT[1] + nz * LIGHT[2])
        shade = (AMBIENT + (1 - AMBIENT) * light) * np.minimum(1.0, 0.45 + 0.55 * nz / EDGE)
        near, far = depth.max(), depth.min()
        bright[covered] = shade * (1 - FADE * (near - depth) / max(near - far, np.finfo(float).tiny))
    return owner[::-1], bright[::-1]


# nothing fused, so that a pixel is the same on every machine
@jit(fastmath=False)
def _find_nearest(position, radius, centre, depth, owner):
    """Fill in the greatest height in each pixel, and the number of the sphere that has it."""
    for k in range(len(radius)):
        x, y, z = position[k]
        a = radius[k]
        left, right = np.searchsorted(centre, x - a), np.searchsorted(centre, x + a)
        for row in range(np.searchsorted(centre, y - a), np.searchsorted(centre, y + a)):
            above = ((centre[row] - y) / a) ** 2
            for column in range(left, right):
                square = 1.0 - ((centre[column] - x) / a) ** 2 - above
                if square > 0.0:
                    surface = z + a * np.sqrt(square)
                    if surface > depth[row, column]:
                        depth[row, column] = surface
                        owner[row, column] = k


def show(axes, picture, half_width):
    """Put a picture into a panel with axes in nm, without frame, and draw a scale bar.

    Parameters
    ----------
    axes : matplotlib.axes.Axes
    picture : numpy.ndarray
        From `render`.
    half_width : float
        As in `render` [m].
    """
    edge = half_width * 1e9
    axes.imshow(picture, extent=(-edge, edge, -edge, edge), interpolation="antialiased", zorder=2)
    axes.set(xlim=(-edge, edge), ylim=(-edge, edge), aspect="equal")
    axes.set_axis_off()
    length = scale_length(0.7 * edge)
    axes.plot([0.95 * edge - length, 0.95 * edge], [-0.97 * edge] * 2, color="black", lw=1.6, zorder=3)
    axes.text(0.95 * edge - 0.5 * length, -0.93 * edge, f"{length:g} nm", ha="center", va="bottom", zorder=3)


def outline(position, radius):
    """Left, right, bottom, top of spheres of some radii (n,) at (n, 2) or (n, 3) in the coordinates of the picture."""
    position, radius = np.asarray(position, dtype=float), np.asarray(radius, dtype=float)
    x, y = position[:, 0], position[:, 1]
    return np.array([np.min(x - radius), np.max(x + radius), np.min(y - radius), np.max(y + radius)])


def scale_length(greatest):
    """Greatest of 1, 2, 5, 10, 20, ... that is not above a number."""
    power = 10.0 ** np.floor(np.log10(greatest))
    return float(max(m * power for m in (1, 2, 5) if m * power <= greatest * (1 + 1e-9)))
