#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Draws a walk that was tracked twice, loops left open and closed: from above, coloured by how far each pose is off.

Usage: loop_picture.py TRUE.txt OPEN.txt CLOSED.txt PICTURE

TUM lines, of a camera whose world has z up (docs/tracking.md). Both tracks are laid on the truth by their first pose, as a
map is that begins there: what a best fit of all poses would share out among them is seen where it arises."""
import pathlib
import sys

import numpy as np
from PIL import Image, ImageDraw, ImageFont
from tracking import matrix_of

WIDTH_PX, MARGIN_PX, BAR_PX = 560, 30, 90
COLORS = np.array([[44, 123, 182], [171, 217, 233], [255, 255, 160], [253, 174, 97], [215, 25, 28]])  # of none to the largest
INK, PAPER = (40, 40, 40), (255, 255, 255)


def poses_of(file):
    """Their places [n, 3] in metres, and the rotation of the first."""
    rows = np.loadtxt(file, comments="#")
    return rows[:, 1:4], np.array(matrix_of(rows[0, 4:8], rows[0, 1:4]))[:, :3]


def laid_on(track, truth):
    (places, turn), (true_places, true_turn) = track, truth
    if len(places) != len(true_places):
        sys.exit(f"loop_picture: {len(places)} poses were tracked of {len(true_places)}; it takes walks that were tracked whole")
    return (places - places[0]) @ (true_turn @ turn.T).T + true_places[0]


def colors_of(shares):
    at = np.clip(shares, 0, 1) * (len(COLORS) - 1)
    low = np.minimum(at.astype(int), len(COLORS) - 2)
    part = (at - low)[:, None]
    return np.rint(COLORS[low] * (1 - part) + COLORS[low + 1] * part).astype(int)


def panel(title, places, errors_m, most_m, frame):
    low, metre_px, height = frame
    picture = Image.new("RGB", (WIDTH_PX, height), PAPER)
    draw, font = ImageDraw.Draw(picture), ImageFont.load_default(16)
    at = (places[:, :2] - low) * metre_px + MARGIN_PX
    at[:, 1] = height - BAR_PX - at[:, 1] + MARGIN_PX
    for here, there, color in zip(at[:-1], at[1:], colors_of(errors_m / most_m)):
        draw.line([*here, *there], fill=tuple(color), width=5)
    draw.ellipse([*(at[0] - 6), *(at[0] + 6)], outline=INK, width=2)
    draw.text((MARGIN_PX, 6), f"{title}: end {100 * errors_m[-1]:.1f} cm off, at most {100 * errors_m.max():.1f} cm", fill=INK, font=font)
    return picture


def bar(picture, most_m):
    """What the colours mean."""
    draw, font = ImageDraw.Draw(picture), ImageFont.load_default(14)
    left, top, width = MARGIN_PX, picture.height - 40, 300
    for i, color in enumerate(colors_of(np.linspace(0, 1, width))):
        draw.line([left + i, top, left + i, top + 12], fill=tuple(color))
    draw.text((left, top + 15), "0", fill=INK, font=font)
    draw.text((left + width - 20, top + 15), f"{100 * most_m:.1f} cm off", fill=INK, font=font)


def main():
    if len(sys.argv) != 5:
        sys.exit(__doc__)
    truth, *tracks = (poses_of(file) for file in sys.argv[1:4])
    laid = [laid_on(track, truth) for track in tracks]
    errors = [np.linalg.norm(places - truth[0], axis=1) for places in laid]
    most_m = max(error.max() for error in errors)
    low, high = truth[0][:, :2].min(axis=0), truth[0][:, :2].max(axis=0)
    metre_px = (WIDTH_PX - 2 * MARGIN_PX) / (high - low)[0]
    frame = low, metre_px, int((high - low)[1] * metre_px) + 2 * MARGIN_PX + BAR_PX
    panels = [panel(title, places, error, most_m, frame) for title, places, error in zip(("loops left open", "loops closed"), laid, errors)]
    whole = Image.new("RGB", (2 * WIDTH_PX, frame[2]), PAPER)
    for i, part in enumerate(panels):
        whole.paste(part, (i * WIDTH_PX, 0))
    bar(whole, most_m)
    whole.save(pathlib.Path(sys.argv[4]), quality=88)


if __name__ == "__main__":
    main()
