// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/inference/sam/sam_config.h"

#include "ovimap/base/config.h"

namespace ovimap {

void list_fields(FinderConfig& config, ConfigFields& fields) {
  fields.add("max_prompts", config.max_prompts, 0, 4096,
             "things a frame that the model's finder sees and that are asked for; 0: none");
  fields.add("min_depth", config.min_depth, 0.f, 1.f,
             "how sure the finder is of a thing's middle at least");
  fields.add("min_mask_iou", config.min_mask_iou, 0.f, 2.f,
             "how good the finder believes a mask of its own to be that is taken without asking; "
             "2: none");
  fields.add("decoder_trust", config.decoder_trust, 0.f, 1.f,
             "what a rating of the decoder is worth beside one of the finder, where there is one");
}

void list_fields(SamConfig& config, ConfigFields& fields) {
  constexpr int kMaxPixels = 100000000;
  fields.add_choice<Prompting>(
      "prompting", config.prompting,
      {{"adaptive", Prompting::kAdaptive}, {"grid", Prompting::kGrid}},
      "where the network is asked: where something is unexplained, or everywhere");
  fields.add("grid_side", config.grid_side, 1, 64, "points of the grid along each side");
  fields.add("max_decoder_prompts", config.max_decoder_prompts, 1, 4096,
             "prompts a frame at most (adaptive)");
  fields.add("decoder_batch", config.decoder_batch, 1, 256, "prompts decoded at once");
  fields.add("min_predicted_iou", config.min_predicted_iou, 0.f, 1.f,
             "masks that the network itself rates lower are dropped");
  fields.add("stability_offset", config.stability_offset, 0.f, 10.f,
             "logits by which the threshold is moved to test stability");
  fields.add("min_stability", config.min_stability, 0.f, 1.f,
             "IoU of a mask at both moved thresholds; lower ones are dropped");
  fields.add("min_mask_px", config.min_mask_px, 1, kMaxPixels,
             "smaller masks are dropped (colour pixels)");
  fields.add("max_mask_share", config.max_mask_share, 0.f, 1.f,
             "a mask of a larger share of the image is not an entity");
  fields.add(
      "whole_stability", config.whole_stability, 0.f, 1.f,
      "where no region prompted, the largest mask as stable as this is taken, else the best");
  fields.add("region_size_penalty", config.region_size_penalty, 0.f, 1.f,
             "score a mask loses per doubling or halving of the prompting region's size");
  fields.add("duplicate_iou", config.duplicate_iou, 0.f, 1.f,
             "of two masks that overlap more, the better is kept");
  fields.add(
      "part_inside_share", config.part_inside_share, 0.f, 1.f,
      "a mask this much inside a larger one may be its part: a finder tells, or the next three");
  fields.add("better_margin", config.better_margin, 0.f, 1.f,
             "a mask that scores this much more than the larger one is no part");
  fields.add("own_region_iou", config.own_region_iou, 0.f, 1.f,
             "how well a mask must fill a geometric region of its own to be no part");
  fields.add("own_region_margin", config.own_region_margin, 0.f, 1.f,
             "... if it scores at most this much less than the larger one");
  fields.add("min_shown_share", config.min_shown_share, 0.f, 1.f,
             "a mask of which smaller ones leave less in sight is no entity");
  fields.add("min_region_px", config.min_region_px, 1, kMaxPixels,
             "smaller geometric regions prompt nothing (colour pixels)");
  fields.add("explained_share", config.explained_share, 0.f, 1.f,
             "a region is asked by its box when its point gave less than this share of it");
  fields.add("explained_ratio", config.explained_ratio, 1.f, 1000.f,
             "a region is asked by its box inside a mask this many times its size");
  fields.add("min_hole_radius_px", config.min_hole_radius_px, 1, 10000,
             "uncovered discs of at least this radius are prompted (colour pixels)");
  fields.add("hole_weight", config.hole_weight, 0.f, 10.f,
             "rank of an uncovered disc's pixel against 1 in an uncovered region");
  fields.add("box_weight", config.box_weight, 0.f, 10.f,
             "rank of a pixel in a region asked by its box against 1 in an uncovered region");
  fields.group("finder", [&](ConfigFields& group) { list_fields(config.finder, group); });
}

}  // namespace ovimap
