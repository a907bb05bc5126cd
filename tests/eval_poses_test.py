# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Holds `ovimap eval-poses` against evo on random trajectories.

Usage: eval_poses_test.py PROGRAM. Needs evo (tools/requirements-test.txt); without it the test is skipped.
"""
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

try:
    import numpy
    from evo.core import metrics, sync
    from evo.tools import file_interface
except ImportError:
    print("skipped: evo is not installed (tools/setup.sh --tests)")
    sys.exit(77)

PROGRAM = None
MAX_GAP_S = 0.01


def quaternion(axis, angle):
    axis = axis / numpy.linalg.norm(axis)
    return numpy.append(axis * numpy.sin(angle / 2), numpy.cos(angle / 2))


def write(path, times, places, turns):
    rows = numpy.column_stack([times, places, turns])
    numpy.savetxt(path, rows, fmt="%.9f")


def random_pair(seed, folder):
    """A smooth walk and an estimate of it: noisy, in another world, with poses left out."""
    draw = numpy.random.default_rng(seed)
    count = 120
    times = 100 + numpy.arange(count) / 30
    places = numpy.cumsum(draw.normal(0, 0.03, (count, 3)), axis=0)
    axes = draw.normal(size=3) + 0.1 * draw.normal(size=(count, 3))
    angles = numpy.cumsum(draw.normal(0.02, 0.02, count))
    turns = numpy.array([quaternion(axis, angle) for axis, angle in zip(axes, angles)])
    truth, estimate = folder / "truth.txt", folder / "estimate.txt"
    write(truth, times, places, turns)
    kept = numpy.sort(draw.choice(count, 100, replace=False))
    rotation, _ = numpy.linalg.qr(draw.normal(size=(3, 3)))
    rotation *= numpy.sign(numpy.linalg.det(rotation))
    moved = (places[kept] + draw.normal(0, 0.02, (len(kept), 3))) @ rotation.T + draw.normal(size=3)
    noisy = numpy.array([quaternion(axes[i] + draw.normal(0, 0.05, 3), angles[i]) for i in kept])
    write(estimate, times[kept] + draw.uniform(-0.004, 0.004, len(kept)), moved, noisy)
    return truth, estimate


def evo_scores(truth, estimate):
    reference, found = sync.associate_trajectories(
        file_interface.read_tum_trajectory_file(str(truth)), file_interface.read_tum_trajectory_file(str(estimate)),
        max_diff=MAX_GAP_S)
    def statistics(metric):
        metric.process_data((reference, found))
        return metric.get_all_statistics()
    scores = {
        "rpe_m": statistics(metrics.RPE(metrics.PoseRelation.translation_part, 1, metrics.Unit.frames, all_pairs=False)),
        "rpe_deg": statistics(metrics.RPE(metrics.PoseRelation.rotation_angle_deg, 1, metrics.Unit.frames, all_pairs=False)),
    }
    found.align(reference)
    scores["ate_m"] = statistics(metrics.APE(metrics.PoseRelation.translation_part))
    return reference.num_poses, scores


class AgainstEvo(unittest.TestCase):
    def test_every_figure_agrees(self):
        for seed in range(8):
            with self.subTest(seed=seed), tempfile.TemporaryDirectory() as name:
                truth, estimate = random_pair(seed, pathlib.Path(name))
                ours = json.loads(subprocess.run([PROGRAM, "eval-poses", estimate, truth, "--max-gap", str(MAX_GAP_S), "--json"],
                                                 stdout=subprocess.PIPE, check=True).stdout)
                matched, theirs = evo_scores(truth, estimate)
                self.assertEqual(ours["matched"], matched)
                for metric, statistics in theirs.items():
                    for figure in ("rmse", "mean", "median", "max"):
                        self.assertAlmostEqual(ours[metric][figure], statistics[figure], places=6, msg=f"{metric} {figure}")


if __name__ == "__main__":
    PROGRAM = sys.argv.pop(1)
    unittest.main()
