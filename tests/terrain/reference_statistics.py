"""Terrain statistics once more, in numpy and SciPy: the witness for the Rust ones.

Written from the definitions alone, plainly and slowly. Heights are ``(256, 256)`` float64 arrays in metres,
``heights[row y][column x]``, 8 m apart and periodic; world coordinates begin at (-1024, -1024).
"""

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt
from scipy import stats

Array = npt.NDArray[np.float64]
Point = Sequence[float]

SIDE = 256
SQUARE = 8.0
TILE = 2048.0
ORIGIN = -1024.0
KM2 = (TILE / 1000.0) ** 2
BANDS = {
    "band_gt600": (600.0, np.inf),
    "band_240_600": (240.0, 600.0),
    "band_125_240": (125.0, 240.0),
    "band_63_125": (63.0, 125.0),
    "band_31_63": (31.5, 63.0),
    "band_lt31": (0.0, 31.5),
}


def terrain_statistics(heights: Array) -> dict[str, float]:
    """All core and supporting statistics of ``(256, 256)`` or ``(257, 257)`` heights."""
    h = np.asarray(heights, dtype=np.float64)[:SIDE, :SIDE]
    found: dict[str, float] = {"sigma_m": float(h.std()), "range_m": float(np.ptp(h))}
    found["spread_p1_p99_m"] = float(np.percentile(h, 99) - np.percentile(h, 1))
    found |= slopes(h) | creases(h) | spectrum(h) | texture(h) | legs(h)
    for lag in (1, 2, 4, 8, 16):
        east, north = np.roll(h, -lag, axis=1) - h, np.roll(h, -lag, axis=0) - h
        found[f"S{8 * lag}_m"] = float(np.sqrt(((east**2).mean() + (north**2).mean()) / 2))
    hills = prominent_peaks(h)
    found["hills_per_km2"] = len(hills) / KM2
    found["basins_per_km2"] = len(prominent_peaks(-h)) / KM2
    found["hill_prom_median_m"] = float(np.median([prominence for _, _, prominence in hills]))
    found["hill_nn_m"] = nearest_neighbour([(x, y) for x, y, _ in hills])
    found["descent_len_mean_m"] = descent_length(h)
    return found


def triangle_gradients(h: Array) -> tuple[Array, Array, Array, Array]:
    """x and y gradients of the triangle with the west side of each square, and of that with the east side."""
    se, nw = np.roll(h, -1, axis=1), np.roll(h, -1, axis=0)
    ne = np.roll(nw, -1, axis=1)
    j, i = np.mgrid[:SIDE, :SIDE]
    even = (i + j) % 2 == 0
    south, north = (se - h) / SQUARE, (ne - nw) / SQUARE
    west, east = (nw - h) / SQUARE, (ne - se) / SQUARE
    # even: (SW, NW, NE) and (SW, SE, NE); odd: (SW, SE, NW) and (SE, NW, NE).
    return np.where(even, north, south), west, np.where(even, south, north), east


def slopes(h: Array) -> dict[str, float]:
    wx, wy, ex, ey = triangle_gradients(h)
    gx, gy = np.stack([wx, ex]), np.stack([wy, ey])
    g = np.hypot(gx, gy)
    slope = np.degrees(np.arctan(g))
    return {
        "slope_mean_deg": float(slope.mean()),
        "slope_p99_deg": float(np.percentile(slope, 99)),
        "frac_lt5": float((slope < 5).mean()),
        "frac_gt30": float((slope > 30).mean()),
        "frac_gt45": float((slope > 45).mean()),
        "grad_cv": float(g.std() / g.mean()),
        "grad_ratio_xy": float(np.sqrt((gx**2).mean() / (gy**2).mean())),
    }


