// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/semantics/views/view_selection.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "ovimap/base/config.h"
#include "ovimap/base/parallel.h"

namespace ovimap {

/// One object of the frame.
struct ViewSelector::Candidate {
  /// What the view shows of one of its super-points.
  struct Part {
    int points = 0;
    Eigen::AlignedBox3f box_in_world;
  };
  InstanceId id = 0;
  int visible_px = 0;  ///< with colour
  int depth_px = 0;    ///< of these, with measured depth
  Eigen::AlignedBox2i box_px;
  Appearance known;                ///< what its super-points looked like so far
  std::vector<float> x, y, z;      ///< sampled surface points in the world
  std::vector<Label> super_point;  ///< of each point
  std::map<Label, Part> parts;     ///< the super-points in sight
  Label most = kNoLabel;           ///< the one that covers most; the older of two equals
  ViewDirections directions;       ///< of this view
  BinSet covered;                  ///< directions that chosen views showed, from the same centre
  int largest_px = 0;              ///< of those views
};

namespace {

/// Coordinates of surface points in the world, and the super-point of each.
struct PointLists {
  std::vector<float>&x, &y, &z;
  std::vector<Label>& super_point;
};

/// The object's pixels with colour on every `step`-th column and row of its box, in the world.
void gather_points(const SeenObjects& seen, InstanceId id, int step,
                   const Eigen::AlignedBox2i& box_px, const PointLists& points) {
  const Eigen::Matrix3f rotation = seen.world_from_camera.linear().cast<float>();
  const Eigen::Vector3f position = seen.world_from_camera.translation().cast<float>();
  const Eigen::Vector3f per_column = rotation.col(0) / seen.camera.fx;
  const auto samples = static_cast<std::size_t>(box_px.sizes().x() / step + 1);
  std::size_t count = 0;
  for (int v = box_px.min().y(); v <= box_px.max().y(); v += step) {
    const InstanceId* ids = seen.instances.row(v);
    const float* depth = seen.depth.row(v);
    const Label* labels = seen.labels.row(v);
    const std::int32_t* color = seen.color_index.row(v);
    const Eigen::Vector3f at_column_0 =
        rotation * seen.camera.unproject(0.f, static_cast<float>(v), 1.f);
    // Every sample is written, but only the object's own move on: no branch to mispredict.
    for (std::vector<float>* list : {&points.x, &points.y, &points.z})
      if (list->size() < count + samples) list->resize(2 * (count + samples));
    points.super_point.resize(points.x.size());
    float *x = points.x.data(), *y = points.y.data(), *z = points.z.data();
    for (int u = box_px.min().x(); u <= box_px.max().x(); u += step) {
      const Eigen::Vector3f ray = at_column_0 + static_cast<float>(u) * per_column;
      x[count] = depth[u] * ray.x() + position.x();
      y[count] = depth[u] * ray.y() + position.y();
      z[count] = depth[u] * ray.z() + position.z();
      points.super_point[count] = labels[u];
      count += (ids[u] == id) & (color[u] >= 0);
    }
  }
  for (std::vector<float>* list : {&points.x, &points.y, &points.z}) list->resize(count);
  points.super_point.resize(count);
}

/// A well-mixed number from three (the finaliser of SplitMix64 over their combination).
std::uint64_t mixed(std::uint64_t seed, std::uint64_t id, std::uint64_t count) {
  std::uint64_t z = seed * 0x9e3779b97f4a7c15u + id * 0xd1b54a32d192ed03u + count;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

const ObjectView& smallest(const Appearance& object) {
  return **std::min_element(
      object.views.begin(), object.views.end(),
      [](const auto* a, const auto* b) { return a->visible_px < b->visible_px; });
}

bool among_largest(const Appearance& object, int visible_px, int top_views) {
  const auto as_large =
      std::count_if(object.views.begin(), object.views.end(),
                    [&](const ObjectView* view) { return view->visible_px >= visible_px; });
  return as_large < top_views;
}

}  // namespace

std::vector<ViewSelector::Candidate> ViewSelector::find_candidates(const SeenObjects& seen,
                                                                   const InstanceRegistry& registry,
                                                                   const SuperPointLooks& looks) {
  std::vector<Candidate> objects;
  for (int v = 0; v < seen.instances.height(); ++v) {
    const InstanceId* ids = seen.instances.row(v);
    const float* sensor = seen.sensor_depth.row(v);
    const std::int32_t* color = seen.color_index.row(v);
    for (int u = 0; u < seen.instances.width();) {
      // Neighbouring pixels mostly show one object: count them as a run.
      const InstanceId id = ids[u];
      const int begin = u;
      int colored = 0, measured = 0;
      for (; u < seen.instances.width() && ids[u] == id; ++u) {
        colored += color[u] >= 0;
        measured += (color[u] >= 0) & (sensor[u] > 0.f);
      }
      if (id == 0 || colored == 0) continue;
      if (id >= slot_of_id_.size()) slot_of_id_.resize(id + 1, -1);
      std::int32_t& slot = slot_of_id_[id];
      if (slot < 0) {
        slot = static_cast<std::int32_t>(objects.size());
        objects.emplace_back().id = id;
      }
      Candidate& object = objects[static_cast<std::size_t>(slot)];
      object.visible_px += colored;
      object.depth_px += measured;
      object.box_px.extend(Eigen::Vector2i(begin, v));
      object.box_px.extend(Eigen::Vector2i(u - 1, v));
    }
  }
  for (const Candidate& object : objects) slot_of_id_[object.id] = -1;
  std::erase_if(objects, [&](Candidate& object) {
    if (object.visible_px < config_.min_mask_px) return true;
    const std::vector<Label>& super_points = registry.super_points_of(object.id);
    object.known = appearance_of(looks, super_points);
    return object.depth_px <
               (object.known.offered > 0 ? config_.min_depth_px : config_.min_first_depth_px) ||
           super_points.empty() || !registry.seen_in(object.id, config_.min_frames_seen);
  });
  std::sort(objects.begin(), objects.end(),
            [](const Candidate& a, const Candidate& b) { return a.id < b.id; });
  return objects;
}

int ViewSelector::sample_step(int visible_px) const {
  return std::max(
      1, static_cast<int>(std::ceil(
             std::sqrt(static_cast<float>(visible_px) / static_cast<float>(config_.max_samples)))));
}

SphereGrid ViewSelectionConfig::grid(const PinholeCamera& depth_camera) const {
  if (grid_px_per_bin == 0) return {grid_rows, grid_columns};
  return {std::max(1, depth_camera.height / grid_px_per_bin),
          std::max(1, depth_camera.width / grid_px_per_bin)};
}

void ViewSelector::cover(const SeenObjects& seen, Candidate& object) const {
  gather_points(seen, object.id, sample_step(object.visible_px), object.box_px,
                {object.x, object.y, object.z, object.super_point});
  if (object.x.empty()) return;
  Eigen::AlignedBox3f box = object.known.seen_in_world;
  for (std::size_t i = 0; i < object.x.size(); ++i) {
    const Eigen::Vector3f point(object.x[i], object.y[i], object.z[i]);
    Candidate::Part& part = object.parts[object.super_point[i]];
    ++part.points;
    part.box_in_world.extend(point);
    box.extend(point);
  }
  for (const auto& [label, part] : object.parts)
    if (object.most == kNoLabel || part.points > object.parts.at(object.most).points)
      object.most = label;
  // Views whose centre is where the object's is now, or nearly so, say what has been covered. The
  // latest of them gives the origin, so that an object keeps it until its centre has moved.
  const float limit = config_.recentre_share > 0.f ? config_.recentre_share * box.diagonal().norm()
                                                   : std::numeric_limits<float>::infinity();
  Eigen::Vector3f& center = object.directions.center_in_world;
  const auto is_near = [&](const ObjectView* view) {
    return (view->directions.center_in_world - center).norm() <= limit;
  };
  center = box.center();
  const auto& views = object.known.views;
  if (const auto latest = std::find_if(views.rbegin(), views.rend(), is_near);
      latest != views.rend())
    center = (*latest)->directions.center_in_world;
  const SphereGrid grid = config_.grid(seen.camera);
  object.covered = BinSet(grid.bins());
  for (const ObjectView* view : views) {
    if (!is_near(view)) continue;
    object.largest_px = std::max(object.largest_px, view->visible_px);
    if (!view->directions.bins.empty()) object.covered |= view->directions.bins;
  }
  for (std::size_t i = 0; i < object.x.size(); ++i) {
    object.x[i] -= center.x();
    object.y[i] -= center.y();
    object.z[i] -= center.z();
  }
  object.directions.bins = BinSet(grid.bins());
  mark_directions(grid, {object.x, object.y, object.z}, object.directions.bins);
}

std::vector<ChosenView> ViewSelector::select(const SeenObjects& seen,
                                             const InstanceRegistry& registry,
                                             SuperPointLooks& looks) {
  OVIMAP_ASSERT(seen.depth.same_size(seen.instances) && seen.depth.same_size(seen.sensor_depth));
  OVIMAP_ASSERT(seen.depth.same_size(seen.labels) && seen.depth.same_size(seen.color_index));
  std::vector<Candidate> candidates = find_candidates(seen, registry, looks);
  parallel_for(candidates.size(), 1, [&](std::size_t i) { cover(seen, candidates[i]); });
  std::vector<ChosenView> chosen;
  for (Candidate& object : candidates) {
    if (object.x.empty()) continue;
    for (const auto& [label, part] : object.parts)
      looks[label].seen_in_world.extend(part.box_in_world);
    ++looks[object.most].offered;
    ++object.known.offered;
    std::optional<ViewKey> replaced;
    if (!decide(object, seen.frame, replaced)) continue;
    ObjectView view;
    view.frame = seen.frame;
    view.visible_px = object.visible_px;
    view.super_point = object.most;
    view.directions = std::move(object.directions);
    chosen.push_back({object.id, object.box_px, std::move(view), replaced});
  }
  return chosen;
}

void ViewSelector::commit(ChosenView chosen, const LabelForest& forest, SuperPointLooks& looks) {
  if (chosen.replaced)
    std::erase_if(looks[forest.root(chosen.replaced->super_point)].views,
                  [&](const ObjectView& view) { return view.key() == *chosen.replaced; });
  SuperPointLook& look = looks[chosen.view.super_point];
  ++look.queries;
  insert_view(look, std::move(chosen.view));
}

/// Whether the view shows enough surface that no chosen one has shown, or shows it far better.
bool ViewSelector::adds_something(const Candidate& candidate) const {
  const BinSet& bins = candidate.directions.bins;
  const float occupied = static_cast<float>(bins.count());
  const float found = static_cast<float>(bins.count_outside(candidate.covered));
  return found > config_.theta_novel * occupied ||
         (config_.better_ratio > 0.f &&
          static_cast<float>(candidate.visible_px) >
              config_.better_ratio * static_cast<float>(candidate.largest_px));
}

bool ViewSelector::decide(const Candidate& candidate, std::int64_t frame,
                          std::optional<ViewKey>& replaced) const {
  const Appearance& known = candidate.known;
  const bool is_large = among_largest(known, candidate.visible_px, config_.top_views);
  switch (config_.strategy) {
    case ViewStrategy::kAll:
      return true;
    case ViewStrategy::kCoverage:
      return adds_something(candidate);
    case ViewStrategy::kCombine:
      return is_large && adds_something(candidate);
    case ViewStrategy::kPixels:
      if (is_large && known.views.size() >= static_cast<std::size_t>(config_.top_views))
        replaced = smallest(known).key();
      return is_large;
    case ViewStrategy::kRandom: {
      // Reservoir sampling: after n views each is kept with the same chance.
      const auto wanted = static_cast<std::size_t>(config_.random_views);
      if (known.views.size() < wanted) return true;
      const std::uint64_t drawn = mixed(static_cast<std::uint64_t>(config_.random_seed),
                                        candidate.id, static_cast<std::uint64_t>(frame)) %
                                  static_cast<std::uint64_t>(known.offered);
      if (drawn < wanted) replaced = known.views[drawn]->key();
      return drawn < wanted;
    }
  }
  return false;
}

void list_fields(ViewSelectionConfig& config, ConfigFields& fields) {
  fields.add_choice<ViewStrategy>("strategy", config.strategy,
                                  {{"coverage", ViewStrategy::kCoverage},
                                   {"combine", ViewStrategy::kCombine},
                                   {"pixels", ViewStrategy::kPixels},
                                   {"random", ViewStrategy::kRandom},
                                   {"all", ViewStrategy::kAll}},
                                  "which views of an object are embedded");
  fields.add("grid_rows", config.grid_rows, 1, 2000, "bins of the polar angle");
  fields.add("grid_columns", config.grid_columns, 1, 4000, "bins of the azimuth");
  fields.add("grid_px_per_bin", config.grid_px_per_bin, 0, 10000,
             "rows and columns of the depth image that give a bin of either angle, in place of "
             "both (8: the paper's code); 0: those");
  fields.add("theta_novel", config.theta_novel, 0.f, 1.f,
             "share of a view's bins that must be new");
  fields.add("better_ratio", config.better_ratio, 0.f, 1e6f,
             "a view this many times larger than any before counts as new; 0: none does");
  fields.add("recentre_share", config.recentre_share, 0.f, 10.f,
             "coverage starts anew when the object's centre moved by this share of its diagonal; "
             "0: never");
  fields.add("min_mask_px", config.min_mask_px, 1, 100000000, "smaller views show too little");
  fields.add("min_first_depth_px", config.min_first_depth_px, 0, 100000000,
             "measured depth pixels an object's first view needs");
  fields.add("min_depth_px", config.min_depth_px, 0, 100000000,
             "measured depth pixels every later view needs");
  fields.add("min_frames_seen", config.min_frames_seen, 0, 1000000,
             "frames an object must have been seen in");
  fields.add("top_views", config.top_views, 1, 100000,
             "how many views count as the largest (combine, pixels)");
  fields.add("random_views", config.random_views, 1, 100000, "how many views are drawn (random)");
  fields.add("random_seed", config.random_seed, 0, 1 << 30, "what decides the drawing (random)");
  fields.add("max_samples", config.max_samples, 16, 100000000,
             "coverage looks at about so many of a view's pixels");
  fields.add_choice<FeatureFusion>("fusion", config.fusion.rule,
                                   {{"pixel_weighted", FeatureFusion::kPixelWeighted},
                                    {"mean", FeatureFusion::kMean},
                                    {"max_cosine", FeatureFusion::kMaxCosine},
                                    {"min_l1", FeatureFusion::kMinL1}},
                                   "how an object's views become one embedding");
  fields.add("fused_views", config.fusion.largest_views, 0, 100000,
             "how many of an object's views do, the largest (8: the paper's code); 0: all");
}

ViewSelectionConfig view_preset(const std::string& name) {
  ViewSelectionConfig config;
  if (name == "default") return config;
  // As published: nothing of our own besides the strategy.
  config.better_ratio = 0.f;
  config.recentre_share = 0.f;
  config.min_mask_px = 1000;
  config.min_first_depth_px = 500;
  config.min_depth_px = 100;
  config.min_frames_seen = 0;
  config.max_samples = 100000000;
  config.grid_px_per_bin = 8;
  if (name == "paper") {
    config.grid_px_per_bin = 0;
    config.grid_rows = 180, config.grid_columns = 240;
  } else if (name == "combine") {
    config.strategy = ViewStrategy::kCombine, config.theta_novel = 0.1f;
  } else if (name == "vis") {
    config.strategy = ViewStrategy::kPixels;
  } else if (name == "random") {
    config.strategy = ViewStrategy::kRandom;
  } else if (name == "all") {
    config.strategy = ViewStrategy::kAll;
  } else if (name != "viewcov") {
    throw Error(concat("there is no view preset '", name,
                       "'; accepted is default, paper, viewcov, combine, vis, random or all"));
  }
  return config;
}

}  // namespace ovimap
