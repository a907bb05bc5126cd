# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""How do I use masks and embeddings of my own model? Usage: my_own_models.py RECORDING MAP

The "models" here are simple on purpose: masks are areas of like brightness, embeddings mean colours, and words are colours.
Put your networks in their place; torch tensors may be returned as they are, from the processor."""
import sys

import numpy as np
import ovimap


def masks(frame, prompts):
    """Entity ids [height, width] of the colour image, 0 = none."""
    return (frame.color.mean(axis=2) // 64 + 1).astype(np.uint8)


class MeanColour:
    name, dimension = "mean-colour", 3

    def encode_images(self, images):
        return np.array([image.reshape(-1, 3).mean(axis=0) for image in images])

    def encode_texts(self, texts):
        colours = {"red": (1, 0, 0), "green": (0, 1, 0), "blue": (0, 0, 1)}
        return np.array([colours.get(text, (1, 1, 1)) for text in texts], np.float32)


encoder = MeanColour()
mapper = ovimap.Mapper(masks, encoder)
for frame in ovimap.open_source(sys.argv[1]):
    mapper.process(frame)
mapper.save(sys.argv[2])
answer = ovimap.Map.open(sys.argv[2], encoder=encoder).query("blue")
print(f"the bluest object is {answer.matches[0].id}")
