// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/revise/read_writing.h"

#include <algorithm>

#include "ovimap/base/config.h"
#include "ovimap/base/error.h"
#include "ovimap/image/blur.h"

namespace ovimap {

namespace {

struct ReadableView {
  ObjectView* view;
  ObjectCrop crop;
  double sharp_px;
};

/// Pixels of a crop that say something of its edges; none where there are no edges.
double sharp_px(const RgbImage& image) {
  const Blur blur = measure_blur(image);
  if (blur.across.edges + blur.down.edges == 0) return 0;
  return static_cast<double>(image.size()) / double{blur.across.px * blur.down.px};
}

/// The sharpest crops of a super-point.
std::vector<ReadableView> readable_views(SuperPointLook& look, int wanted) {
  std::vector<ReadableView> views;
  for (ObjectView& view : look.views) {
    view.writing.clear();
    if (view.crop.empty()) continue;
    ObjectCrop crop = restore_crop(view.crop);
    const double sharp = sharp_px(crop.image);
    views.push_back({&view, std::move(crop), sharp});
  }
  std::stable_sort(views.begin(), views.end(),
                   [](const auto& a, const auto& b) { return a.sharp_px > b.sharp_px; });
  if (wanted > 0 && views.size() > static_cast<std::size_t>(wanted))
    views.erase(views.begin() + wanted, views.end());
  return views;
}

/// Share of a box that is on the object.
float share_on(const Image<std::uint8_t>& mask, const Eigen::AlignedBox2i& box) {
  int on = 0, all = 0;
  for (int y = box.min().y(); y <= box.max().y(); ++y)
    for (int x = box.min().x(); x <= box.max().x(); ++x, ++all) on += mask.at(x, y) != 0;
  return all == 0 ? 0.f : static_cast<float>(on) / static_cast<float>(all);
}

}  // namespace

void list_fields(ReadWritingConfig& config, ConfigFields& fields) {
  fields.add("sharpest_views", config.sharpest_views, 0, 1000,
             "crops of each super-point that are read, the sharpest; 0: all");
  fields.add("own_share", config.own_share, 0.f, 1.f,
             "of a line that must lie on the object, not beside it");
}

ReadWritingSummary read_writing(SemanticRecord& record, const WritingReader& reader,
                                const ReadWritingConfig& config,
                                const ReadWritingProgress& progress) {
  SemanticRecord changed = record;
  ReadWritingSummary summary;
  std::size_t done = 0;
  for (auto& [label, look] : changed.looks) {
    for (ReadableView& readable : readable_views(look, config.sharpest_views)) {
      ++summary.crops;
      for (WrittenLine& line : reader.read(readable.crop.image))
        if (share_on(readable.crop.mask, line.box_px) >= config.own_share)
          readable.view->writing.push_back(std::move(line));
      summary.lines += readable.view->writing.size();
    }
    if (progress) progress(++done, changed.looks.size());
  }
  if (summary.crops == 0)
    throw Error(
        "the map keeps no crops to read; map the recording again with crops.kept_views above 0");
  changed.writing_reader = reader.name();
  record = std::move(changed);
  return summary;
}

}  // namespace ovimap
