# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Tensors of torch wherever arrays are taken. torch is large, so set-up leaves it out; `pip install torch` runs these."""
import numpy as np
import ovimap
import pytest

try:
    import torch
except ModuleNotFoundError:
    torch = None

pytestmark = pytest.mark.skipif(torch is None, reason="torch is not installed; pip install torch")


@pytest.fixture
def images(camera):
    color = torch.randint(0, 256, (camera.height, camera.width, 3), dtype=torch.uint8)
    return color, torch.rand(camera.height, camera.width) * 3 + 0.5


def test_frames_are_made_of_tensors(camera, images):
    color, depth = images
    frame = ovimap.Frame(color, depth, torch.eye(4), camera)
    np.testing.assert_array_equal(frame.color, color.numpy())
    np.testing.assert_array_equal(frame.depth, depth.numpy())


def test_channels_first_are_permuted_without_a_copy_by_hand(camera, images):
    color, depth = images
    planes = color.permute(2, 0, 1).contiguous()
    frame = ovimap.Frame(planes.permute(1, 2, 0), depth.flip(0), torch.eye(4, dtype=torch.float64), camera)
    np.testing.assert_array_equal(frame.color, color.numpy())
    np.testing.assert_array_equal(frame.depth, depth.numpy()[::-1])


def test_channels_first_as_they_are_are_refused(camera, images):
    with pytest.raises(ValueError, match=r"color must be uint8 \[height, width, 3\], red first; came uint8 \[3, 48, 64\]"):
        ovimap.Frame(images[0].permute(2, 0, 1), images[1], torch.eye(4), camera)


def test_half_precision_is_refused(camera, images):
    for kind, name in ((torch.float16, "float16"), (torch.bfloat16, "bfloat16")):
        with pytest.raises(TypeError, match=f"depth must be float32 .* came {name}"):
            ovimap.Frame(images[0], images[1].to(kind), torch.eye(4), camera)


def test_a_tensor_with_a_gradient_gives_its_values(camera, images):
    color, depth = images
    frame = ovimap.Frame(color, depth.requires_grad_(), torch.eye(4), camera)
    np.testing.assert_array_equal(frame.depth, depth.detach().numpy())


def test_a_tensor_without_memory_is_refused(camera, images):
    with pytest.raises(ValueError, match="meta"):  # torch's own words
        ovimap.Frame(images[0].to("meta"), images[1], torch.eye(4), camera)


def test_views_of_the_library_become_tensors(camera, images):
    frame = ovimap.Frame(*images, torch.eye(4), camera)
    assert torch.equal(torch.tensor(frame.depth), images[1])


class Encoder:
    """A small network of torch: mean colour, through a layer."""

    name, dimension = "torch-test", 8

    def __init__(self):
        torch.manual_seed(1)
        self.layer = torch.nn.Linear(3, self.dimension)

    def encode_images(self, images):
        with torch.no_grad():
            return self.layer(torch.stack([torch.tensor(image).float().mean((0, 1)) for image in images]))

    def encode_texts(self, texts):
        return torch.ones(len(texts), self.dimension)


def test_masks_and_embeddings_are_tensors(room, tmp_path):
    def masks(frame, prompts):
        bright = torch.tensor(frame.color).float().mean(2) > 128
        return bright.to(torch.int64) + 1

    made = ovimap.run(room, tmp_path / "torch.ovimap", masks=masks, encoder=Encoder(), frames="::4")
    assert made.embeddings.shape == (len(made), 8) and np.isfinite(made.embeddings).all()
    asked = ovimap.Map.open(tmp_path / "torch.ovimap", encoder=Encoder())
    assert len(asked.query("anything").matches) > 0


def test_masks_of_another_type_are_told(room):
    mapper = ovimap.Mapper(lambda frame, prompts: torch.zeros(frame.color.shape[:2], requires_grad=True))
    with pytest.raises(TypeError, match=r"what the masks callable returned must be integers or bool .* came float32"):
        for frame in ovimap.open_source(room).frames(":2"):
            mapper.process(frame)
