// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
//
// How good a promptable network's masks could be: every true object is asked for by its deepest
// pixel and by its box, and the best of the network's levels is held against the truth, as is the
// level that the network itself rates highest.
//   ovimap_mask_bounds SCENE [EVERY [MODEL]]
#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>
#include <vector>

#include "ovimap/frames/frame/frame_source.h"
#include "ovimap/inference/mask_source_factory.h"
#include "ovimap/inference/masks/id_mask_sources.h"
#include "ovimap/inference/masks/logit_grid.h"
#include "ovimap/inference/sam/sam_network.h"
#include "ovimap/segment/depth_segmentation.h"

namespace {

using namespace ovimap;

constexpr int kLeastPx = 100;  ///< smaller objects are not asked for
constexpr std::array<int, 4> kSizesPx = {500, 3000, 20000, 100000000};

struct Sum {
  double iou = 0;
  int good = 0;
  void add(double value) { iou += value, good += value >= 0.5; }
};

struct Bounds {
  int objects = 0;
  Sum point, box, rated;
};

DepthRegions regions_of(const Entities& truth) {
  DepthRegions regions{truth.ids, std::vector<DepthRegion>(truth.scores.size())};
  for (int y = 0; y < truth.ids.height(); ++y)
    for (int x = 0; x < truth.ids.width(); ++x)
      if (const int id = truth.ids.at(x, y); id > 0) {
        DepthRegion& region = regions.regions[static_cast<std::size_t>(id - 1)];
        ++region.area_px;
        region.extent_px.extend(Eigen::Vector2i(x, y));
      }
  return regions;
}

/// IoU of every level with the object.
std::vector<double> ious(const MaskProposals& answer, const LogitGrid& grid, const IdImage& ids,
                         int id) {
  const std::size_t level = answer.logits.size() / static_cast<std::size_t>(answer.tokens);
  std::vector<double> result;
  for (int token = 0; token < answer.tokens; ++token) {
    int both = 0, either = 0;
    for (int y = 0; y < ids.height(); ++y) {
      const auto first = static_cast<std::size_t>(token) * level;
      const LogitRow row(std::span(answer.logits).subspan(first, level), grid, y);
      for (int x = 0; x < ids.width(); ++x) {
        const bool found = row.at(x) > 0, mine = ids.at(x, y) == id;
        both += found && mine;
        either += found || mine;
      }
    }
    result.push_back(static_cast<double>(both) / either);
  }
  return result;
}

void ask(const SamNetwork& network, const Frame& frame, const Entities& truth,
         std::array<Bounds, 4>& bounds) {
  const DepthRegions regions = regions_of(truth);
  const std::vector<Eigen::Vector2i> deepest = deepest_pixels(regions);
  const ImageFeatures features = network.encode(frame.color);
  const LogitGrid grid = logit_grid(features.frame, network.input_size_px(), network.grid_size(),
                                    frame.color.width(), frame.color.height());
  const auto best = [](const std::vector<double>& values) {
    return std::max_element(values.begin(), values.end());
  };
  for (std::size_t i = 0; i < regions.regions.size(); ++i) {
    const DepthRegion& region = regions.regions[i];
    if (region.area_px < kLeastPx) continue;
    const PromptPoint inside{deepest[i].cast<float>(), PointLabel::kForeground};
    const PromptPoints by_point = {inside, {{0, 0}, PointLabel::kPadding}};
    const PromptPoints by_box = {inside,
                                 {region.extent_px.min().cast<float>(), PointLabel::kBoxMin},
                                 {region.extent_px.max().cast<float>(), PointLabel::kBoxMax}};
    const int id = static_cast<int>(i) + 1;
    const std::vector<double> point =
        ious(network.decode(features, {&by_point, 1}).front(), grid, truth.ids, id);
    const MaskProposals boxed = network.decode(features, {&by_box, 1}).front();
    const std::vector<double> box = ious(boxed, grid, truth.ids, id);
    const std::vector<double> ratings(boxed.predicted_iou.begin(), boxed.predicted_iou.end());
    const auto rated = static_cast<std::size_t>(best(ratings) - ratings.begin());
    const auto size =
        std::upper_bound(kSizesPx.begin(), kSizesPx.end(), region.area_px) - kSizesPx.begin();
    Bounds& of = bounds[static_cast<std::size_t>(size)];
    ++of.objects;
    of.point.add(*best(point));
    of.box.add(*best(box));
    of.rated.add(box[rated]);
  }
}

void print(const std::array<Bounds, 4>& bounds) {
  std::printf(
      "pixels below  objects  mean IoU (share at 0.5): best by point, best by box, as rated\n");
  for (std::size_t i = 0; i < bounds.size(); ++i) {
    const Bounds& of = bounds[i];
    if (of.objects == 0) continue;
    std::printf("%12d  %7d", kSizesPx[i], of.objects);
    for (const Sum* sum : {&of.point, &of.box, &of.rated})
      std::printf("  %.2f (%.2f)", sum->iou / of.objects,
                  static_cast<double>(sum->good) / of.objects);
    std::printf("\n");
  }
}

}  // namespace

int main(int count, char** arguments) {
  if (count < 2) {
    std::fprintf(stderr, "ovimap_mask_bounds SCENE [EVERY [MODEL]]\n");
    return 2;
  }
  try {
    const auto source = open_frame_source(arguments[1]);
    const int every = count > 2 ? std::max(std::atoi(arguments[2]), 1) : 1;
    const std::string model = count > 3 ? arguments[3] : kDefaultSamModel;
    const SamNetwork network(read_model_folder(find_model(model, model_search_path())), {});
    GtMaskSource truth(*source);
    std::array<Bounds, 4> bounds;
    for (std::int64_t i = 0; i < source->size(); i += every)
      if (const FrameRead read = source->read(i); read.frame)
        if (const auto objects = truth.entities(*read.frame, {}))
          ask(network, *read.frame, *objects, bounds);
    print(bounds);
  } catch (const std::exception& fault) {
    std::fprintf(stderr, "%s\n", fault.what());
    return 1;
  }
}
