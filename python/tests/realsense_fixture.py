# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""RealSense cameras that are none: the library's software devices, which its recorder takes for cameras."""
import time

import numpy as np
import pyrealsense2 as rs

SIZE, UNIT_M = (64, 48), 0.00025
BROWN = [0.1, -0.2, 0.01, 0.02, 0.03]


def lens(focal, model=rs.distortion.none, coefficients=(0, 0, 0, 0, 0), size=SIZE):
    values = rs.intrinsics()
    values.width, values.height = size
    values.fx, values.fy, values.ppx, values.ppy = focal, focal + 1, size[0] / 2 - 0.5, size[1] / 2 - 0.5
    values.model, values.coeffs = model, list(coefficients)
    return values


def turned():
    """Depth to colour, as the library has it: column by column."""
    angle = 0.1
    offset = rs.extrinsics()
    offset.rotation = [np.cos(angle), np.sin(angle), 0, -np.sin(angle), np.cos(angle), 0, 0, 0, 1]
    offset.translation = [0.06, 0.01, -0.02]
    return offset


def stood_on_its_side():
    """Gyroscope to depth: x there is y here, and y there -x here."""
    offset = rs.extrinsics()
    offset.rotation, offset.translation = [0, 1, 0, -1, 0, 0, 0, 0, 1], [0, 0, 0]
    return offset


class SoftwareCamera:
    """A depth and a colour sensor whose images the test draws, and where `gyroscope_hz` says so a gyroscope."""

    def __init__(self, serial="000111", color_lens=None, color_format=rs.format.rgb8, kinds=("depth", "color"), size=SIZE, gyroscope_hz=0):
        self.size, self.device = size, rs.software_device()
        self.device.register_info(rs.camera_info.name, "Drawn camera")
        self.device.register_info(rs.camera_info.serial_number, serial)
        lenses = {"depth": lens(60.0, size=size), "color": color_lens or lens(55.0, rs.distortion.brown_conrady, BROWN, size)}
        self.sensors, self.profiles = {}, {}
        for uid, kind in enumerate(kinds, 1):
            sensor = self.device.add_sensor("Stereo Module" if kind == "depth" else "RGB Camera")
            stream = rs.video_stream()
            stream.type, stream.index, stream.uid, stream.fps = getattr(rs.stream, kind), 0, uid, 30
            (stream.width, stream.height), stream.intrinsics = size, lenses[kind]
            stream.fmt, stream.bpp = (rs.format.z16, 2) if kind == "depth" else (color_format, 3)
            self.sensors[kind], self.profiles[kind] = sensor, sensor.add_video_stream(stream)
        self.sensors["depth"].add_read_only_option(rs.option.depth_units, UNIT_M)
        if "color" in kinds:
            self.profiles["depth"].register_extrinsics_to(self.profiles["color"], turned())
        if gyroscope_hz:
            self._add_gyroscope(gyroscope_hz)
        self.number = 0

    def _add_gyroscope(self, rate_hz):
        self.sensors["gyroscope"] = self.device.add_sensor("Motion Module")
        for uid, fps in ((8, rate_hz), (9, rate_hz // 2)):
            stream = rs.motion_stream()
            stream.type, stream.index, stream.uid, stream.fps, stream.fmt = rs.stream.gyro, 0, uid, fps, rs.format.motion_xyz32f
            profile = self.sensors["gyroscope"].add_motion_stream(stream)
            profile.register_extrinsics_to(self.profiles["depth"], stood_on_its_side())
            self.profiles.setdefault("gyroscope", profile)

    def turn(self, rate, time_ms):
        frame = rs.software_motion_frame()
        measured = rs.vector()
        measured.x, measured.y, measured.z = rate
        frame.data, frame.timestamp, frame.domain = measured, time_ms, rs.timestamp_domain.hardware_clock
        frame.frame_number = self.number = self.number + 1
        frame.profile = self.profiles["gyroscope"].as_motion_stream_profile()
        self.sensors["gyroscope"].on_motion_frame(frame)

    def show(self, kind, pixels, time_ms):
        frame = rs.software_video_frame()
        frame.pixels, frame.bpp = pixels, pixels.itemsize * (3 if kind == "color" else 1)
        frame.stride = self.size[0] * frame.bpp
        frame.timestamp, frame.domain = time_ms, rs.timestamp_domain.hardware_clock
        frame.frame_number = self.number = self.number + 1
        frame.profile = self.profiles[kind].as_video_stream_profile()
        if kind == "depth":
            frame.depth_units = UNIT_M
        self.sensors[kind].on_video_frame(frame)

    def show_all(self, frames, rates=()):
        """frames: (colour, depth, ms). rates: (radians a second about x, y and z of the gyroscope, ms)."""
        rates = list(rates)
        for color, depth, time_ms in frames:
            while rates and rates[0][1] <= time_ms:
                self.turn(*rates.pop(0))
            for kind, pixels in (("depth", depth), ("color", color)):
                if kind in self.sensors:
                    self.show(kind, pixels, time_ms)
            time.sleep(0.002)  # the recorder writes on a thread of its own

    def record(self, file, frames, rates=()):
        """As the maker's tools do."""
        recorder = rs.recorder(str(file), self.device)
        recorded = recorder.query_sensors()
        for sensor, profile in zip(recorded, self.profiles.values()):
            sensor.open(profile)
            sensor.start(rs.frame_queue(len(frames) + len(rates)))
        self.show_all(frames, rates)
        for sensor in recorded:
            sensor.stop()
            sensor.close()
        del recorder  # closes the file


class Sockets:
    """In the place of the library's context, which since 2.55 does not list the software devices that are added to it; all else is the
    library's own."""

    def __init__(self, *cameras):
        self.devices, self.changed = [camera.device for camera in cameras], None

    def query_devices(self):
        return self.devices

    def set_devices_changed_callback(self, changed):
        self.changed = changed

    def unplug(self, device):
        self.devices.remove(device)
        self.changed(self)

    def was_removed(self, device):
        return device not in self.devices


def picture(i, size=SIZE):
    """(colour, depth) that differ from frame to frame and from pixel to pixel, with edges to track."""
    v, u = np.mgrid[: size[1], : size[0]]
    color = np.stack([u * 2 + i, v * 3, np.full_like(u, 40 + i)], 2).astype(np.uint8)
    depth = (6000 + 10 * i + 20 * v + (u > 20 + i) * 1500).astype(np.uint16)
    return color, depth


def film(count, start_ms=1000.0, step_ms=1000 / 30, size=SIZE):
    return [(*picture(i, size), start_ms + step_ms * i) for i in range(count)]
