// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/semantics/views/appearance.h"

#include <algorithm>

namespace ovimap {

namespace {

using ViewRefs = std::vector<const ObjectView*>;

// Measured on generated rooms (docs/default-encoder.md).
constexpr float kThingCorrelation = 0.5f;  // between log ratios of one object
constexpr float kUnknowable = 0.1f;        // share of views that do not show what a thing is

ViewRefs answered(std::span<const ObjectView* const> views) {
  ViewRefs result;
  for (const ObjectView* view : views)
    if (view->embedding.size() > 0) result.push_back(view);
  return result;
}

/// In their order.
void keep_largest(ViewRefs& views, int count) {
  const auto wanted = static_cast<std::size_t>(count);
  if (count == 0 || views.size() <= wanted) return;
  ViewRefs by_size = views;
  std::stable_sort(by_size.begin(), by_size.end(),
                   [](const auto* a, const auto* b) { return a->visible_px > b->visible_px; });
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

bool by_key(const ObjectView& a, const ObjectView& b) {
  return a.key() < b.key();
}

void unite(SuperPointLook& keep, SuperPointLook drop) {
  keep.seen_in_world.extend(drop.seen_in_world);
  keep.offered += drop.offered;
  keep.queries += drop.queries;
  const auto middle = static_cast<std::ptrdiff_t>(keep.views.size());
  std::move(drop.views.begin(), drop.views.end(), std::back_inserter(keep.views));
  std::inplace_merge(keep.views.begin(), keep.views.begin() + middle, keep.views.end(), by_key);
}

}  // namespace

Appearance appearance_of(const SuperPointLooks& looks, std::span<const Label> super_points) {
  Appearance object;
  for (const Label label : super_points) {
    const auto found = looks.find(label);
    if (found == looks.end()) continue;
    const SuperPointLook& look = found->second;
    object.seen_in_world.extend(look.seen_in_world);
    object.offered += look.offered;
    object.queries += look.queries;
    for (const ObjectView& view : look.views) object.views.push_back(&view);
  }
  std::sort(object.views.begin(), object.views.end(),
            [](const ObjectView* a, const ObjectView* b) { return by_key(*a, *b); });
  return object;
}

Eigen::VectorXf fuse_views(std::span<const ObjectView* const> views, const ViewFusion& fusion) {
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

float joint_log_ratio(float sum, std::size_t count) {
  return sum / (1.f + kThingCorrelation * (static_cast<float>(count) - 1.f));
}

Eigen::VectorXf things_of(std::span<const ObjectView* const> views) {
  Eigen::VectorXf sum;
  std::size_t count = 0;
  for (const ObjectView* view : views) {
    if (view->things.size() == 0) continue;
    // A view may show anything so that it is not known for what it is.
    const Eigen::VectorXf ratios =
        ((1.f - kUnknowable) * view->things.array().exp() + kUnknowable).log();
    if (count++ == 0)
      sum = ratios;
    else
      sum += ratios;
  }
  return sum.unaryExpr([count](float ratio) { return joint_log_ratio(ratio, count); });
}

void follow_merges(SuperPointLooks& looks, const LabelForest& forest) {
  for (auto look = looks.begin(); look != looks.end();) {
    const Label root = forest.root(look->first);
    if (root == look->first) {
      ++look;
      continue;
    }
    auto node = looks.extract(look++);
    unite(looks[root], std::move(node.mapped()));
  }
}

void insert_view(SuperPointLook& look, ObjectView view) {
  look.views.insert(std::upper_bound(look.views.begin(), look.views.end(), view, by_key),
                    std::move(view));
}

ObjectView* find_view(SuperPointLook& look, const ViewKey& key) {
  const auto found =
      std::lower_bound(look.views.begin(), look.views.end(), key,
                       [](const ObjectView& view, const ViewKey& k) { return view.key() < k; });
  return found == look.views.end() || found->key() != key ? nullptr : &*found;
}

void prune_crops(SuperPointLook& look, int kept_views) {
  std::vector<ObjectView*> with_crop;
  for (ObjectView& view : look.views)
    if (!view.crop.empty()) with_crop.push_back(&view);
  std::stable_sort(with_crop.begin(), with_crop.end(),
                   [](const auto* a, const auto* b) { return a->visible_px > b->visible_px; });
  for (std::size_t i = static_cast<std::size_t>(kept_views); i < with_crop.size(); ++i)
    with_crop[i]->crop = {};
}

Embeddings fused_embeddings(const SuperPointLooks& looks, std::span<const InstanceSummary> objects,
                            const ViewFusion& fusion, int dimension) {
  Embeddings rows = Embeddings::Zero(static_cast<Eigen::Index>(objects.size()), dimension);
  for (std::size_t i = 0; i < objects.size(); ++i) {
    const Appearance object = appearance_of(looks, objects[i].super_points);
    const Eigen::VectorXf fused = fuse_views(object.views, fusion);
    if (fused.size() > 0 && fused.size() == dimension)
      rows.row(static_cast<Eigen::Index>(i)) = fused;
  }
  return rows;
}

}  // namespace ovimap
