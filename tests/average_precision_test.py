# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Holds the semantic figures against a second implementation, from the published definitions, on random scenes.

Usage: average_precision_test.py PROGRAM, with PROGRAM built from score_scenes.cpp. Every instance is a plain set of
vertices here, every confidence threshold is scored afresh, and all sums are exact fractions.
"""
import collections
import pathlib
import random
import subprocess
import sys
import unittest
from fractions import Fraction

PROGRAM = None
CLASSES, STUFF = 5, {5}
STANDARD = range(50, 100, 5)
REFERENCE = range(50, 95, 5)
MIN_REGION = 100

Scene = collections.namedtuple("Scene", "truth classes predicted class_of confidence")


def random_scene(seed):
    """Blocks of vertices; most predictions follow a truth instance, some are split, merged or stray."""
    draw = random.Random(seed)
    truth, classes, predicted = [], [], []
    class_of_truth = {i: draw.randint(0, CLASSES) for i in range(0, 15)}
    for instance in range(0, 15):
        for part in range(draw.randint(1, 5)):
            count = draw.choice([3, 20, 45, 60, 110, 200])
            label = instance + 1 if part < 2 else draw.randint(0, 18)
            touched = class_of_truth[instance] if draw.random() < 0.95 else draw.randint(0, CLASSES)
            truth += [instance] * count
            classes += [touched] * count
            predicted += [label] * count
    class_of, confidence = {}, {}
    for label in range(1, 19):
        right = class_of_truth.get(label - 1, 0)
        class_of[label] = right if draw.random() < 0.7 else draw.randint(0, CLASSES)
        confidence[label] = draw.randint(1, 6) / 8  # ties are wanted
    return Scene(truth, classes, predicted, class_of, confidence)


def vertices_by_id(ids, lowest):
    groups = collections.defaultdict(set)
    for vertex, label in enumerate(ids):
        if label > lowest:
            groups[label].add(vertex)
    return dict(sorted(groups.items()))


def iou(a, b):
    return Fraction(len(a & b), len(a | b))


# --- standard: one ranking, one-to-one, interpolated precision ---------------------------------------------------

def standard_instances(scene, wanted):
    """Truth and predicted instances of a class (None: all), and the vertices where nothing is known."""
    truth, known = {}, set()
    for label, vertices in vertices_by_id(scene.truth, 0).items():
        counts = collections.Counter(scene.classes[v] for v in vertices)
        majority = min(c for c in counts if counts[c] == max(counts.values()))
        if majority or wanted is None:
            known |= vertices
        if wanted in (None, majority):
            truth[label] = vertices
    predicted = {label: vertices for label, vertices in vertices_by_id(scene.predicted, 0).items()
                 if wanted is None or scene.class_of[label] == wanted}
    return truth, predicted, set(range(len(scene.truth))) - known


def standard_ap(scenes, wanted, percent):
    threshold = Fraction(percent, 100)
    parts = [standard_instances(scene, wanted) for scene in scenes]
    total = sum(len(truth) for truth, _, _ in parts)
    if total == 0:
        return None
    ranking = [(-scenes[s].confidence[label], s, label) for s, part in enumerate(parts) for label in part[1]]
    free = [set(truth) for truth, _, _ in parts]
    outcomes = []
    for _, s, label in sorted(ranking):
        truth, predicted, void = parts[s]
        mine = predicted[label]
        reached = {t: iou(truth[t], mine) for t in truth if iou(truth[t], mine) >= threshold}
        candidates = [t for t in reached if t in free[s]]
        if candidates:
            free[s].remove(min(candidates, key=lambda t: (-reached[t], t)))
            outcomes.append(True)
        elif reached or Fraction(len(mine & void), len(mine)) <= threshold:
            outcomes.append(False)
    precisions = [Fraction(sum(outcomes[:n + 1]), n + 1) for n in range(len(outcomes))]
    return sum((max(precisions[n:]) for n, right in enumerate(outcomes) if right), Fraction(0)) / total


# --- reference: the ScanNet benchmark's curve ---------------------------------------------------------------------

def reference_instances(scene, wanted):
    scored = set(range(1, CLASSES + 1)) - STUFF
    truth = {label: vertices for label, vertices in vertices_by_id(scene.truth, min(scene.truth)).items()
             if max(scene.classes[v] for v in vertices) == wanted}
    predicted = {label: vertices for label, vertices in vertices_by_id(scene.predicted, 0).items()
                 if scene.class_of[label] == wanted}
    largest = max((len(vertices) for vertices in predicted.values()), default=1)
    confidence = {label: Fraction(len(vertices), largest) for label, vertices in predicted.items()}
    predicted = {label: vertices for label, vertices in predicted.items() if len(vertices) >= MIN_REGION}
    void = {v for v, c in enumerate(scene.classes) if c not in scored}
    return truth, predicted, confidence, void


def reference_judgements(scene, wanted, threshold):
    """(confidence, right) of every prediction that counts, and how many truth instances there are and are missed."""
    truth, predicted, confidence, void = reference_instances(scene, wanted)
    judged, used, missed, count = [], set(), 0, 0
    for vertices in truth.values():
        if len(vertices) < MIN_REGION:
            continue
        count += 1
        hits = [p for p in predicted if p not in used and iou(vertices, predicted[p]) > threshold]
        if not hits:
            missed += 1
            continue
        used.add(hits[0])
        ranked = sorted((confidence[p] for p in hits), reverse=True)
        judged.append((ranked[0], True))
        judged += [(c, False) for c in ranked[1:]]
    small = set().union(*(v for v in truth.values() if len(v) < MIN_REGION), set())
    for p, mine in predicted.items():
        if any(iou(vertices, mine) > threshold for vertices in truth.values()):
            continue
        ignorable = len(mine & void) + len(mine & small)  # what is both counts twice there
        if Fraction(ignorable, len(mine)) <= threshold:
            judged.append((confidence[p], False))
    return judged, missed, count


def reference_ap(scenes, wanted, percent):
    judged, missed, count = [], 0, 0
    for scene in scenes:
        j, m, c = reference_judgements(scene, wanted, Fraction(percent, 100))
        judged, missed, count = judged + j, missed + m, count + c
    if count == 0:
        return None
    points = []
    for cut in sorted({c for c, _ in judged}):
        kept = [right for c, right in judged if c >= cut]
        points.append((Fraction(sum(kept), sum(r for _, r in judged) + missed), Fraction(sum(kept), len(kept))))
    points.append((Fraction(0), Fraction(1)))
    recalls = [points[0][0]] + [r for r, _ in points] + [Fraction(0)]
    return sum(p * (recalls[i] - recalls[i + 2]) / 2 for i, (_, p) in enumerate(points))


# --- vertices -----------------------------------------------------------------------------------------------------

def confusion(scenes):
    matrix = collections.Counter()
    for scene in scenes:
        for truth, label in zip(scene.classes, scene.predicted):
            matrix[truth, scene.class_of.get(label, 0)] += 1
    figures = {}
    for c in range(1, CLASSES + 1):
        right = matrix[c, c]
        truth = sum(n for (t, _), n in matrix.items() if t == c)
        predicted = sum(n for (t, p), n in matrix.items() if p == c and t > 0)
        if truth:
            figures[c] = (Fraction(right, truth + predicted - right), Fraction(right, truth), truth)
    return figures


def program_figures(scenes):
    lines = [f"classes {CLASSES} " + " ".join(map(str, STUFF))]
    for scene in scenes:
        lines.append(f"scene {len(scene.truth)}")
        lines += [f"{t} {c} {p}" for t, c, p in zip(scene.truth, scene.classes, scene.predicted)]
        lines.append(f"instances {len(scene.class_of)}")
        lines += [f"{label} {c} {scene.confidence[label]}" for label, c in scene.class_of.items()]
    done = subprocess.run([PROGRAM], input="\n".join(lines) + "\n", stdout=subprocess.PIPE, text=True, check=True)
    pairs = (line.split() for line in done.stdout.splitlines())
    return {name: None if value == "none" else float(value) for name, value in pairs}


class SecondImplementation(unittest.TestCase):
    def agree(self, mine, theirs, name):
        self.assertEqual(mine is None, theirs is None, name)
        if mine is not None:
            self.assertAlmostEqual(float(mine), theirs, places=11, msg=name)

    def check_precision(self, scenes, figures, protocol, ap, thresholds):
        means = []
        for c in range(1, CLASSES + 1):
            if protocol == "reference" and c in STUFF:
                self.assertIsNone(figures[f"{protocol}.{c}.ap"])
                continue
            for percent in (25, 50, 75):
                self.agree(ap(scenes, c, percent), figures[f"{protocol}.{c}.ap{percent}"], f"{protocol} {c} {percent}")
            values = [ap(scenes, c, percent) for percent in thresholds]
            mean = None if values[0] is None else sum(values) / len(values)
            self.agree(mean, figures[f"{protocol}.{c}.ap"], f"{protocol} {c} mean")
            means += [] if mean is None else [mean]
        self.agree(sum(means) / len(means), figures[f"{protocol}.ap"], f"{protocol} mean")
        return sum(means) / len(means)

    def test_agrees_on_random_scenes(self):
        seen = {"standard": [], "reference": []}
        for seed in range(8):
            scenes = [random_scene(100 * seed + s) for s in range(1 + seed % 3)]
            figures = program_figures(scenes)
            seen["standard"].append(self.check_precision(scenes, figures, "standard", standard_ap, STANDARD))
            seen["reference"].append(self.check_precision(scenes, figures, "reference", reference_ap, REFERENCE))
            for percent in (25, 50, 75):
                self.agree(standard_ap(scenes, None, percent), figures[f"instances.ap{percent}"], "class-agnostic")
        for protocol, means in seen.items():
            self.assertGreater(len(set(means)), 6, f"{protocol}: the scenes should differ,")
            self.assertGreater(sum(means) / len(means), 0.02, "be neither hopeless")
            self.assertLess(max(means), 0.98, "nor trivial")

    def test_confusion_agrees(self):
        scenes = [random_scene(seed) for seed in range(50, 53)]
        figures = program_figures(scenes)
        mine = confusion(scenes)
        for c in range(1, CLASSES + 1):
            self.agree(mine[c][0] if c in mine else None, figures[f"standard.{c}.iou"], c)
            self.agree(mine[c][1] if c in mine else None, figures[f"reference.{c}.accuracy"], c)
        self.agree(sum(f[0] for f in mine.values()) / len(mine), figures["standard.miou"], "mIoU")
        self.agree(sum(f[1] for f in mine.values()) / len(mine), figures["standard.macc"], "mAcc")
        weighted = sum(f[0] * f[2] for f in mine.values()) / sum(f[2] for f in mine.values())
        self.agree(weighted, figures["reference.fwiou"], "fwIoU")


if __name__ == "__main__":
    PROGRAM = sys.argv.pop(1) if len(sys.argv) > 1 else ""
    if not pathlib.Path(PROGRAM).is_file():
        print(f"skipped: there is no program '{PROGRAM}' to compare with; build ovimap_score_scenes")
        sys.exit(77)
    unittest.main()
