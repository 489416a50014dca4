"""Replays: what was recorded happens again bit for bit, or is caught.

A replay is a claim that an episode is a function of what is in the file. Everyone who keeps one relies on
three things: that it verifies wherever the same bits are made, that a change of anything in it is noticed,
and that opening a stranger's file does nothing but read it.
"""

import io
import lzma
import pickle
import struct
from dataclasses import asdict
from typing import Any

import numpy as np
import pytest

import discjump
from discjump.envs.named import SkiEnv
from discjump.envs.options import SkiOptions
from discjump.replays import EpisodeReplay, ReplayError, TickReplay, file, load, loads
from discjump.replays.bare import codec

from .recordings import TIERS, bowl, drawn, episode, ticks


@pytest.fixture(scope="module")
def recorded() -> EpisodeReplay:
    return episode()


# ------------------------------------------------------------------------------------ it happens again


@pytest.mark.parametrize("fidelity", TIERS)
@pytest.mark.parametrize("actions", ["multi_discrete", "box"])
def test_an_episode_survives_its_file_and_verifies(fidelity, actions, tmp_path):
    made = episode(fidelity=fidelity, actions=actions)
    read = load(made.save(tmp_path / "deep" / "run.replay"))
    assert isinstance(read, EpisodeReplay)
    assert read.header == made.header
    assert {name: a.tobytes() for name, a in read.arrays.items()} == {
        name: a.tobytes() for name, a in made.arrays.items()
    }
    assert read.actions.dtype == (np.float32 if actions == "box" else np.int8)
    assert read.verify() is None


def test_the_replay_is_what_a_plain_loop_sees(recorded):
    """Actions, last state and outcome are those of the environment itself, stepped by hand."""
    env = SkiEnv(terrain_seeds=[3], time_limit=4.0)
    env.reset(seed=5)
    rng = np.random.default_rng(5)
    for row in recorded.actions:
        action = drawn("multi_discrete", rng)
        assert (action == row).all()
        *_, info = env.step(action)
    assert recorded.arrays["final"][0].tobytes() == env.state().tobytes()
    assert {name: info[name] for name in recorded.outcome} == recorded.outcome


@pytest.mark.parametrize("scene", ["ski", "sandbox", "disc_jump", "mission"])
@pytest.mark.parametrize("fidelity", ["reference", "authentic", "fast"])
def test_ticks_survive_their_file_and_verify(fidelity, scene):
    if scene in ("ski", "sandbox"):
        made = TickReplay.record(bowl(), ticks().inputs, scene=scene, fidelity=fidelity)
    else:
        made = ticks(fidelity, scene)
    read = loads(made.to_bytes())
    assert isinstance(read, TickReplay)
    assert read.verify() is None
    sim = discjump.Simulator(
        bowl(),
        3,
        **{name: value for name, value in made.options.items() if name != "physics"},
    )
    for tick, row in enumerate(read.inputs):
        if tick in read.arrays["explosions.tick"]:
            sim.explode(read.arrays["explosions.points"][0])
        sim.step(row)
    assert sim.state().tobytes() == np.asarray(read.arrays["final"], sim.state_dtype).tobytes()


def test_ticks_that_begin_with_discs_in_the_air():
    """A state alone has no projectiles: such a replay begins with a snapshot, and its discs burst again."""
    sim = discjump.Simulator(bowl(), 3, "disc_jump", players_per_world=3)
    inputs = sim.inputs()
    inputs["fire"], inputs["pitch"] = True, 0.1
    sim.step(inputs, ticks=4)
    assert len(sim.projectiles())
    rows = np.zeros((120, 3), discjump.INPUT)
    made = loads(
        TickReplay.record(
            bowl(), rows, snapshot=sim.snapshot(), scene="disc_jump", players_per_world=3
        ).to_bytes()
    )
    assert made.verify() is None
    assert sum(len(frame.values["blasts"]) for frame in made.play()) == 3
    with pytest.raises(ReplayError, match="layout"):
        made.changed({"options": {**made.options, "fidelity": "fast"}}).verify()


def test_later_episodes_and_asked_places():
    """Episode 2 of a seed, put somewhere: neither is drawn from the episodes before it."""
    import gymnasium

    from discjump.replays import record

    env = record(gymnasium.make("discjump/Ski-v0", terrain_seeds=[0, 3], time_limit=0.5))
    env.reset(seed=9)
    env.step(drawn("multi_discrete", np.random.default_rng(0)))
    env.reset()
    env.reset(options={"start": (0.0, 10.0, 80.0), "terrain_seed": 3})
    for _ in range(4):
        env.step(drawn("multi_discrete", np.random.default_rng(1)))
    cut, last = env.replays
    assert (cut.episode, cut.outcome, len(cut.actions)) == (0, None, 1)
    assert (last.episode, last.seed) == (2, 9)
    assert last.header["reset"] == {"start": [0.0, 10.0, 80.0], "terrain_seed": 3}
    assert cut.verify() is None
    assert last.verify() is None


