// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "ovimap/inference/encoders/image_text_encoder.h"
#include "ovimap/inference/things/thing_recognizer.h"
#include "ovimap/inference/writing/writing_reader.h"
#include "ovimap/instance/instance_summary.h"
#include "ovimap/semantics/views/object_crop.h"
#include "ovimap/semantics/views/sphere_grid.h"

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

/// From where a view showed its object.
struct ViewDirections {
  Eigen::Vector3f center_in_world = Eigen::Vector3f::Zero();  ///< the directions' origin
  BinSet bins;  ///< directions from the centre to surface in sight; empty: not known
};

/// Says which view is meant, whatever is merged or taken apart meanwhile.
struct ViewKey {
  std::int64_t frame = 0;        ///< Frame::index
  Label super_point = kNoLabel;  ///< that most of the view showed, by its label in that frame
  auto operator<=>(const ViewKey&) const = default;
};

/// One view of an object that was chosen to tell what the object looks like. It belongs to the
/// super-point that covers most of it.
struct ObjectView {
  std::int64_t frame = 0;  ///< Frame::index
  int visible_px = 0;      ///< of the object, pixels of the depth image that the colour image shows
  Eigen::VectorXf embedding;  ///< unit length; empty until the encoder has answered
  StoredCrop crop;            ///< empty unless among the super-point's largest
  Label super_point = kNoLabel;
  ViewDirections directions;
  std::vector<WrittenLine> writing = {};  ///< read in the crop, within its pixels
  Eigen::VectorXf things = {};  ///< log ratios of what a recognizer tells; empty: it did not look

  ViewKey key() const { return {frame, super_point}; }
};

/// What is known of a super-point's look.
struct SuperPointLook {
  Eigen::AlignedBox3f seen_in_world;  ///< of its surface in all views that were offered
  std::vector<ObjectView> views;      ///< by key, ascending
  int offered = 0;  ///< views large enough to choose from of which it covered the most
  int queries = 0;  ///< of these, chosen, those replaced later included
};
using SuperPointLooks = std::map<Label, SuperPointLook>;  ///< by root

/// What an object looks like: what its super-points do together. Refers to their views.
struct Appearance {
  Eigen::AlignedBox3f seen_in_world;
  std::vector<const ObjectView*> views;  ///< by key, ascending
  int offered = 0;
  int queries = 0;
};

/// The look of an object that consists of these super-points (roots).
Appearance appearance_of(const SuperPointLooks& looks, std::span<const Label> super_points);

/// One embedding of the views that have one, of length 1; empty when none has.
Eigen::VectorXf fuse_views(std::span<const ObjectView* const> views, const ViewFusion& fusion);

/// [things] the log ratios that the views of an object amount to; empty when no recognizer looked
/// at any of them.
Eigen::VectorXf things_of(std::span<const ObjectView* const> views);
/// What correlated log ratios amount to, of which these are the sum.
float joint_log_ratio(float sum, std::size_t count);

/// Brings the looks under the labels that the forest resolves them to. Super-points merge for good.
void follow_merges(SuperPointLooks& looks, const LabelForest& forest);

/// Puts a view in its place.
void insert_view(SuperPointLook& look, ObjectView view);

/// Null when there is none.
ObjectView* find_view(SuperPointLook& look, const ViewKey& key);

/// Keeps the crops of the `kept_views` largest views of a super-point (the earlier one of two
/// equals).
void prune_crops(SuperPointLook& look, int kept_views);

/// Row i is the fused embedding of objects[i]; zeros for an object without one.
Embeddings fused_embeddings(const SuperPointLooks& looks, std::span<const InstanceSummary> objects,
                            const ViewFusion& fusion, int dimension);

}  // namespace ovimap
