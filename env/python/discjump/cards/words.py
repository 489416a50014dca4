"""What numbers of observations, actions and rewards mean."""

OBSERVATION = {
    "velocity": "forward, right, up",
    "speed": "horizontal",
    "beacon_direction": "unit vector on the map: forward, right",
    "beacon_distance": "horizontal",
    "beacon_nearness": "30 / (30 + distance)",
    "beacon_height": "beacon over feet",
    "goal_direction": "unit vector on the map: forward, right",
    "goal_distance": "horizontal",
    "goal_nearness": "30 / (30 + distance)",
    "goal_height": "goal over feet",
    "closing_speed": "horizontal, towards the goal",
    "lateral_speed": "across the line to it, positive to the right",
    "ground_normal": "below the player: forward, right",
    "height_bend": "h / (h + 3) of the height h over ground",
    "height": "over ground",
    "energy": "jet energy (scale: the armor's tank)",
    "jump_grace": "time left in which the last contact allows a jump",
    "jetting": "whether the jets burn",
    "damage": "taken so far (scale: what kills the armor)",
    "landing_time": "until the player comes down if he lets himself fall; 3 if later",
    "landing_normal": "of the ground there: forward, right",
    "landing_impact": "speed into the ground there; 0 if later",
    "landing_slope": "rise of the ground there along the flight",
    "landing_rise": "ground there over feet now",
    "fan": "rise of the ground from below the player to a point ahead, over the distance; bearing by "
    "bearing, near "
    "to far",
    "goal_near": "way to the goal, for the last metres: forward, right, up",
    "apex_gap": "height that the flight will lack: goal over the height that the upward speed leads to, "
    "without "
    "jets",
    "reload": "time until the launcher is ready, over that of a whole cycle",
    "ammo": "discs left, over those at the start",
    "disc": "the last disc under way, from the feet: forward, right, up; 0 where there is none",
    "disc_flying": "whether there is one",
    "carrying": "whether the player has the enemy flag",
    "outside_time": "time outside the mission area with the flag; it goes home after 4.5 s",
    "axis": "direction from the stand that was left to the one that is sought, along which bases open: "
    "forward, "
    "right",
    "axis_distance": "of the goal from the line along it through the player, positive to the right",
}
for _way, _time in {
    "burst": "the same after a burst of the jets straight up, half a second long or until the energy "
    "is used: time",
    "burn": "the same after burning all the energy straight up: time",
    "left": "the same after a burst as short to the left of the way that the player moves: time",
    "right": "the same after a burst as short to the right: time",
}.items():
    OBSERVATION[f"{_way}_time"] = _time
    for _part in ("normal", "impact", "slope", "rise"):
        OBSERVATION[f"{_way}_{_part}"] = OBSERVATION[f"landing_{_part}"]
"""Of every field of an observation."""

ACTION = (
    ("forward", "back, none, forward", "beyond +-1/3"),
    ("strafe", "left, none, right", "beyond +-1/3"),
    ("jump", "no, yes: held, it asks for a jump in every tick, which is what skiing is", "above 0"),
    ("jet", "no, yes", "above 0"),
    ("turn", "from `turn_rate` to the right, over none, to `turn_rate` to the left", "proportional"),
    ("fire", "no, yes", "above 0"),
    ("pitch", "-88, -66, -44, -22, 0 degrees, at once", "proportional, +-88 degrees"),
)
"""Name, choices, and what a number in [-1, 1] means instead, of every number of an action."""

REWARD = {
    "progress": "metres that are left less: the difference of a potential, so it cannot be farmed",
    "time": "seconds",
    "arrival": "once, on success",
    "death": "once, on death",
    "climb": "in what is left, a metre of height that the flight will lack counts so many metres",
}
"""Of every weight."""

LEFT = {
    "beacon": "the horizontal distance to the beacon",
    "marker": "the distance to the marker, and the height that the flight will lack times `climb`",
    "stands": "the distance to the flag that is sought; where it must be brought home also the way home, "
    "until "
    "it is taken",
}
"""What is left to be done, by kind of goal."""

START = {
    "beacon": "uniform in the mission area (the whole map where it has no mission), on the ground, any "
    "yaw, at rest "
    "in half of the episodes, else with a horizontal velocity; the beacon on the ground "
    "within the area. Courses that "
    "do not fit are drawn again, 64 times, then run along the area's "
    "diagonal",
    "marker": "uniform in the mission area, any yaw; on the ground in half of the episodes, else above it; "
    "at rest "
    "in half, else with a horizontal velocity. The marker floats over the ground at the start, "
    "off to a side",
    "stands": "either team; at rest by the own flag stand, looking anywhere, or a place in the "
    "mission area, on the "
    "ground or on what stands there",
}
"""Where an episode starts, by kind of goal."""

END = {
    "beacon": "the path comes within {radius:g} m of the beacon, horizontally",
    "marker": "the path of the feet comes within {radius:g} m of the marker",
    "stands": "the path of the feet comes within {radius:g} m of the enemy flag's foot, within the mission "
    "area",
    "capture": "the enemy flag was taken, and the path of the feet comes within {radius:g} m of "
    "the own flag's foot "
    "with it. Outside the mission area for 4.5 s it is lost, and back on its stand",
}
"""What success is, by kind of goal."""

SCORE = {
    "seconds": "time until success; a failure counts as the time limit. Less is better",
    "share": "share of the episodes that succeed, also by height of the marker. More is better",
}
"""By how a task is scored."""
