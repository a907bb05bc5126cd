// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "ovimap/inference/image_text_encoder.h"
#include "ovimap/instance/instance_registry.h"
#include "ovimap/semantics/object_crop.h"
#include "ovimap/semantics/sphere_grid.h"

namespace ovimap {

class ConfigFields;

/// How the embeddings of an object's views become one (paper section 3.2, equation for f_k, and the
/// fusion ablation).
enum class FeatureFusion {
  kPixelWeighted,  ///< mean, each view weighing as many pixels as it shows
  kMean,
  kMaxCosine,  ///< the view most alike to the others: largest mean cosine
  kMinL1,      ///< the view nearest to the others: smallest mean L1 distance
};

/// Which of an object's views become one embedding, and how.
struct ViewFusion {
  ViewFusion(FeatureFusion how = FeatureFusion::kPixelWeighted, int so_many = 0)
      : rule(how), largest_views(so_many) {}
  FeatureFusion rule;
  int largest_views;  ///< only so many of the largest count (the earlier of equals); 0: all
  bool operator==(const ViewFusion&) const = default;
};

/// One view of an object that was chosen to tell what the object looks like.
struct ObjectView {
  std::int64_t frame = 0;  ///< Frame::index
  int visible_px = 0;
  Eigen::VectorXf embedding;  ///< unit length; empty until the encoder has answered
  StoredCrop crop;            ///< empty unless among the object's largest
  std::uint64_t ticket = 0;   ///< of the request that is under way; meaningless in a saved map
};

/// From where an object was seen.
struct ViewCoverage {
  Eigen::Vector3f center_in_world = Eigen::Vector3f::Zero();  ///< the directions' origin
  Eigen::AlignedBox3f seen_in_world;                          ///< of all surface points seen
  BinSet bins;         ///< directions from the centre to seen surface; empty: none chosen yet
  int largest_px = 0;  ///< of the chosen views
};

/// What the map knows of an object's look.
struct Appearance {
  ViewCoverage coverage;
  std::vector<ObjectView> views;  ///< by frame, ascending
  int offered = 0;                ///< views that were large enough to choose from
  int queries = 0;                ///< views chosen, those replaced later included
};

/// The looks of all objects, by instance id.
using Appearances = std::map<InstanceId, Appearance>;

/// One embedding of the views that have one, of length 1; empty when none has.
Eigen::VectorXf fuse_views(std::span<const ObjectView> views, const ViewFusion& fusion);

/// Gives what is known of `drop` to `keep`: views are put together, seen directions united.
void merge_appearance(Appearances& appearances, InstanceId keep, InstanceId drop);

/// Follows the registry's merges: afterwards every id is one that the registry still uses.
void follow_merges(Appearances& appearances, const InstanceRegistry& registry);

/// Keeps the crops of the `kept_views` largest views of each object (the earlier one of two
/// equals).
void prune_crops(Appearance& appearance, int kept_views);

/// Row i is the fused embedding of ids[i]; zeros for an object without one.
Embeddings fused_embeddings(const Appearances& appearances, std::span<const InstanceId> ids,
                            const ViewFusion& fusion, int dimension);

}  // namespace ovimap
