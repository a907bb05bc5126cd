# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Open3D's RGB-D odometry and its dense SLAM, for odometry.py. RuntimeError: they found no motion."""
import numpy
import open3d
import open3d.core as core
from open3d_fusion import TRUNCATION_VOXELS, VOXEL_M
from ours import MAX_RANGE_M

VERSION = f"Open3D {open3d.__version__}"
DEPTH_SCALE = 1000.0  # units per metre
open3d.utility.set_verbosity_level(open3d.utility.VerbosityLevel.Error)  # warnings go to stdout, where the result goes


def prepared(depth, color, camera):
    """What track() takes."""
    millimetres = numpy.rint(depth * DEPTH_SCALE).astype(numpy.uint16)[..., None]  # as cameras store it, which their SLAM demands
    images = (open3d.t.geometry.Image(core.Tensor(numpy.ascontiguousarray(image))) for image in (color, millimetres))
    return open3d.t.geometry.RGBDImage(*images), core.Tensor(camera)


class Odometry:
    """From frame to frame: the hybrid of point to plane and intensity, as their documentation recommends."""

    def __init__(self):
        self.last, self.pose = None, numpy.eye(4)

    def track(self, image, intrinsic):
        if self.last is not None:
            criteria = [open3d.t.pipelines.odometry.OdometryConvergenceCriteria(n) for n in (10, 5, 3)]
            found = open3d.t.pipelines.odometry.rgbd_odometry_multi_scale(
                image, self.last, intrinsic, core.Tensor(numpy.eye(4)), DEPTH_SCALE, MAX_RANGE_M, criteria,
                open3d.t.pipelines.odometry.Method.Hybrid)
            self.pose = self.pose @ found.transformation.numpy()
        self.last = image
        return self.pose


class Slam:
    """Their dense SLAM: from frame to model, as in their example dense_slam.py."""

    def __init__(self):
        self.model, self.pose, self.count = None, core.Tensor(numpy.eye(4)), 0

    def track(self, image, intrinsic):
        slam = open3d.t.pipelines.slam
        rows, columns = image.depth.rows, image.depth.columns
        if self.model is None:
            self.model = slam.Model(VOXEL_M, 16, 20000, core.Tensor(numpy.eye(4)), core.Device("CPU:0"))
            self.seen, self.cast = (slam.Frame(rows, columns, intrinsic, core.Device("CPU:0")) for _ in range(2))
        self.seen.set_data_from_image("depth", image.depth)
        self.seen.set_data_from_image("color", image.color)
        if self.count > 0:
            found = self.model.track_frame_to_model(self.seen, self.cast, DEPTH_SCALE, MAX_RANGE_M, 0.07)
            self.pose = self.pose @ found.transformation
        self.model.update_frame_pose(self.count, self.pose)
        self.model.integrate(self.seen, DEPTH_SCALE, MAX_RANGE_M, TRUNCATION_VOXELS)
        self.model.synthesize_model_frame(self.cast, DEPTH_SCALE, 0.1, MAX_RANGE_M, TRUNCATION_VOXELS, False)
        self.count += 1
        return self.pose.numpy()
