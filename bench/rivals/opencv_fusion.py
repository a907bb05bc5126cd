# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""OpenCV's sparse TSDF volume (cv2.Volume, HashTSDF) on the frames that ovimap's side writes: distances alone, no colour."""
import time

import cv2
import numpy
from ours import MAX_RANGE_M


class OpenCv:
    VERSION = cv2.__version__

    def __init__(self, voxel_m, truncation_voxels):
        self.voxel_m, self.truncation_m, self.volume = voxel_m, voxel_m * truncation_voxels, None
        self.errors_mm = []

    def load(self, ours):
        width, height, fx, fy, cx, cy = ours.raw("camera", numpy.float64)
        if self.volume is None:
            self.volume = self.make_volume(int(width), int(height), [[fx, 0, cx], [0, fy, cy], [0, 0, 1]])
        self.depth = ours.raw("depth", numpy.float32).reshape(int(height), int(width))
        self.pose = ours.raw("pose", numpy.float64).reshape(4, 4).astype(numpy.float32)

    def make_volume(self, width, height, intrinsic):
        settings = cv2.VolumeSettings(cv2.VolumeType_HashTSDF)
        for use in ("Integrate", "Raycast"):
            getattr(settings, f"set{use}Width")(width)
            getattr(settings, f"set{use}Height")(height)
            getattr(settings, f"setCamera{use}Intrinsics")(numpy.float32(intrinsic))
        settings.setVoxelSize(self.voxel_m)
        settings.setTsdfTruncateDistance(self.truncation_m)
        settings.setMaxDepth(MAX_RANGE_M)
        settings.setDepthFactor(1.0)
        settings.setVolumePose(numpy.eye(4, dtype=numpy.float32))
        return cv2.Volume(cv2.VolumeType_HashTSDF, settings)

    def fuse(self):
        start = time.perf_counter()
        self.volume.integrate(self.depth, self.pose)
        return 1e3 * (time.perf_counter() - start)

    def cast(self):
        start = time.perf_counter()
        points = self.volume.raycast(self.pose)[0]  # in the camera's frame
        took_ms = 1e3 * (time.perf_counter() - start)
        seen = (self.depth > 0) & numpy.isfinite(points[..., 2])
        self.errors_mm.append(1e3 * float(numpy.median(numpy.abs(points[..., 2][seen] - self.depth[seen]))))
        return took_ms