@pytest.mark.parametrize("surface", ["triangles", "bilinear"])
def test_grounds_of_ones_own_are_in_the_file(surface):
    ground = bowl().with_surface(surface)
    other = discjump.Terrain.from_heights(ground.heights + 1.0, 8.0, (-80.0, -40.0), "clamp", surface)
    made = episode(terrains=[other, ground], goal_distance=(20.0, 60.0))
    read = loads(made.to_bytes())
    assert read.verify() is None
    (plain,) = read.header["terrains"]
    assert read.arrays[plain["heights"]].tobytes() in (ground.heights.tobytes(), other.heights.tobytes())
    spoilt = dict(read.arrays)
    spoilt[plain["heights"]] = np.nextafter(spoilt[plain["heights"]], np.inf)
    with pytest.raises(ReplayError, match="terrain: expected the bits"):
        EpisodeReplay(read.header, spoilt).verify()


def test_a_generated_ground_with_solids():
    ground = discjump.Terrain.raindance(3)
    ground = ground.with_solids([*ground.solids, discjump.Solid.box((4, 4, 10), position=(0, 0, 60))])
    state = discjump.Simulator(ground, 1, "mission").state()
    state["position"] = (0.0, 8.0, 60.0)
    rows = np.zeros((60, 1), discjump.INPUT)
    rows["forward"] = rows["jet"] = 1
    made = loads(TickReplay.record(ground, rows, state, scene="mission").to_bytes())
    assert isinstance(made, TickReplay)
    assert made.terrain().solids_digest() == ground.solids_digest()
    assert made.verify() is None


# --------------------------------------------------------------------------------- what is changed is caught


OTHER_OPTIONS = {
    "fidelity": "engine",
    "armor": "medium",
    "energy_pack": True,
    "tick_ms": 16,
    "frame_skip": 3,
    "turn_rate": 2.0,
    "time_limit": 3.0,
    "goal_distance": [301.0, 800.0],
    "start_speed": 11.0,
    "reward": {"progress": 0.02, "time": -0.1, "arrival": 5.0},
    "fan_ranges": [10.0, 25.0, 50.0],
    "fan_bearings": [0.0, 30.0, -31.0],
    "landing": False,
    "surface": "bilinear",
    "terrain_seeds": [4],
    "repeating": True,
}


@pytest.mark.parametrize("name", OTHER_OPTIONS)
def test_another_option_is_caught(recorded, name):
    other = recorded.changed({"options": {**recorded.options, name: OTHER_OPTIONS[name]}})
    assert loads(other.to_bytes()).verify() is not None


def test_every_option_is_in_the_file(recorded):
    """An option that is not recorded would be another one by default."""
    named = {name for name in asdict(SkiOptions()) if name != "terrains"}
    assert set(recorded.options) == named


@pytest.mark.parametrize(
    ("header", "field"),
    [
        ({"seed": 6}, "state"),
        ({"episode": 1}, "state"),
        ({"reset": {"goal": [0.0, 300.0]}}, "state"),
        ({"terrain": "0" * 32}, "terrain"),
        ({"outcome": None}, "outcome"),
        ({"every": 7}, "state"),
    ],
)
def test_another_entry_of_the_header_is_caught(recorded, header, field):
    mismatch = recorded.changed(header).verify()
    assert mismatch is not None
    assert mismatch.field == field


def test_another_outcome_is_caught(recorded):
    for name, value in recorded.outcome.items():
        other = (not value) if isinstance(value, bool) else value + 1e-9 if isinstance(value, float) else 7
        mismatch = recorded.changed({"outcome": {**recorded.outcome, name: other}}).verify()
        assert mismatch is not None
        assert mismatch.field == f"outcome.{name}"


def test_a_changed_action_is_caught_where_it_acts(recorded):
    rows = recorded.actions.copy()
    rows[10, 4] = (rows[10, 4] + 3) % 7
    mismatch = recorded.changed(arrays={"actions": rows}).verify()
    assert mismatch is not None
    assert (mismatch.field, mismatch.first, mismatch.last) == ("state", 9, 16)
    assert "after one of the decisions 9 to 16" in str(mismatch)


