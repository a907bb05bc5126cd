// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "ovimap/geometry/camera.h"
#include "ovimap/geometry/pose.h"
#include "ovimap/image/image.h"
#include "ovimap/semantics/views/appearance.h"

namespace ovimap {

enum class ViewStrategy {
  kCoverage,  ///< views that show enough surface not seen before (paper section 3.2)
  kCombine,   ///< such views, and only while among the largest (released default)
  kPixels,    ///< the largest views alone
  kRandom,    ///< drawn at random, each view with the same chance
  kAll,
};

/// Which views of an object are worth an encoder's time (method section 9).
struct ViewSelectionConfig {
  ViewStrategy strategy = ViewStrategy::kCoverage;
  int grid_rows = 24;         ///< bins of the polar angle
  int grid_columns = 32;      ///< bins of the azimuth
  int grid_px_per_bin = 0;    ///< the depth image's rows and columns that give one bin of either
                              ///< angle, in place of both numbers above; 0: those
  float theta_novel = 0.15f;  ///< share of a view's bins that must be new
  float better_ratio =
      2.f;  ///< a view this many times larger than any before counts as new; 0: none
  float recentre_share = 0.2f;  ///< coverage starts anew when the centre of what was seen has moved
                                ///< by this share of its diagonal; 0: never
  int min_mask_px = 250;        ///< smaller views show too little, in pixels that have colour
  int min_first_depth_px = 150;  ///< measured depth pixels an object's first view needs
  int min_depth_px = 50;         ///< ... and every later one
  int min_frames_seen = 2;       ///< an object seen in fewer frames may yet be merged away
  int top_views = 10;            ///< how many count as largest (combine, pixels)
  int random_views = 8;          ///< how many are drawn (random)
  int random_seed = 0;
  int max_samples = 2000;  ///< coverage looks at about so many of a view's pixels, evenly spread
  ViewFusion fusion;

  /// The bins of directions, for views of a depth camera.
  SphereGrid grid(const PinholeCamera& depth_camera) const;
};
void list_fields(ViewSelectionConfig& config, ConfigFields& fields);

/// "default", "paper", "viewcov", "combine", "vis", "random" or "all" (method section 9). Throws
/// Error for another name.
ViewSelectionConfig view_preset(const std::string& name);

/// The map as a frame's depth camera sees it.
struct SeenObjects {
  const DepthImage& depth;             ///< of the map, metres, 0 = no surface
  const Image<InstanceId>& instances;  ///< same size, 0 = none
  const Image<Label>& labels;          ///< same size, roots of their super-points
  const DepthImage& sensor_depth;      ///< same size, as measured
  /// Same size: where the colour image shows that surface (Registration::color_index of `depth`);
  /// negative where it does not.
  const Image<std::int32_t>& color_index;
  PinholeCamera camera;
  Pose world_from_camera = Pose::Identity();
  std::int64_t frame = 0;  ///< Frame::index
};

/// A view that was chosen.
struct ChosenView {
  InstanceId id = 0;
  Eigen::AlignedBox2i box_px;       ///< of the object in the depth camera's image, corners included
  ObjectView view;                  ///< without embedding and crop
  std::optional<ViewKey> replaced;  ///< a view of the object whose place it takes
};

/// Chooses views frame by frame. The same frames give the same choice on every run and thread
/// count.
class ViewSelector {
 public:
  explicit ViewSelector(const ViewSelectionConfig& config) : config_(config) {}

  /// The objects of this frame whose view should be embedded, by id. What is seen of all is noted
  /// in `looks`, which are by the labels' roots; the views themselves only by `commit`. Objects
  /// that the registry has seen in too few frames are passed over.
  std::vector<ChosenView> select(const SeenObjects& seen, const InstanceRegistry& registry,
                                 SuperPointLooks& looks);

  /// From now on the view counts as one of its object's.
  static void commit(ChosenView chosen, const LabelForest& forest, SuperPointLooks& looks);

  const ViewSelectionConfig& config() const { return config_; }

 private:
  struct Candidate;
  std::vector<Candidate> find_candidates(const SeenObjects& seen, const InstanceRegistry& registry,
                                         const SuperPointLooks& looks);
  int sample_step(int visible_px) const;
  /// Fills the candidate's points, directions and what its chosen views have covered.
  void cover(const SeenObjects& seen, Candidate& object) const;
  bool adds_something(const Candidate& candidate) const;
  bool decide(const Candidate& candidate, std::int64_t frame,
              std::optional<ViewKey>& replaced) const;

  ViewSelectionConfig config_;
  std::vector<std::int32_t> slot_of_id_;  ///< scratch of find_candidates; all -1 between calls
};

}  // namespace ovimap
