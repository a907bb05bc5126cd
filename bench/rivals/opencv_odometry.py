# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""OpenCV's RGB-D odometry, for odometry.py. RuntimeError: it found no motion."""
import cv2
import numpy
from ours import MAX_RANGE_M

VERSION = f"OpenCV {cv2.__version__}"


def prepared(depth, color, camera):
    """What track() takes."""
    metres = numpy.where(depth > 0, depth, numpy.nan).astype(numpy.float32)
    return cv2.OdometryFrame(metres, cv2.cvtColor(color, cv2.COLOR_RGB2BGR)), camera.astype(numpy.float32)


class Odometry:
    """From frame to frame, by depth and intensity together; its own settings but for the range."""

    def __init__(self):
        self.last, self.pose, self.finder = None, numpy.eye(4), None

    def track(self, frame, camera):
        if self.finder is None:
            settings = cv2.OdometrySettings()
            settings.setCameraMatrix(camera)
            settings.setMaxDepth(MAX_RANGE_M)
            self.finder = cv2.Odometry(cv2.OdometryType_RGB_DEPTH, settings, cv2.OdometryAlgoType_COMMON)
        last, self.last = self.last, frame
        if last is None:
            return self.pose
        self.finder.prepareFrames(frame, last)
        found, last_from_frame = self.finder.compute(frame, last)
        if not found:
            raise RuntimeError("no motion")
        self.pose = self.pose @ last_from_frame
        return self.pose