@pytest.mark.parametrize("rows", [slice(0, 10), slice(0, None)])
def test_too_few_and_too_many_actions_are_caught(recorded, rows):
    more = np.concatenate([recorded.actions[rows], recorded.actions[:1]])
    mismatch = recorded.changed(arrays={"actions": more}).verify()
    assert mismatch is not None


def test_every_byte_of_digests_and_final_state_counts(recorded):
    for name in ("digests.state", "digests.output", "final"):
        plain = recorded.arrays[name]
        for k in range(0, plain.nbytes, 5):
            spoilt = bytearray(plain.tobytes())
            spoilt[k] ^= 1
            array = np.frombuffer(bytes(spoilt), plain.dtype).reshape(plain.shape)
            assert recorded.changed(arrays={name: array}).verify() is not None, (name, k)
    for name in ("digests.state", "digests.output"):
        for rows in (recorded.arrays[name][:-1], np.concatenate([recorded.arrays[name]] * 2)):
            assert recorded.changed(arrays={name: rows}).verify() is not None


def test_changed_ticks_are_caught():
    made = ticks()
    assert made.verify() is None
    for name in ("forward", "jet", "fire", "turn", "pitch"):
        inputs = made.inputs
        inputs[name][20:44, 1] = 1 - inputs[name][20:44, 1]
        mismatch = made.changed(arrays={"inputs": inputs}).verify()
        assert mismatch is not None, name
        assert mismatch.last >= 32
        assert mismatch.unit == "tick"
    for name, spoilt in (
        ("explosions.tick", made.arrays["explosions.tick"] + 1),
        ("explosions.points", made.arrays["explosions.points"] + 0.125),
        ("state", np.roll(made.arrays["state"], 1)),
        ("final", np.roll(made.arrays["final"], 1)),
    ):
        assert made.changed(arrays={name: spoilt}).verify() is not None, name
    for name, value in (("armor", "heavy"), ("weapon", "mortar"), ("fidelity", "engine"), ("tick_ms", 31)):
        assert made.changed({"options": {**made.options, name: value}}).verify() is not None, name


# ------------------------------------------------------------------------------------ strangers' files


def test_every_flipped_byte_is_refused(recorded):
    data = recorded.to_bytes()
    for k in range(len(data)):
        spoilt = bytearray(data)
        spoilt[k] ^= 1 << (k % 8)
        with pytest.raises(ReplayError):
            loads(bytes(spoilt))


def test_every_cut_is_refused(recorded):
    data = recorded.to_bytes()
    for length in range(0, len(data), 7):
        with pytest.raises(ReplayError):
            loads(data[:length])
    with pytest.raises(ReplayError, match="damaged"):
        loads(data + b"\0")


@pytest.mark.parametrize("data", [b"", b"PK\x03\x04 no replay", pickle.dumps({"a": 1}), b"\0" * 4096])
def test_other_files_are_refused(data, tmp_path):
    path = tmp_path / "other.replay"
    path.write_bytes(data)
    with pytest.raises(ReplayError, match=r"other\.replay: expected a replay of discjump"):
        load(path)


def resealed(data: bytes, version: int | None = None, length: int | None = None) -> bytes:
    """A file with another head, and a checksum that fits."""
    magic, old, size = struct.unpack_from("<8sII", data)
    head = struct.pack("<8sII", magic, version or old, size if length is None else length)
    return head + file._seal(head, data[32:]) + data[32:]


def test_a_newer_schema_says_so(recorded):
    with pytest.raises(ReplayError, match="expected schema 1 of replays, got 2: a newer discjump wrote it"):
        loads(resealed(recorded.to_bytes(), version=2))


@pytest.mark.parametrize("length", [0, 100, 2**28, 2**28 + 1, 2**32 - 1])
def test_no_more_is_unpacked_than_announced(recorded, length):
    with pytest.raises(ReplayError, match=r"malformed|at most"):
        loads(resealed(recorded.to_bytes(), length=length))


def test_a_bomb_is_not_unpacked():
    """16 MiB of zeros announced as 1,000 bytes: no more than that is ever made of them."""
    zeros = lzma.compress(bytes(2**24), format=lzma.FORMAT_RAW, filters=file.FILTERS)
    head = struct.pack("<8sII", file.MAGIC, 1, 1000)
    with pytest.raises(ReplayError, match="expected 1000 bytes unpacked, got 1001 or more"):
        loads(head + file._seal(head, zeros) + zeros)


def packed(header: dict[str, Any], arrays: dict[str, Any]) -> bytes:
    return file.pack(header, arrays)


