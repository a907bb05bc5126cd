# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""PNGs out of arrays and back, against Pillow."""
import io

import numpy as np
import ovimap
import pytest
from PIL import Image

random = np.random.default_rng(1)
COLOR = random.integers(0, 256, (48, 64, 3), np.uint8)
DEPTH = random.integers(0, 65536, (48, 64), np.uint16)


def opened(png):
    return np.asarray(Image.open(io.BytesIO(png)))


def test_colour_and_depth_are_written_as_they_are():
    np.testing.assert_array_equal(opened(ovimap.encode_png(COLOR)), COLOR)
    np.testing.assert_array_equal(opened(ovimap.encode_png(DEPTH)), DEPTH)
    np.testing.assert_array_equal(opened(ovimap.encode_png(COLOR[::2, ::-1])), COLOR[::2, ::-1])


@pytest.mark.parametrize("values", [DEPTH, (DEPTH >> 8).astype(np.uint8)])
def test_grey_values_are_read_as_stored(values):
    out = io.BytesIO()
    Image.fromarray(values).save(out, "PNG")
    read = ovimap.decode_gray_png(out.getvalue())
    assert read.dtype == np.uint16
    np.testing.assert_array_equal(read, values)


@pytest.mark.parametrize(
    ("image", "error", "words"),
    [
        (None, TypeError, "came None"),
        (DEPTH.astype(np.float32), TypeError, r"came float32 \[48, 64\]"),
        (COLOR.astype(np.int32), TypeError, r"came int32 \[48, 64, 3\]"),
        (COLOR[:, :, :2], ValueError, r"came uint8 \[48, 64, 2\]"),
        (DEPTH[0], ValueError, r"came uint16 \[64\]"),
        (DEPTH[:0], ovimap.Error, "cannot write a PNG of 64x0"),
    ],
)
def test_what_is_no_picture_is_refused(image, error, words):
    with pytest.raises(error, match=words):
        ovimap.encode_png(image)


@pytest.mark.parametrize(
    ("png", "words"),
    [(b"", "is empty"), (b"GIF89a", "is not a PNG"), (ovimap.encode_png(DEPTH)[:-200], "truncated"), (ovimap.encode_png(COLOR), "in colour")],
)
def test_what_is_no_grey_png_is_refused(png, words):
    with pytest.raises(ovimap.Error, match=words):
        ovimap.decode_gray_png(png)