def creases(h: Array) -> dict[str, float]:
    wx, wy, ex, ey = triangle_gradients(h)

    def normals(gx: Array, gy: Array) -> Array:
        n = np.stack([-gx, -gy, np.ones_like(gx)], axis=-1)
        return np.asarray(n / np.linalg.norm(n, axis=-1, keepdims=True))

    west, east = normals(wx, wy), normals(ex, ey)
    j, i = np.mgrid[:SIDE, :SIDE]
    even = ((i + j) % 2 == 0)[..., None]
    # The triangle with the north side and the one with the south side: the west one has the north side of
    # an even square and the south side of an odd one.
    north, south = np.where(even, west, east), np.where(even, east, west)
    pairs = [(west, east), (east, np.roll(west, -1, axis=1)), (north, np.roll(south, -1, axis=0))]
    angles = np.concatenate(
        [
            np.degrees(np.arctan2(np.linalg.norm(np.cross(a, b), axis=-1), (a * b).sum(axis=-1))).ravel()
            for a, b in pairs
        ]
    )
    return {
        "crease_p50_deg": float(np.percentile(angles, 50)),
        "crease_p99_deg": float(np.percentile(angles, 99)),
    }


def spectrum(h: Array) -> dict[str, float]:
    power = np.abs(np.fft.fft2(h - h.mean())) ** 2
    mode = np.fft.fftfreq(SIDE, 1.0 / SIDE)
    radius = np.hypot(*np.meshgrid(mode, mode))
    with np.errstate(divide="ignore"):
        wavelength = TILE / radius
    found = {
        name: float(power[(wavelength >= low) & (wavelength < high)].sum() / power.sum())
        for name, (low, high) in BANDS.items()
    }
    found["band_gt600"] = float(power[wavelength >= 600.0].sum() / power.sum())
    acf = np.fft.ifft2(power).real
    acf /= acf[0, 0]
    ring = np.rint(radius).astype(int)
    curve = np.bincount(ring.ravel(), acf.ravel()) / np.bincount(ring.ravel())

    def falls_below(level: float) -> float:
        k = int(np.argmax(curve < level))
        return float(SQUARE * np.interp(level, [curve[k], curve[k - 1]], [k, k - 1]))

    found["acf_1e_m"], found["acf_zero_m"] = falls_below(float(np.exp(-1))), falls_below(0.0)
    found["acf_min"] = float(curve[:64].min())
    return found


def repetition(heights: Array) -> float:
    """Autocorrelation at a lag of 512 m, the lower of east and north: straight from the definition."""
    h = np.asarray(heights, dtype=np.float64)[:SIDE, :SIDE]
    d = h - h.mean()
    return float(min((d * np.roll(d, 64, axis=axis)).mean() for axis in (0, 1)) / (d * d).mean())


def texture(h: Array) -> dict[str, float]:
    def shift(dx: int, dy: int) -> Array:
        return np.roll(h, (-dy, -dx), axis=(0, 1))

    laplacian = (shift(1, 0) + shift(-1, 0) + shift(0, 1) + shift(0, -1) - 4 * h) / 64
    around = [shift(dx, dy) for dy in (-1, 0, 1) for dx in (-1, 0, 1) if (dx, dy) != (0, 0)]
    return {
        "lap_exkurt": float(stats.kurtosis(laplacian, axis=None)),
        "pits_per_km2": float((np.min(around, axis=0) >= h).sum() / KM2),
        "flat_edge_x": float((np.abs(shift(1, 0) - h) < 0.001).mean()),
    }


def legs(h: Array) -> dict[str, float]:
    drops: list[float] = []
    for profile in [*h, *h.T]:
        closed = np.roll(profile, -int(np.argmax(profile)))
        drops += leg_drops([*closed.tolist(), float(closed[0])])
    return {
        "crest_spacing_m": 512 * TILE / len(drops),
        "leg_drop_mean_m": float(np.mean(drops)),
        "leg_drop_p90_m": float(np.percentile(drops, 90)),
    }


def leg_drops(profile: list[float], reversal: float = 3.0) -> list[float]:
    """Drops from a top to the next bottom of a profile that begins and ends at its highest point."""
    turns = turning_points(profile, reversal)
    return [
        top - bottom for top, bottom in zip(turns[::2], turns[1::2], strict=False) if top - bottom >= reversal
    ]