@pytest.mark.parametrize(
    ("header", "message"),
    [
        ({"kind": "film"}, "another kind"),
        ({"id": "evil.module:discjump/Ski-v0"}, "expected an id like discjump/Ski-v0"),
        ({"id": "CartPole-v1"}, "expected an id like discjump/Ski-v0"),
        ({"seed": "7"}, "expected seed in its header"),
        ({"episode": 2**40}, "expected an episode from 0"),
        ({"every": 0}, "how often it was digested"),
        ({"made": {}}, "expected who made it"),
        ({"options": {"physics": {}, "entry_point": "os:system"}}, "does not know all of its options"),
        ({"reset": {"end": 1}}, "does not know all of its options"),
    ],
)
def test_headers_that_ask_for_something_else_are_refused(recorded, header, message):
    with pytest.raises(ReplayError, match=message):
        loads(packed({**recorded.header, **header}, recorded.arrays))


def test_missing_arrays_and_entries_are_refused(recorded):
    for name in recorded.header:
        if name in ("terrains", "terrain", "outcome"):
            continue
        with pytest.raises(ReplayError):
            loads(packed({k: v for k, v in recorded.header.items() if k != name}, recorded.arrays))
    for name in ("actions", "digests.state", "digests.output"):
        with pytest.raises(ReplayError, match=f"expected the array {name}"):
            loads(packed(recorded.header, {k: v for k, v in recorded.arrays.items() if k != name}))


def test_objects_are_never_read():
    """numpy's own files would unpickle them."""
    for described in ("|O", "|V8", "|S3", [["a", "|O", []]]):
        text = f'{{"arrays":[["a",{described!r},[1]]]}}'.replace("'", '"').encode()
        with pytest.raises(ValueError, match="expected name, dtype and shape"):
            codec.decode(struct.pack("<I", len(text)) + text + bytes(8))
    for shape in ("[-1]", "[1,1,1,1,1]", "[4611686018427387904,4]", '["x"]', "7"):
        text = f'{{"arrays":[["a","<f8",{shape}]]}}'.encode()
        with pytest.raises(ValueError, match="expected"):
            codec.decode(struct.pack("<I", len(text)) + text)


def test_unknown_ids_name_what_is_needed(recorded):
    with pytest.raises(ReplayError, match=r"needs discjump/Ski-v7, and discjump .* has .*discjump/Ski-v0"):
        recorded.changed({"id": "discjump/Ski-v7"}).verify()


def test_options_out_of_range_name_themselves(recorded):
    with pytest.raises(ReplayError, match=r"turn_rate: expected a number in \(0, 100\] rad/s, got -1"):
        recorded.changed({"options": {**recorded.options, "turn_rate": -1}}).verify()
    physics = {**recorded.options["physics"], "gravity": 7}
    with pytest.raises(ReplayError, match=r"physics: .* does not take"):
        recorded.changed({"options": {**recorded.options, "physics": physics}}).verify()
    with pytest.raises(ReplayError, match="expected 0 to 2, got 9"):
        recorded.changed(arrays={"actions": np.full((3, 5), 9, np.int8)}).verify()


# ------------------------------------------------------------------------------------ size


def test_a_minute_fits_in_a_few_kilobytes():
    """469 decisions whose keys are drawn, which no compression can shorten below 6.4 bits each."""
    made = episode(time_limit=60.0, terrain_seeds=list(range(16)), every=16, goal_distance=(790.0, 800.0))
    assert len(made.actions) > 200
    assert len(made.to_bytes()) < 2_600
    held = made.changed(arrays={"actions": np.tile(np.array([2, 1, 1, 0, 3], np.int8), (469, 1))})
    assert len(held.to_bytes()) < 2_000


def test_codec_keeps_numbers_of_every_shape():
    arrays: dict[str, Any] = {
        "scalar": np.float32(1.5),
        "flags": np.array([[True, False]]),
        "none": np.zeros((0, 3), np.int64),
        "backwards": np.arange(6, dtype=">i4")[::-1].reshape(2, 3).T,
        "input": np.ones((2, 1), discjump.INPUT),
    }
    _, read = codec.decode(codec.encode({}, {name: np.asarray(a) for name, a in arrays.items()}))
    for name, array in arrays.items():
        assert read[name].shape == np.shape(array), name
        if name == "input":
            for field in discjump.INPUT.names or ():
                assert (read[name][field] == array[field]).all()
        else:
            np.testing.assert_array_equal(read[name], array)
    buffer = io.BytesIO(codec.encode({}, {}))
    assert codec.decode(buffer.getvalue()) == ({}, {})
