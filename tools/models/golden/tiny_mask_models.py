# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Tiny Mask2Former and SAM checkpoints with random weights."""

import torch
from transformers import (
    Mask2FormerConfig,
    Mask2FormerForUniversalSegmentation,
    Mask2FormerImageProcessorPil,
    SamConfig,
    SamImageProcessorPil,
    SamModel,
    SwinConfig,
)

from .tiny_models import fill

MASK2FORMER_PX, SAM_PX = 64, 128
QUERIES, CLASSES = 8, 3
NORM_GROUPS = 32  # of the pixel decoder: fixed in its code, so no fewer channels
# So that some queries are sure of their class, look at different things, and few logits are near 0.
CLASS_GAIN, QUERY_GAIN, LOGIT_GAIN = 4.0, 8.0, 20.0
ATTENTION_GAIN = 1.2  # more would let rounding errors grow from layer to layer
SAM_PATCH_PX, SAM_WIDTH, SAM_DECODER_WIDTH = 16, 8, 16


@torch.no_grad()
def scale(parameter, factor: float) -> None:
    parameter.mul_(factor)


def tiny_mask2former(seed: int):
    """Model and processor; images are stretched to a square, as the published checkpoints do."""
    backbone = SwinConfig(
        image_size=MASK2FORMER_PX,
        patch_size=4,
        embed_dim=4,
        depths=[1, 1, 1, 1],
        num_heads=[1, 1, 2, 2],
        window_size=4,
        mlp_ratio=1.0,
        out_features=["stage1", "stage2", "stage3", "stage4"],
    )
    config = Mask2FormerConfig(
        backbone_config=backbone,
        feature_size=NORM_GROUPS,
        mask_feature_size=NORM_GROUPS,
        hidden_dim=NORM_GROUPS,
        encoder_feedforward_dim=8,
        dim_feedforward=8,
        encoder_layers=1,
        decoder_layers=2,
        num_attention_heads=2,
        num_queries=QUERIES,
        num_labels=CLASSES,
    )
    model = fill(Mask2FormerForUniversalSegmentation(config), ATTENTION_GAIN, seed=seed)
    decoder = model.model.transformer_module
    scale(model.class_predictor.weight, CLASS_GAIN)
    scale(decoder.queries_features.weight, QUERY_GAIN)
    scale(decoder.queries_embedder.weight, QUERY_GAIN)
    scale(list(decoder.decoder.mask_predictor.mask_embedder.parameters())[-2], LOGIT_GAIN)
    size = {"height": MASK2FORMER_PX, "width": MASK2FORMER_PX}
    return model, Mask2FormerImageProcessorPil(size=size, ignore_index=255)


def tiny_sam(seed: int):
    """Model and processor."""
    grid = SAM_PX // SAM_PATCH_PX
    config = SamConfig(
        vision_config={
            "hidden_size": SAM_WIDTH,
            "output_channels": SAM_DECODER_WIDTH,
            "num_hidden_layers": 2,
            "num_attention_heads": 2,
            "image_size": SAM_PX,
            "patch_size": SAM_PATCH_PX,
            "mlp_dim": SAM_WIDTH,
            "num_pos_feats": SAM_DECODER_WIDTH // 2,
            "window_size": 3,
            "global_attn_indexes": [1],
        },
        prompt_encoder_config={
            "hidden_size": SAM_DECODER_WIDTH,
            "image_size": SAM_PX,
            "patch_size": SAM_PATCH_PX,
            "image_embedding_size": grid,
            "mask_input_channels": 4,
        },
        mask_decoder_config={
            "hidden_size": SAM_DECODER_WIDTH,
            "mlp_dim": SAM_DECODER_WIDTH,
            "num_hidden_layers": 2,
            "num_attention_heads": 2,
            "iou_head_hidden_dim": SAM_DECODER_WIDTH,
        },
    )
    side = {"height": SAM_PX, "width": SAM_PX}
    processor = SamImageProcessorPil(size={"longest_edge": SAM_PX}, pad_size=side)
    model = fill(SamModel(config), ATTENTION_GAIN, seed=seed)
    for network in model.mask_decoder.output_hypernetworks_mlps:
        scale(network.proj_out.weight, LOGIT_GAIN)
    return model, processor
