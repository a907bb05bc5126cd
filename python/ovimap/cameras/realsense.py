# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""RealSense cameras, their recordings (.bag, .db3) and their library's software devices, through pyrealsense2.

All three are devices with sensors there, and are read in one way: depth and colour as their sensors give them."""

from __future__ import annotations

import contextlib
import functools
import pathlib
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

from .._ovimap import Error
from ..distortion import distortion_of, fitted_brown_conrady
from ..transforms import Matrix
from .camera import Feed, Image, TurnRate, Wanted, chosen_serial, rig_of, units_per_m

HINT = "plug it in (docs/cameras.md, 'When no camera is found'), or read a recording with --file"
DEFAULT_UNIT_M = 0.001  # of devices that do not say
GRID = 24  # points a side at which a lens is sampled
MOST_BENT_PX = 0.1  # by which a lens may differ from the formula that stands for it
CHANNELS = {"rgb8": 3, "bgr8": 3, "rgba8": 4, "bgra8": 4}


def open_realsense(wanted: Wanted, context: Any = None) -> RealSense:
    """context: of pyrealsense2, where it is not the one of this process."""
    import pyrealsense2 as rs

    found = context or _shared_context(rs)
    if wanted.file is not None:
        return RealSense(rs, found, _recording(rs, found, wanted.file), wanted)
    devices = [device for device in found.query_devices() if _profiles(rs, device)]
    serials = [_about(rs, device, "serial_number") for device in devices]
    serial = chosen_serial("RealSense", serials, wanted.serial, HINT)
    return RealSense(rs, found, devices[serials.index(serial)], wanted)


@functools.cache
def _shared_context(rs: Any) -> Any:
    """One for the process: its thread looks for devices all the time, and may still be looking when a context is taken down (release 2.59)."""
    return rs.context()


class RealSense:
    """A device of pyrealsense2."""

    def __init__(self, rs: Any, context: Any, device: Any, wanted: Wanted) -> None:
        self._rs, self._context, self._device = rs, context, device
        self.recorded = wanted.file is not None
        self.serial = _about(rs, device, "serial_number")
        self.name = f"{_about(rs, device, 'name')} {self.serial}".strip()
        choose = _only if self.recorded else _of_size
        self._chosen = {kind: choose(self.name, kind, _of_kind(rs, device, kind), wanted) for kind in ("depth", "color")}
        self._gyroscope = _gyroscope_of(rs, device, self._chosen["depth"][1])
        self.gyroscope = self._gyroscope is not None
        self._running: list[Any] = []
        self.rig = self._rig()

    def start(self, feed: Feed) -> None:
        try:
            self._start(feed)
        except RuntimeError as fault:
            self.close()
            raise Error(f"{self.name} cannot be started ({_line(fault)}); close other programs that use it, and plug it in anew") from None

    def close(self) -> None:
        for sensor in self._running:
            with contextlib.suppress(RuntimeError):  # of a camera that was unplugged
                sensor.stop()
                sensor.close()
        if self.recorded and self._running:
            with contextlib.suppress(RuntimeError):
                self._device.pause()  # returns when the thread that reads has done what it was asked: the device may go only then
        self._running.clear()

    def _start(self, feed: Feed) -> None:
        if self.recorded:
            stopped = self._rs.playback_status.stopped
            self._device.set_status_changed_callback(lambda status: feed.end() if status == stopped else None)
            self._device.set_real_time(False)  # its threads wait for the feed: no image is dropped
            self._device.pause()  # until both sensors listen
        else:
            self._context.set_devices_changed_callback(lambda info: feed.end("was unplugged") if info.was_removed(self._device) else None)
        (depth_sensor, depth), (color_sensor, color) = self._chosen["depth"], self._chosen["color"]
        one = _same(self._rs, depth_sensor, color_sensor)  # some cameras make colour of the depth sensor's own images
        take = _taker(self._rs, feed)
        for sensor, profiles in [(depth_sensor, [depth, color])] if one else [(depth_sensor, [depth]), (color_sensor, [color])]:
            sensor.open(profiles)
            self._running.append(sensor)
        for sensor in list(self._running):
            sensor.start(take)
        if self._gyroscope is not None:
            sensor, profile, depth_from_gyroscope = self._gyroscope
            sensor.open(profile)
            self._running.append(sensor)
            sensor.start(_turn_taker(depth_from_gyroscope, feed))
        if self.recorded:
            self._device.resume()

    def _rig(self) -> dict[str, Any]:
        (sensor, depth), (_, color) = self._chosen["depth"], self._chosen["color"]
        unit_m = sensor.as_depth_sensor().get_depth_scale() if sensor.is_depth_sensor() else DEFAULT_UNIT_M
        extrinsics = depth.get_extrinsics_to(color)
        offset: Matrix = np.eye(4)
        offset[:3, :3] = _rotation(extrinsics)
        offset[:3, 3] = extrinsics.translation
        return rig_of({**_camera(self._rs, depth), "depth_scale": units_per_m(unit_m)}, _camera(self._rs, color), offset)


def _recording(rs: Any, context: Any, file: pathlib.Path) -> Any:
    if not file.is_file():
        raise Error(f"there is no recording '{file}'; name a .bag or .db3 file of a RealSense camera")
    try:
        return rs.playback(context.load_device(str(file)))
    except RuntimeError as fault:
        why = "it is cut off, or a ROS driver's, which ovimap-bag reads (docs/sources.md)"
        raise Error(f"'{file}' cannot be read as a RealSense recording ({_line(fault)}); {why}") from None


def _about(rs: Any, device: Any, what: str) -> str:
    key = getattr(rs.camera_info, what)
    return str(device.get_info(key)) if device.supports(key) else ""


def _profiles(rs: Any, device: Any) -> list[tuple[Any, Any]]:
    """(sensor, profile) of all images."""
    found = [(sensor, profile) for sensor in device.query_sensors() for profile in sensor.get_stream_profiles()]
    return [(sensor, profile.as_video_stream_profile()) for sensor, profile in found if profile.is_video_stream_profile()]


def _of_kind(rs: Any, device: Any, kind: str) -> list[tuple[Any, Any]]:
    formats = [rs.format.z16] if kind == "depth" else [getattr(rs.format, name) for name in CHANNELS]
    found = [(s, p) for s, p in _profiles(rs, device) if p.stream_type() == getattr(rs.stream, kind) and p.format() in formats]
    return sorted(found, key=lambda entry: formats.index(entry[1].format()))


def _gyroscope_of(rs: Any, device: Any, depth: Any) -> tuple[Any, Any, Matrix] | None:
    """(sensor, its profile of most samples, depth_from_gyroscope [3, 3]); None where the device has none. Recordings do not hold how it stands to
    depth; these devices give turns about axes like depth's, and the mapper leaves out a gyroscope that the images contradict."""
    found = [(sensor, profile) for sensor in device.query_sensors() for profile in sensor.get_stream_profiles()]
    fitting = [(s, p) for s, p in found if p.stream_type() == rs.stream.gyro and p.format() == rs.format.motion_xyz32f]
    if not fitting:
        return None
    sensor, profile = max(fitting, key=lambda entry: entry[1].fps())
    try:
        return sensor, profile, _rotation(profile.get_extrinsics_to(depth))
    except RuntimeError:
        return sensor, profile, np.eye(3)


