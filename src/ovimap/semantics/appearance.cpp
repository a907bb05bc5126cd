// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/semantics/appearance.h"

#include <algorithm>

namespace ovimap {

namespace {

using ViewRefs = std::vector<const ObjectView*>;

ViewRefs answered(std::span<const ObjectView> views) {
  ViewRefs result;
  for (const ObjectView& view : views)
    if (view.embedding.size() > 0) result.push_back(&view);
  return result;
}

/// In their order.
void keep_largest(ViewRefs& views, int count) {
  const auto wanted = static_cast<std::size_t>(count);
  if (count == 0 || views.size() <= wanted) return;
  ViewRefs by_size = views;
  std::stable_sort(by_size.begin(), by_size.end(), [](const auto* a, const auto* b) {
    return a->visible_px > b->visible_px;
  });
  by_size.resize(wanted);
  std::erase_if(views, [&](const ObjectView* view) {
    return std::find(by_size.begin(), by_size.end(), view) == by_size.end();
  });
}

Eigen::VectorXf weighted_mean(const ViewRefs& views, bool by_pixels) {
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(views.front()->embedding.size());
  for (const ObjectView* view : views)
    sum +=
        (by_pixels ? static_cast<double>(view->visible_px) : 1.) * view->embedding.cast<double>();
  const double length = sum.norm();
  if (!(length > 0)) return {};
  return (sum / length).cast<float>();
}

/// The view with the smallest sum of `distance` to the others; the earliest of equals.
template <class Distance>
Eigen::VectorXf medoid(const ViewRefs& views, const Distance& distance) {
  const ObjectView* best = nullptr;
  double least = 0;
  for (const ObjectView* view : views) {
    double sum = 0;
    for (const ObjectView* other : views) sum += distance(view->embedding, other->embedding);
    if (best == nullptr || sum < least) best = view, least = sum;
  }
  return best->embedding.normalized();
}

void unite(ViewCoverage& keep, const ViewCoverage& drop) {
  keep.seen_in_world.extend(drop.seen_in_world);
  keep.largest_px = std::max(keep.largest_px, drop.largest_px);
  if (keep.bins.empty()) {
    keep.center_in_world = drop.center_in_world;
    keep.bins = drop.bins;
  } else if (!drop.bins.empty()) {
    keep.bins |= drop.bins;
  }
}

}  // namespace

Eigen::VectorXf fuse_views(std::span<const ObjectView> views, const ViewFusion& fusion) {
  ViewRefs known = answered(views);
  if (known.empty()) return {};
  keep_largest(known, fusion.largest_views);
  switch (fusion.rule) {
    case FeatureFusion::kPixelWeighted:
      return weighted_mean(known, true);
    case FeatureFusion::kMean:
      return weighted_mean(known, false);
    case FeatureFusion::kMaxCosine:
      return medoid(known, [](const auto& a, const auto& b) { return -double{a.dot(b)}; });
    case FeatureFusion::kMinL1:
      return medoid(known,
                    [](const auto& a, const auto& b) { return double{(a - b).cwiseAbs().sum()}; });
  }
  return {};
}

void merge_appearance(Appearances& appearances, InstanceId keep, InstanceId drop) {
  if (keep == drop) return;
  auto node = appearances.extract(drop);
  if (node.empty()) return;
  Appearance& dropped = node.mapped();
  Appearance& kept = appearances[keep];
  unite(kept.coverage, dropped.coverage);
  kept.offered += dropped.offered;
  kept.queries += dropped.queries;
  const auto middle = static_cast<std::ptrdiff_t>(kept.views.size());
  std::move(dropped.views.begin(), dropped.views.end(), std::back_inserter(kept.views));
  std::inplace_merge(kept.views.begin(), kept.views.begin() + middle, kept.views.end(),
                     [](const ObjectView& a, const ObjectView& b) { return a.frame < b.frame; });
}

void follow_merges(Appearances& appearances, const InstanceRegistry& registry) {
  std::vector<std::pair<InstanceId, InstanceId>> moves;
  for (const auto& [id, appearance] : appearances)
    if (const InstanceId now = registry.resolve(id); now != id) moves.emplace_back(now, id);
  for (const auto& [keep, drop] : moves) merge_appearance(appearances, keep, drop);
}

void prune_crops(Appearance& appearance, int kept_views) {
  std::vector<ObjectView*> with_crop;
  for (ObjectView& view : appearance.views)
    if (!view.crop.empty()) with_crop.push_back(&view);
  std::stable_sort(with_crop.begin(), with_crop.end(),
                   [](const auto* a, const auto* b) { return a->visible_px > b->visible_px; });
  for (std::size_t i = static_cast<std::size_t>(kept_views); i < with_crop.size(); ++i)
    with_crop[i]->crop = {};
}

Embeddings fused_embeddings(const Appearances& appearances, std::span<const InstanceId> ids,
                            const ViewFusion& fusion, int dimension) {
  Embeddings rows = Embeddings::Zero(static_cast<Eigen::Index>(ids.size()), dimension);
  for (std::size_t i = 0; i < ids.size(); ++i) {
    const auto found = appearances.find(ids[i]);
    if (found == appearances.end()) continue;
    const Eigen::VectorXf fused = fuse_views(found->second.views, fusion);
    if (fused.size() == dimension) rows.row(static_cast<Eigen::Index>(i)) = fused;
  }
  return rows;
}

}  // namespace ovimap
