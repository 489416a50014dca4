"""The share of what an exhaustive search can reach, beside scores."""

import json

import numpy as np
import pytest

from discjump_training.bounds import reachable
from discjump_training.bounds.reachable import Reachable
from discjump_training.courses import COURSES
from discjump_training.judge import Conditions, Entrant, evaluation, find, judge, results, tables
from discjump_training.judge import reachable as reaching

COURSE = COURSES["disc-jump-held-out-v1"]


def played(**changes):
    conditions = Conditions(COURSE, 12, changes, threads=1)
    jumper = find("jumper", COURSE)
    return conditions, judge([Entrant("jumper", (jumper,))], conditions)


@pytest.fixture(scope="module")
def made():
    return evaluation(*played())


def test_the_share_is_of_the_reachable(made):
    data = json.loads(json.dumps(results.as_json(made)))
    told = data["policies"][0]["share_of_reachable"]
    known = reachable.load(COURSE)
    assert known is not None
    reached = np.array([one.stage is not None for one in known.found[:12]])
    success = np.array(data["policies"][0]["members"][0]["success"])
    assert told["episodes"] == reached.sum()
    assert told["value"] == pytest.approx(success[reached].mean())
    assert told["low"] < told["value"] < told["high"]
    text = tables.markdown(made)
    assert "of the reachable, %" in text
    assert f"{100 * told['value']:.1f} [" in text
    assert "the course's first 12 episodes" in text


def test_heights_have_their_bands(made):
    assert sum(one.episodes for one in made.bands) == 12
    table = tables.bands(made)
    assert table is not None
    assert "success, % by marker height, m" in table.title


def test_where_nobody_searched_nothing_is_said(made):
    conditions, judged = played(armor="heavy", time_limit=2.0)
    other = evaluation(conditions, judged)
    assert other.search is None
    assert "reachable" not in tables.markdown(other).lower()
    assert results.as_json(other)["policies"][0]["share_of_reachable"] is None


def test_what_was_not_reached_does_not_count(made):
    search = made.search
    first = search.found[0]
    lost = type(first)(first.episode, None, None, 9.0, 1, first.schedule, first.marker_height)
    fewer = Reachable(search.course, search.course_digest, search.options, (lost, *search.found[1:3]))
    found = reaching.share(made.judged[0], fewer)
    assert found is not None
    share, count = found
    success = made.judged[0].success[0]
    assert count == 2
    assert share.value == success[1:3].mean()
    assert reaching.share(made.judged[0], Reachable("", "", {}, (lost,))) is None