def turning_points(profile: list[float], reversal: float) -> list[float]:
    """Alternating tops and bottoms, beginning with the first sample as a top."""
    turns, extreme, down = [profile[0]], profile[0], True
    for height in profile[1:]:
        extreme = min(extreme, height) if down else max(extreme, height)
        if abs(height - extreme) >= reversal:
            turns.append(extreme)
            extreme, down = height, not down
    return turns


def prominent_peaks(h: Array, least: float = 10.0) -> list[tuple[int, int, float]]:
    """(x, y, prominence) of all peaks of at least ``least`` metres of prominence: water sinks from the top.

    Of equal heights the first one counts as the higher.
    """
    flat = h.ravel()
    parent: dict[int, int] = {}
    found: list[tuple[int, int, float]] = []

    def root(k: int) -> int:
        while parent[k] != k:
            parent[k] = parent[parent[k]]
            k = parent[k]
        return k

    order = [int(k) for k in np.argsort(-flat, kind="stable")]
    for k in order:
        parent[k] = k
        y, x = divmod(k, SIDE)
        for dy in (-1, 0, 1):
            for dx in (-1, 0, 1):
                other = (y + dy) % SIDE * SIDE + (x + dx) % SIDE
                if other not in parent:
                    continue
                a, b = root(k), root(other)
                if a == b:
                    continue
                high, low = (a, b) if (-flat[a], a) < (-flat[b], b) else (b, a)
                if flat[low] - flat[k] >= least:
                    found.append((low % SIDE, low // SIDE, float(flat[low] - flat[k])))
                parent[low] = high
    top = order[0]
    return [*found, (top % SIDE, top // SIDE, float(np.ptp(flat)))]


def nearest_neighbour(points: list[tuple[int, int]]) -> float:
    at = np.array(points)
    apart = np.abs(at[:, None] - at[None, :])
    distance = np.hypot(*np.moveaxis(np.minimum(apart, SIDE - apart), -1, 0))
    np.fill_diagonal(distance, np.inf)
    return float(SQUARE * distance.min(axis=1).mean())


def descent_length(h: Array) -> float:
    steps = [(dx, dy) for dy in (-1, 0, 1) for dx in (-1, 0, 1) if (dx, dy) != (0, 0)]
    steepness = np.stack(
        [(h - np.roll(h, (-dy, -dx), axis=(0, 1))) / (SQUARE * np.hypot(dx, dy)) for dx, dy in steps]
    )
    best, downhill = steepness.argmax(axis=0), steepness.max(axis=0) > 0
    lengths = []
    for start_y in range(0, SIDE, 2):
        for start_x in range(0, SIDE, 2):
            x, y, length = start_x, start_y, 0.0
            while downhill[y, x]:
                dx, dy = steps[best[y, x]]
                length += SQUARE * float(np.hypot(dx, dy))
                x, y = (x + dx) % SIDE, (y + dy) % SIDE
            lengths.append(length)
    return float(np.mean(lengths))


def ground(h: Array, x: Array, y: Array) -> Array:
    """Height of the triangles at world positions: barycentric in the triangle that holds the point."""
    gx, gy = (np.asarray(x) - ORIGIN) / SQUARE, (np.asarray(y) - ORIGIN) / SQUARE
    i, j = np.floor(gx).astype(int), np.floor(gy).astype(int)
    u, v = gx - i, gy - j

    def at(a: npt.NDArray[np.int_], b: npt.NDArray[np.int_]) -> Array:
        return np.asarray(h[b % SIDE, a % SIDE])

    sw, se, nw, ne = at(i, j), at(i + 1, j), at(i, j + 1), at(i + 1, j + 1)
    even = (i + j) % 2 == 0
    upper_even = (1 - v) * sw + u * ne + (v - u) * nw
    lower_even = (1 - u) * sw + v * ne + (u - v) * se
    lower_odd = (1 - u - v) * sw + u * se + v * nw
    upper_odd = (u + v - 1) * ne + (1 - u) * nw + (1 - v) * se
    upper = np.where(even, upper_even, upper_odd)
    lower = np.where(even, lower_even, lower_odd)
    return np.asarray(np.where(np.where(even, v > u, u + v > 1), upper, lower))


def mission_statistics(
    heights: Array, flags: Sequence[Point], centre: Point, ends: Sequence[Point]
) -> dict[str, float]:
    """The statistics of a mission's ground: two flags, the bridge's centre and its two ends (x, y, ...)."""
    h = np.asarray(heights, dtype=np.float64)[:SIDE, :SIDE]
    f0, f1, c, a, b = (np.array(point[:2], dtype=np.float64) for point in (*flags, centre, *ends))
    distance = float(np.linalg.norm(f1 - f0))
    direction = (f1 - f0) / distance

    def line(p: Array, q: Array, shares: Array) -> Array:
        return ground(h, p[0] + (q[0] - p[0]) * shares, p[1] + (q[1] - p[1]) * shares)

    flag_ground = line(f0, f1, np.array([0.0, 1.0]))
    gorge = line(a, b, np.linspace(0.0, 1.0, 129))
    low, rim = int(np.argmin(gorge)), (gorge[0] + gorge[-1]) / 2
    walls = [
        float(np.degrees(np.arctan(np.abs(side[24:] - side[:-24]).max() / 24)))
        for side in (gorge[: low + 1], gorge[low:])
    ]
    # A distance that falls short of whole metres by rounding alone counts as whole.
    metres = np.arange(0.0, np.floor(distance + 1e-6) + 1)
    profile = line(f0, f1, metres / distance)
    sight = flag_ground[0] + 17.6 + (flag_ground[1] - flag_ground[0]) * metres / distance
    tops = [t for t in profile_tops(profile.tolist(), 3.0) if 8 < t < distance - 8]
    pads = [pad(h, flag) for flag in (f0, f1)]
    j, i = np.mgrid[-128:384, -128:384]
    near = np.hypot(ORIGIN + SQUARE * i - c[0], ORIGIN + SQUARE * j - c[1]) <= 150
    offset = c - f0
    return {
        "flag_dist_m": distance,
        "flag_dz_m": float(abs(flag_ground[1] - flag_ground[0])),
        "bridge_off_line_m": float(abs(direction[0] * offset[1] - direction[1] * offset[0])),
        "bridge_fraction": float(np.linalg.norm(offset)) / distance,
        "gorge_depth_m": float(rim - gorge.min()),
        "rim_diff_m": float(abs(gorge[0] - gorge[-1])),
        "wall_max_deg": max(walls),
        "wall_min_deg": min(walls),
        "los_block_m": float((profile - sight).max()),
        "ridges_on_line": float(len(tops)),
        "ascent_m": float(np.maximum(np.diff(profile), 0).sum()),
        "pad_resid_m": max(p[0] for p in pads),
        "pad_slope_deg": max(p[1] for p in pads),
        "guard_top_above_rim_m": float(h[j[near] % SIDE, i[near] % SIDE].max() - rim),
    }


def profile_tops(profile: list[float], reversal: float) -> list[int]:
    """Where an open profile has tops: it falls by ``reversal`` after them, and rose by as much before."""
    tops, at, up = [], 0, True
    for k, height in enumerate(profile):
        if (height > profile[at]) if up else (height < profile[at]):
            at = k
        if abs(height - profile[at]) >= reversal:
            if up:
                tops.append(at)
            at, up = k, not up
    return tops


def pad(h: Array, flag: Array) -> tuple[float, float]:
    """Standard deviation about the least-squares plane within 24 m, and the plane's slope in degrees."""
    j, i = np.mgrid[-3:4, -3:4]
    inside = np.hypot(i, j) <= 3
    dx, dy = SQUARE * i[inside], SQUARE * j[inside]
    z = ground(h, flag[0] + dx, flag[1] + dy)
    design = np.column_stack([dx, dy, np.ones_like(dx)])
    plane = np.linalg.lstsq(design, z, rcond=None)[0]
    return float((z - design @ plane).std()), float(np.degrees(np.arctan(np.hypot(plane[0], plane[1]))))