def _rotation(extrinsics: Any) -> Matrix:
    return np.reshape(np.asarray(extrinsics.rotation, np.float64), (3, 3)).T  # column by column


def _only(name: str, kind: str, profiles: list[tuple[Any, Any]], wanted: Wanted) -> tuple[Any, Any]:
    if not profiles:
        raise Error(f"'{wanted.file}' holds no {_said(kind)} images; record depth (Z16) and colour (RGB8) together")
    return profiles[0]


def _of_size(name: str, kind: str, profiles: list[tuple[Any, Any]], wanted: Wanted) -> tuple[Any, Any]:
    for sensor, profile in profiles:
        if (profile.width(), profile.height(), profile.fps()) == (wanted.width, wanted.height, wanted.fps):
            return sensor, profile
    sizes = sorted({(p.width(), p.height(), p.fps()) for _, p in profiles})
    has = ", ".join(f"{width}x{height} at {fps}" for width, height, fps in sizes) or "none"
    raise Error(f"{name} has no {_said(kind)} of {wanted.width}x{wanted.height} at {wanted.fps} frames/s; choose with --size and --fps among: {has}")


def _said(kind: str) -> str:
    return "colour" if kind == "color" else kind


def _same(rs: Any, a: Any, b: Any) -> bool:
    return bool(a.get_info(rs.camera_info.name) == b.get_info(rs.camera_info.name))


