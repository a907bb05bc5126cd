// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/hub/description/image_processor.h"

#include <nlohmann/json.hpp>

#include "ovimap/base/bounded_json.h"
#include "ovimap/base/error.h"
#include "ovimap/hub/description/refusal.h"

namespace ovimap {

namespace {

using Json = nlohmann::json;

constexpr float kBrightest = 255.f;
constexpr int kBilinear = 2, kBicubic = 3;  // as Pillow numbers its filters

bool flag(const Json& processor, const char* key, bool otherwise) {
  const auto found = processor.find(key);
  return found == processor.end() || found->is_null() ? otherwise : found->get<bool>();
}

/// A size as it is written: one number, or edges by name; 0 where that edge is not named.
int edge(const Json& size, const char* name) {
  if (size.is_number_integer()) return name == std::string("shortest_edge") ? size.get<int>() : 0;
  return size.is_object() && size.contains(name) && size[name].is_number_integer()
             ? size[name].get<int>()
             : 0;
}

int square_side(const Json& size) {
  if (size.is_number_integer()) return size.get<int>();
  const int height = edge(size, "height"), width = edge(size, "width");
  return height == width ? height : 0;
}

void read_resize(const Json& processor, const std::filesystem::path& file, ImageInputSpec& spec) {
  if (!flag(processor, "do_resize", true) || !processor.contains("size"))
    refuse_model(file, "it gives no size to resize to");
  const Json& size = processor["size"];
  const bool cropped = flag(processor, "do_center_crop", false);
  if (const int longest = edge(size, "longest_edge"); longest > 0 && !cropped) {
    spec.resize = ResizeRule::kLongSide;
    spec.size_px = longest;
  } else if (const int shortest = edge(size, "shortest_edge"); shortest > 0) {
    spec.resize = cropped ? ResizeRule::kShortSide : ResizeRule::kStretch;
    spec.size_px = shortest;
    if (!cropped && !size.is_number_integer())
      refuse_model(file, "it keeps the aspect ratio without a crop, which is no square");
  } else {
    spec.resize = ResizeRule::kStretch;
    spec.size_px = square_side(size);
  }
  if (spec.size_px < 1) refuse_model(file, concat("its size ", size.dump(), " is no square"));
  if (cropped && square_side(processor.value("crop_size", Json())) != spec.size_px)
    refuse_model(file, concat("it resizes to ", size.dump(), " and crops another size"));
}

void read_values(const Json& processor, const std::filesystem::path& file, ImageInputSpec& spec) {
  // In double, so that 0.5 of 255 is 127.5.
  const double scale =
      flag(processor, "do_rescale", true) ? processor.value("rescale_factor", 1. / kBrightest) : 1.;
  if (!(scale > 0)) refuse_model(file, "'rescale_factor' must be positive");
  const bool normalised = flag(processor, "do_normalize", true);
  for (std::size_t i = 0; i < 3; ++i) {
    const double mean = normalised ? processor.at("image_mean").at(i).get<double>() : 0;
    const double deviation = normalised ? processor.at("image_std").at(i).get<double>() : 1;
    spec.mean[i] = static_cast<float>(mean / scale);
    spec.std[i] = static_cast<float>(deviation / scale);
    if (!(spec.std[i] > 0)) refuse_model(file, "'image_std' must be positive");
  }
}

}  // namespace

ImageInputSpec read_image_processor(const std::filesystem::path& file) {
  try {
    const Json processor = read_json(file, kSmallDocument);
    ImageInputSpec spec;
    read_resize(processor, file, spec);
    const int filter = processor.at("resample").get<int>();
    if (filter != kBilinear && filter != kBicubic)
      refuse_model(file, concat("it resizes with filter ", filter,
                                ", while ovimap knows bilinear (2) and bicubic (3)"));
    spec.filter = filter == kBilinear ? ResizeFilter::kBilinear : ResizeFilter::kBicubic;
    read_values(processor, file, spec);
    return spec;
  } catch (const Json::exception& error) {
    refuse_model(file,
                 concat("it is not what an image processor's settings are (", error.what(), ")"));
  }
}

}  // namespace ovimap
