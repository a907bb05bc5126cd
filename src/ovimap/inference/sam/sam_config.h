// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace ovimap {

class ConfigFields;

enum class Prompting {
  kAdaptive,  ///< at geometric regions, then wherever no mask covers the image yet
  kGrid,      ///< at the points of a regular grid, as SAM's own mask generator asks
};

/// Which things that a finder sees are asked for.
struct FinderConfig {
  int max_prompts = 30;    ///< a frame; 0: no finder is asked
  float min_depth = 0.3f;  ///< of a thing's middle, from 0 at a border to 1; lower peaks are none
  float min_mask_iou = 0.75f;  ///< as a finder rates its own mask; of a lesser one SAM is asked
  float decoder_trust = 0.5f;  ///< of SAM's own rating, beside the finder's, which is the true IoU
};

/// Settings of prompting a SAM-type network (method section 2).
struct SamConfig {
  Prompting prompting = Prompting::kAdaptive;
  int grid_side = 14;            ///< of kGrid: points along each side of the image
  int max_decoder_prompts = 40;  ///< of kAdaptive, a frame: decoding is most of the time
  int decoder_batch = 2;         ///< prompts decoded at once; between batches they are planned anew

  // Which proposals are masks at all.
  float min_predicted_iou = 0.82f;  ///< the network's own estimate
  float stability_offset = 1.f;     ///< logits by which the threshold is moved to test stability
  float min_stability = 0.72f;      ///< IoU between the masks at +offset and -offset
  int min_mask_px = 150;            ///< pixels of the colour image
  float max_mask_share = 0.9f;      ///< of the image; a larger mask is not an entity

  // Which of a prompt's masks is taken.
  float whole_stability = 0.88f;  ///< without a region: the largest as stable as this, or the best
  float region_size_penalty = 0.05f;  ///< with one: score lost per doubling or halving of its size

  // Which masks become entities.
  float duplicate_iou = 0.7f;  ///< of two masks that overlap more, the better is kept
  float part_inside_share =
      0.8f;                     ///< so much inside a larger one it may be a part: a finder tells;
  float better_margin = 0.1f;   ///< without one it is, unless it scores so much more, or
  float own_region_iou = 0.5f;  ///< ... fills a geometric region of its own to this degree and
  float own_region_margin = 0.05f;  ///< scores at most this much less
  float min_shown_share = 0.f;  ///< a mask of which smaller ones leave less in sight is no entity

  // Where the network is asked.
  int min_region_px = 500;       ///< smaller geometric regions prompt nothing
  float explained_share = 0.5f;  ///< a smaller share of its region is no explanation: ask the box
  float explained_ratio = 2.f;   ///< nor is a mask this many times larger than the region
  int min_hole_radius_px = 12;   ///< uncovered discs of at least this radius are prompted
  float hole_weight = 0.8f;      ///< rank of an uncovered disc's pixel; 1 in uncovered regions
  float box_weight = 0.3f;       ///< rank of a pixel in a region asked by its box
  FinderConfig finder;
};
void list_fields(FinderConfig& config, ConfigFields& fields);
void list_fields(SamConfig& config, ConfigFields& fields);

}  // namespace ovimap
