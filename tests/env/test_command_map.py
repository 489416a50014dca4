"""The command map shows what it says it shows, and always in the same bytes."""

from itertools import pairwise

import numpy as np
import pytest

import discjump
from discjump.envs import canvas, command_map, relief
from discjump.envs.command_map import CommandMap
from discjump.envs.named import SkiEnv, SkiVectorEnv

from .play import SHORT, random_actions, same_bits


def plane(east=0.0, north=0.0, edge="clamp"):
    y, x = np.mgrid[0:65, 0:65] * 8.0
    return discjump.Terrain.from_heights(east * x + north * y, edge=edge)


def picture(env):
    """What `render` returns, which must not be None."""
    image = env.render()
    assert image is not None
    return image


def where(image, colour, tolerance=12):
    """Rows and columns of the pixels of a colour."""
    return np.argwhere(np.abs(image.astype(int) - colour).max(axis=-1) <= tolerance)


def test_frame_of_a_running_episode():
    env = SkiEnv(render_mode="rgb_array", terrain_seeds=[0])
    env.reset(seed=1)
    frames = [picture(env)]
    for action in random_actions(0, 20, 1)[:, 0]:
        env.step(action)
        frames.append(picture(env))
    assert all(frame.dtype == np.uint8 and frame.shape == (400, 400, 3) for frame in frames)
    assert all(one.tobytes() != other.tobytes() for one, other in pairwise(frames))
    again = SkiEnv(render_mode="rgb_array", terrain_seeds=[0])
    again.reset(seed=1)
    for action in random_actions(0, 20, 1)[:, 0]:
        again.step(action)
    same_bits(picture(again), frames[-1])


def test_pictures_of_the_vector_are_those_of_the_single_environments():
    envs = SkiVectorEnv(3, render_mode="rgb_array", **SHORT)
    alone = [SkiEnv(render_mode="rgb_array", **SHORT) for _ in range(3)]
    envs.reset(seed=5)
    waiting = [False] * 3
    for index, env in enumerate(alone):
        env.reset(seed=5 + index)
    for t, action in enumerate(random_actions(3, 60, 3)):
        envs.step(action)
        for index, env in enumerate(alone):
            if waiting[index]:
                env.reset()
                waiting[index] = False
            else:
                waiting[index] = any(env.step(action[index])[2:4])
        if t % 7 == 0:
            frames = envs.render()
            assert frames is not None
            for frame, env in zip(frames, alone, strict=True):
                same_bits(frame, picture(env))


def test_without_render_mode_there_is_no_picture():
    env = SkiEnv(terrain_seeds=[0])
    env.reset(seed=0)
    assert env.render() is None


def test_the_beacon_is_where_it_is():
    path = np.array([[100.0, 100.0, 5.0]])
    image = CommandMap(plane()).draw(path=path, yaw=0.0, beacon=np.array([300.0, 200.0]), arrival_radius=8.0)
    rows, columns = where(image, command_map.BEACON).mean(axis=0)
    here = where(image, command_map.AREA)
    arrow = here[(here[:, 0] < 350)]  # without the scale bar
    # East is right, north is up, and both at the scale of the bar.
    side = 400 / CommandMap(plane())._fit(np.array([[100.0, 100.0], [300.0, 200.0]])).side
    assert columns - arrow[:, 1].mean() == pytest.approx(200 * side, abs=3)
    assert arrow[:, 0].mean() - rows == pytest.approx(100 * side, abs=3)


@pytest.mark.parametrize(
    ("yaw", "row", "column"), [(0.0, -1, 0), (np.pi / 2, 0, -1), (np.pi, 1, 0), (-np.pi / 2, 0, 1)]
)
def test_the_arrow_points_along_the_heading(yaw, row, column):
    start = np.array([[200.0, 200.0, 0.0]])
    drawn = CommandMap(plane()).draw(path=start, yaw=yaw, beacon=np.array([450.0, 60.0]), arrival_radius=8.0)
    tip = where(drawn, command_map.INK, 60)
    centre = where(drawn, command_map.AREA)
    tip, centre = tip[tip[:, 0] < 350], centre[centre[:, 0] < 350]
    # The tip is the ink farthest from the middle of the arrow.
    middle = centre.mean(axis=0)
    far = tip[np.argmax(np.hypot(*(tip - middle).T))] - middle
    assert np.dot(far, (row, column)) > 0.8 * np.hypot(*far)


def test_light_comes_from_the_north_west():
    def brightness(terrain):
        return relief.shaded(terrain, 100, 100, 200, 50).mean()

    # A plane that falls to the north or to the west looks to the light.
    assert brightness(plane(north=-0.5)) > brightness(plane(north=0.5))
    assert brightness(plane(east=0.5)) > brightness(plane(east=-0.5))


def test_contours_lie_every_ten_metres():
    # A plane that climbs 0.4 to the east, between two of the stronger contours: a line every 25 m.
    image = relief.shaded(plane(east=0.4), 130, 100, 100, 200)
    profile = image[100].sum(axis=-1)
    beside = np.minimum(np.roll(profile, 6), np.roll(profile, -6))
    darker = profile < 0.97 * beside
    lines = np.flatnonzero(darker & ~np.roll(darker, 1))
    np.testing.assert_allclose(130 + (lines + 1) * 0.5, [150, 175, 200, 225], atol=1.0)


def test_ground_that_is_not_there_has_its_own_colour():
    image = relief.shaded(plane(edge="void"), -100, 100, 200, 100)
    np.testing.assert_array_equal(image[:, :49], np.broadcast_to(relief.VOID, (100, 49, 3)))
    assert not (image[:, 51:] == relief.VOID).all(axis=-1).any()


def test_colours_grow_lighter_with_speed():
    colours = canvas.speed_colours(np.linspace(0, 1, 20))
    luminance = colours @ [0.2126, 0.7152, 0.0722]
    assert (np.diff(luminance) > 0).all()
    same_bits(canvas.speed_colours(np.array([-1.0, 2.0])), canvas.speed_colours(np.array([0.0, 1.0])))


def test_strokes_cover_what_geometry_says():
    image = np.zeros((60, 60, 3))
    canvas.polyline(image, np.array([[10.0, 30.0], [50.0, 30.0]]), 2.0, np.array([[255.0, 255.0, 255.0]]))
    assert image[..., 0].sum() / 255 == pytest.approx(40 * 4 + np.pi * 4, rel=0.03)
    image = np.zeros((60, 60, 3))
    canvas.disc(image, np.array([29.5, 29.5]), 12.0, (255, 0, 0))
    assert image[..., 0].sum() / 255 == pytest.approx(np.pi * 144, rel=0.01)
    assert image[..., 1:].sum() == 0


def test_what_lies_outside_is_clipped():
    image = np.zeros((20, 20, 3))
    canvas.polyline(image, np.array([[-500.0, 5.0], [-400.0, 900.0]]), 3.0, np.array([[255.0] * 3]))
    canvas.disc(image, np.array([1e4, -1e4]), 5.0, (255, 255, 255))
    assert not image.any()
