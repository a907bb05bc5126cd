# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""From a camera's images to frames that are sent: pairs, clocks, flicker, and what is refused."""
import threading

import numpy as np
import ovimap
import pytest
from ovimap.cameras import CameraLost, Feed, Image, Relay, TurnRate
from ovimap.cameras.pairing import KEEP, LONELY, Pairing
from ovimap.cameras.relay import Flicker
from ovimap.sender import SendError


class Sent(list):
    """In the place of a FrameSender."""

    taken = skipped = 0

    def __init__(self):
        self.orientations = []

    def send(self, *frame, orientation, patience_s):
        self.append(frame)
        self.orientations.append(orientation)
        self.taken += 1
        return True

    def finish(self):
        pass


def images(kind, times):
    return [Image(kind, time_s, np.array([[int(time_s * 1000)]])) for time_s in times]


def paired(entries):
    told, pairs = [], []
    pairing = Pairing(told.append)
    for entry in entries:
        pairs += pairing.add(entry)
    return pairs + pairing.rest(), pairing.left_out, told


def interleaved(color, depth):
    return sorted(images("color", color) + images("depth", depth), key=lambda image: image.time_s)


def test_depth_takes_the_nearest_colour_and_what_has_none_is_counted():
    pairs, left_out, told = paired(interleaved(color=[0.0, 0.030, 0.068, 0.200], depth=[0.010, 0.033, 0.050, 0.100, 0.133, 0.190]))
    assert [(pair.time_s, int(pair.color[0, 0])) for pair in pairs] == [(0.010, 0), (0.033, 30), (0.050, 68), (0.190, 200)]
    assert left_out == 2 and not told


def test_a_clock_that_jumps_loses_nothing_and_is_told_once():
    times = [0.1 * i for i in range(5)]
    for start in (1000.0, -50.0):
        later = [start + t for t in times]
        entries = interleaved(times, times) + interleaved(later, later)
        pairs, left_out, told = paired(entries)
        assert len(pairs) == 10 and left_out == 0
        sent = [pair.time_s for pair in pairs]
        assert sent == sorted(sent) and sent[5] == pytest.approx(0.4 + 1 / 30) and sent[9] - sent[5] == pytest.approx(0.4)
        assert len(told) == 1 and told[0].startswith(f"the camera's clock jumped by {start - 0.4:+.3f} s")
        assert [pair.color[0, 0] for pair in pairs] == [pair.depth[0, 0] for pair in pairs]


def test_colour_and_depth_of_two_clocks_are_told():
    depth = [i / 30 for i in range(2 * LONELY)]
    pairs, left_out, told = paired([image for t in depth for image in (*images("depth", [t]), *images("color", [t + 3]))])
    assert not pairs and left_out == len(depth)
    assert len(told) == 1 and "have no colour image within 0.02 s" in told[0] and "by one clock" in told[0]
    assert paired(images("depth", depth[: KEEP + 5]))[1] == KEEP + 5


def test_a_recording_waits_and_a_camera_drops_the_oldest():
    live = Feed(waits=False)
    for image in images("depth", range(20)):
        live.put(image)
    live.end()
    assert [image.time_s for image in live.entries(1)] == list(range(12, 20)) and live.dropped == 12
    recorded, given = Feed(waits=True), images("depth", range(20))
    putting = threading.Thread(target=lambda: [recorded.put(image) for image in given] and recorded.end())
    putting.start()
    assert [image.time_s for image in recorded.entries(30)] == list(range(20)) and recorded.dropped == 0
    putting.join(timeout=30)


def test_samples_of_a_gyroscope_wait_for_their_image_and_none_is_dropped():
    feed = Feed(waits=False)
    for i in range(20):
        for k in range(3):
            feed.turn(TurnRate(i + 0.1 * k, (0.0, 0.0, 0.0)))
        feed.put(images("depth", [i + 0.5])[0])
    feed.end()
    taken = list(feed.entries(1))
    assert sum(isinstance(entry, TurnRate) for entry in taken) == 60 and feed.dropped == 12
    assert [entry.time_s for entry in taken if isinstance(entry, Image)] == [i + 0.5 for i in range(12, 20)]


def test_a_camera_that_only_turns_is_lost():
    feed, ended = Feed(waits=False), threading.Event()
    turning = threading.Thread(target=lambda: [feed.turn(TurnRate(0.0, (0.0, 0.0, 0.0))) for _ in iter(lambda: ended.wait(0.02), True)])
    turning.start()
    with pytest.raises(CameraLost, match="has sent no image for 0.3 s"):
        list(feed.entries(0.3))
    ended.set()
    turning.join(timeout=30)


