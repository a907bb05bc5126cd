# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""What a map says of its past."""
import contextlib

import ovimap
import pytest


@pytest.fixture(scope="module")
def opened(home_map):
    return ovimap.Map.open(home_map)


def test_visits_have_dates(opened):
    first, second = opened.visits
    assert (first.visit, second.visit) == (1, 2) and first.source != second.source
    assert 0 < first.end_s - first.begin_s < 3600 and 86400 < second.begin_s - first.begin_s < 3 * 86400
    assert repr(second) == f"Visit(2, '{second.source}')"


def test_events_say_what_became_of_things(opened):
    assert {event.event for event in opened.events} >= {"appeared", "gone"}
    for event in opened.events:
        assert event.visit == 2 and event.time_s >= opened.visits[1].begin_s and event.text in repr(event)
        assert (event.before is None) == (event.event == "appeared") and (event.after is None) == (event.event == "gone")
    assert [event.id for event in opened.changes(since="visit 1")] == sorted(event.id for event in opened.events)
    assert opened.changes(since="visit 2") == [] and opened.changes(until="visit 1") == []
    assert len(opened.changes(since="2026-03-15", until="2026-03-16")) == len(opened.events)


def test_each_object_says_when_it_was_seen_last(opened):
    seen = [opened.last_seen(int(id)) for id in opened.instances.ids]
    assert {visit for visit, _ in seen} <= {1, 2} and any(visit == 2 for visit, _ in seen)
    for visit, time_s in seen:
        assert opened.visits[visit - 1].begin_s <= time_s <= opened.visits[visit - 1].end_s
    with pytest.raises(ovimap.Error, match="no object|no instance"):
        opened.last_seen(999999)


def test_questions_go_to_the_map_as_it_was(opened):
    gone = [event for event in opened.events if event.event == "gone"]
    answer = opened.query("what is gone", relevance=True)
    assert answer.found and [match.id for match in answer.matches] == [event.id for event in gone]
    assert answer.reading == "[anything] that is gone" and answer.relevance.shape == (len(opened),)
    assert "gone from" in answer.matches[0].evidence
    new = next(event.id for event in opened.events if event.event == "appeared")
    assert new in [match.id for match in opened.query("", since="visit 1").matches]
    assert new not in [match.id for match in opened.query("", at="2026-03-14").matches]
    assert gone[0].id in [match.id for match in opened.query("", at="visit 1").matches]
    assert opened.query("chair on 2026-03-14").reading == "[chair] at 2026-03-14 23:59"
    with pytest.raises(ovimap.Error, match="the map has no visit 3"):
        opened.query("chair", at="visit 3")
    with pytest.raises(ovimap.Error, match="is no time"):
        opened.changes(since="some day")


def test_agents_ask_the_past_in_words(home_map):
    from ovimap.agents.backend import open_map

    with contextlib.closing(open_map(home_map)) as agent:
        new = agent.find("what is new")
        assert new.found and all("appeared at" in match.evidence for match in new.matches)
        gone = agent.find("what is gone")
        assert gone.found and gone.reading == "[anything] that is gone"
        assert agent.verdicts(["what is gone"])[0].found


def test_a_map_of_one_visit_has_no_past(saved_map):
    opened = ovimap.Map.open(saved_map)
    assert [visit.visit for visit in opened.visits] == [1] and opened.events == [] and opened.changes() == []
    assert not opened.query("what moved").found
    with pytest.raises(ovimap.Error, match="--recorded"):
        opened.query("chair", at="yesterday")
