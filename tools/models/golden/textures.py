# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Images with edges and fine texture, so that the resize filter matters."""

import numpy as np


def textured_image(seed: int, width: int = 61, height: int = 47) -> np.ndarray:
    """Waves, noise and a plain patch, as 8-bit RGB."""
    rng = np.random.default_rng(seed)
    y, x = np.mgrid[0:height, 0:width]
    waves = [
        np.sin(x * rng.uniform(0.1, 0.9) + y * rng.uniform(-0.6, 0.6) + rng.uniform(0, 6))
        for _ in range(3)
    ]
    image = 127 + 80 * np.stack(waves, axis=2) + rng.normal(0, 25, (height, width, 3))
    image[height // 3 : height // 2, width // 4 : width // 2] = rng.integers(0, 256, 3)
    return np.clip(image, 0, 255).astype(np.uint8)