def _taker(rs: Any, feed: Feed) -> Callable[[Any], None]:
    """Called by the library's threads, with frames that are theirs: what is kept is copied."""

    def take(frame: Any) -> None:
        for single in _singles(frame):
            kind = "depth" if single.profile.stream_type() == rs.stream.depth else "color"
            pixels = np.asarray(single.get_data())
            if kind == "color":
                pixels = pixels[..., 2::-1] if single.profile.format() in (rs.format.bgr8, rs.format.bgra8) else pixels[..., :3]
            feed.put(Image(kind, single.timestamp / 1000, np.array(pixels)))

    return take


def _turn_taker(depth_from_gyroscope: Matrix, feed: Feed) -> Callable[[Any], None]:
    def take(frame: Any) -> None:
        for single in _singles(frame):
            measured = single.as_motion_frame().get_motion_data()  # radians a second
            x, y, z = (depth_from_gyroscope @ [measured.x, measured.y, measured.z]).tolist()
            feed.turn(TurnRate(single.timestamp / 1000, (x, y, z)))

    return take


def _singles(frame: Any) -> Iterator[Any]:
    if frame.is_frameset():
        yield from frame.as_frameset()
    else:
        yield frame


def _camera(rs: Any, profile: Any) -> dict[str, Any]:
    lens = profile.get_intrinsics()
    if not (lens.fx > 0 and lens.fy > 0):
        found = f"fx {lens.fx:g}, fy {lens.fy:g}"
        raise Error(f"{profile.stream_name()} holds no calibration ({found}); write it with RealSense's own tools, and try again")
    figures = {"width": lens.width, "height": lens.height, "fx": lens.fx, "fy": lens.fy, "cx": lens.ppx, "cy": lens.ppy}
    return {**figures, **_distortion(rs, lens)}


def _distortion(rs: Any, lens: Any) -> dict[str, Any]:
    if lens.model == rs.distortion.kannala_brandt4:
        return distortion_of("kannala_brandt", lens.coeffs[:4])
    if lens.model == rs.distortion.none or not any(lens.coeffs):
        return {}
    if lens.model == rs.distortion.brown_conrady:
        return distortion_of("brown_conrady", lens.coeffs)
    return _fitted(rs, lens)


def _fitted(rs: Any, lens: Any) -> dict[str, Any]:
    """The library's other models, by where it says that pixels look."""
    u, v = (axis.ravel() for axis in np.meshgrid(np.linspace(0, lens.width - 1, GRID), np.linspace(0, lens.height - 1, GRID)))
    rays = np.array([rs.rs2_deproject_pixel_to_point(lens, [float(x), float(y)], 1.0)[:2] for x, y in zip(u, v)])
    bent = np.stack([(u - lens.ppx) / lens.fx, (v - lens.ppy) / lens.fy], 1)
    coefficients, error = fitted_brown_conrady(rays, bent)
    if not error * lens.fx <= MOST_BENT_PX:
        raise Error(f"the lens ({lens.model}) is no Brown-Conrady lens: the nearest is off by {error * lens.fx:.2f} px; "
                    "send rectified images, or choose another stream")
    return distortion_of("brown_conrady", coefficients)


def _line(fault: Exception) -> str:
    return str(fault).strip().splitlines()[0] if str(fault).strip() else type(fault).__name__
