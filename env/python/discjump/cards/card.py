"""The card of a task, as Markdown, from its options, its scene and its environments."""

from collections.abc import Iterable, Mapping
from typing import Any

import gymnasium

from discjump.cards import words
from discjump.envs.options import DIFFICULTIES, DiscJumpOptions, TaskOptions
from discjump.envs.tasks import Task
from discjump.simulator import SCENES

SCENE = {"beacon": "ski", "marker": "disc_jump", "stands": "mission"}


def card(task: Task, scores: Mapping[str, Any] | None = None) -> str:
    """The card of a task.

    Args:
        task: of the table `discjump.envs.tasks.TASKS`.
        scores: reference scores: `command`, `course`, and `heading` and `rows` of a table, as text; none
            where None.

    >>> from discjump.envs.tasks import SKI
    >>> card(SKI).splitlines()[0]
    '# discjump/Ski-v0'
    """
    options = task.options()
    env: Any = gymnasium.make(task.id, terrain_seeds=[0]).unwrapped
    summary = (type(env).__doc__ or "").strip().splitlines()[0]
    lines = [
        f"# {task.id}",
        "",
        summary,
        "",
        *_scene(options),
        "",
        "## Episode",
        "",
        *_episode(task, options),
        "",
        *_difficulties(options),
        "",
        "`curriculum=True`: each environment begins easy, goes up after 3 successes in a row and down "
        "after 3",
        "failures. Options and their defaults, armor, terrain pool and tier among them:",
        f"`discjump.envs.options.{task.options.__name__}`.",
        "",
        "## Action",
        "",
        *_action(env.action_space.nvec),
        "",
        "## Observation",
        "",
        *_observation(env),
        "",
        *_jet_landings(task, env),
        "",
        "## Reward",
        "",
        *_reward(options),
        *_scores(scores),
        "",
    ]
    return "\n".join(lines)


def _scene(options: TaskOptions) -> list[str]:
    scene = SCENES[SCENE[options.GROUNDS]]
    flags = ", flags (by the task)" if options.GROUNDS == "stands" else ""
    left_out = [name for name in scene.leaves_out if not (flags and name == "flags")]
    return [
        f"**Modelled** (scene `{scene.name}`): {', '.join(scene.models)}{flags}.",
        f"**Left out**: {', '.join([*left_out, 'other players'])}.",
    ]


def _episode(task: Task, options: TaskOptions) -> list[str]:
    grounds = "capture" if options.extras()["capture"] else options.GROUNDS
    success = words.END[grounds].format(radius=options.arrival_radius)
    blast = " or an explosion" if "blast" in SCENES[SCENE[options.GROUNDS]].models else ""
    return [
        f"- **Start**: {words.START[options.GROUNDS]}.",
        f"- **Decision**: every {options.frame_skip} ticks of {options.tick_ms} ms; keys are held in "
        f"between.",
        f"- **Success**: {success}. Tested on the segment of every tick; it terminates the episode.",
        f"- **Death**, by a landing{blast}, terminates it too, and wins over success in its tick.",
        f"- **Truncated** after {options.time_limit:g} s, on the exact tick, also inside a decision.",
        f"- **Score**: {words.SCORE[task.score]}.",
    ]


def _difficulties(options: TaskOptions) -> list[str]:
    marker = isinstance(options, DiscJumpOptions)
    head = {
        "beacon": "distance of the beacon, m",
        "marker": "height of the marker over the ground (light), m",
        "stands": "distance of the start from the enemy flag, m",
    }[options.GROUNDS]
    rows = [["difficulty", head, "start speed, m/s"]]
    if marker:
        rows[0] += ["marker aside, m", "start height, m"]
    rows.append(["---"] * len(rows[0]))
    for name in DIFFICULTIES:
        level = options.level(name)
        low, high = level.goal_distance
        where = (
            f"up to {level.aside:g} m off the own stand" if level.from_stand else f"{low:.4g} to {high:.4g}"
        )
        cells = [name, where, f"up to {level.start_speed:g}"]
        if marker:
            cells += [f"up to {level.aside:g}", f"up to {level.start_height:g}"]
        rows.append(cells)
    return [f"| {' | '.join(cells)} |" for cells in rows]


def _action(bins: Any) -> list[str]:
    numbers = [int(n) for n in bins]
    return [
        f'`MultiDiscrete({numbers})`, or with `actions="box"` as many numbers in [-1, 1]:',
        "",
        "| number | choices | in a `Box` |",
        "|---|---|---|",
        *(f"| {name} | {what} | {box} |" for name, what, box in words.ACTION[: len(numbers)]),
    ]


def _observation(env: Any) -> list[str]:
    return [
        f"One flat float32 `Box` of {env.observation_space.shape[0]} numbers, clipped to [-8, 8];",
        "`env.unwrapped.observation_layout` gives (name, slice, unit, scale), and number x scale is in the "
        "unit.",
        "Horizontal vectors are (forward, right) of the player's yaw.",
        "",
        *_fields(env.observation_layout),
    ]


def _jet_landings(task: Task, env: Any) -> list[str]:
    wide: Any = gymnasium.make(task.id, terrain_seeds=[0], jet_landings=True).unwrapped
    plain = {one.name for one in env.observation_layout}
    return [
        f"With `jet_landings=True` {wide.observation_space.shape[0]} numbers, these before the fan:",
        "",
        *_fields(one for one in wide.observation_layout if one.name not in plain),
    ]


def _fields(layout: Iterable[Any]) -> list[str]:
    return [
        "| name | numbers | unit | scale | meaning |",
        "|---|---|---|---|---|",
        *(
            f"| {one.name} | {one.slice.stop - one.slice.start} | {one.unit} | {float(one.scale):.6g} | "
            f"{words.OBSERVATION[one.name]} |"
            for one in layout
        ),
    ]


def _reward(options: TaskOptions) -> list[str]:
    return [
        "| term | weight | of |",
        "|---|---|---|",
        *(
            f"| {name} | {value:g} | {words.REWARD[name]} |"
            for name, value in options.reward.items()
            if value
        ),
        "",
        f"What is left is {words.LEFT[options.GROUNDS]}. `reward={{...}}` changes weights; `reward_fn` "
        "and `observation_fn` put functions of your own in place of reward and observation "
        "(`discjump.envs.callables`).",
    ]


def _scores(scores: Mapping[str, Any] | None) -> list[str]:
    if scores is None:
        return []
    return [
        "",
        "## Reference scores",
        "",
        f"`{scores['course']}`, by `{scores['command']}`:",
        "",
        *(f"| {' | '.join(cells)} |" for cells in [scores["heading"], ["---"] * len(scores["heading"])]),
        *(f"| {' | '.join(cells)} |" for cells in scores["rows"]),
    ]