def turning(start_s, frames, rate_hz=200, shift_s=0.0):
    """Images of a camera that turns by 0.5 rad/s about y, and what its gyroscope says, in order of time."""
    end_s = start_s + frames / 30
    rates = [TurnRate(start_s + shift_s + i / rate_hz, (0.0, 0.5, 0.0)) for i in range(round(frames / 30 * rate_hz))]
    times = [start_s + i / 30 for i in range(frames) if start_s + i / 30 < end_s]
    picture = np.zeros((2, 2, 3), np.uint8)
    seen = [Image(kind, t, picture if kind == "color" else picture[..., 0].astype(np.uint16)) for t in times for kind in ("color", "depth")]
    return sorted(rates + seen, key=lambda entry: entry.time_s - (shift_s if isinstance(entry, TurnRate) else 0))


def angles(orientations):
    return [2 * np.arctan2(y, w) for _, y, _, w in orientations]


def test_frames_are_sent_with_how_the_camera_is_turned():
    sent, told = Sent(), []
    Relay(sent, told.append, waits=True).take(turning(100.0, 40))
    assert len(sent) == 40 and not told
    assert angles(sent.orientations) == pytest.approx([0.5 * (time_s - 100) for *_, time_s in sent], abs=1e-6)
    Relay(sent := Sent(), told.append, waits=True).take(entry for entry in turning(100.0, 40) if isinstance(entry, Image))
    assert sent.orientations == 40 * [None] and not told


def test_samples_are_kept_by_the_times_of_frames_also_after_the_clock_jumped():
    sent, told, kept = Sent(), [], []
    relay = Relay(sent, told.append, waits=True, keep_rate=lambda time_s, rate: kept.append((time_s, rate)))
    relay.take(turning(100.0, 40) + turning(7.0, 40))
    times = [time_s for time_s, _ in kept]
    assert len(sent) == 80 and len(told) == 1 and times == sorted(times) and {rate for _, rate in kept} == {(0.0, 0.5, 0.0)}
    assert times[0] == 100 and times[-1] == pytest.approx(sent[-1][-1], abs=0.006)
    later = angles(sent.orientations)[40:]
    assert [b - a for a, b in zip(later, later[1:])] == pytest.approx(39 * [0.5 / 30], abs=1e-6)


def test_a_gyroscope_by_another_clock_is_told_once_and_frames_are_sent():
    sent, told = Sent(), []
    Relay(sent, told.append, waits=True).take(turning(100.0, 80, shift_s=5000.0))
    assert len(sent) == 80 and set(sent.orientations) == {None}
    assert len(told) == 1 and told[0].startswith("the gyroscope measured nothing at the times of 30 depth images in a row")


def test_flicker_is_told_once_and_a_passing_light_is_not():
    told = []
    for amplitude, expected in ((0, 0), (12, 1)):
        flicker = Flicker(told.append)
        for i in range(90):
            flicker.see(np.full((64, 64, 3), 100 + i // 3 + (amplitude if i % 3 == 0 else 0), np.uint8))
        assert len(told) == expected
    assert "power line frequency" in told[0]


class Refusing(Sent):
    def __init__(self, status, good=()):
        super().__init__()
        self.status, self.good = status, good

    def send(self, *frame, orientation, patience_s):
        if len(self) in self.good:
            return super().send(*frame, orientation=orientation, patience_s=patience_s)
        self.append(frame)
        raise SendError(self.status, "a reason")


def relayed(sink, count):
    told = []
    relay = Relay(sink, told.append, waits=True)
    times = [i / 30 for i in range(count)]
    color = np.zeros((2, 2, 3), np.uint8)
    relay.take(Image(kind, t, color if kind == "color" else color[..., 0].astype(np.uint16)) for t in times for kind in ("color", "depth"))
    return relay, told


def test_refused_frames_cost_themselves_alone_until_it_is_hopeless():
    relay, told = relayed(Refusing(400, good=(0, 7)), 40)
    assert relay.sink.taken == 2 and relay.refused == 38
    assert [line.split(")")[0] for line in told] == [f"a frame was refused ({n} so far" for n in (1, 2, 4, 8, 16, 32)]
    with pytest.raises(ovimap.Error, match="none of 30 frames was taken: a reason"):
        relayed(Refusing(400), 40)
    with pytest.raises(ovimap.Error, match="a reason"):
        relayed(Refusing(409, good=(0,)), 40)
