// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/semantics/views/object_crop.h"

#include <algorithm>
#include <cmath>

#include "ovimap/base/config.h"
#include "ovimap/image/codec.h"
#include "ovimap/image/resize.h"

namespace ovimap {

namespace {

/// Calls `visit(pixel)` with the place in the colour image of every pixel of the object.
template <class Visit>
void for_each_color_pixel(const Frame& frame, const ObjectPixels& object, const Visit& visit) {
  const int color_width = frame.color.width();
  for (int y = object.box_px.min().y(); y <= object.box_px.max().y(); ++y) {
    const InstanceId* ids = object.instances.row(y);
    const std::int32_t* index = object.color_index.row(y);
    for (int x = object.box_px.min().x(); x <= object.box_px.max().x(); ++x)
      if (ids[x] == object.id && index[x] >= 0)
        visit(Eigen::Vector2i(index[x] % color_width, index[x] / color_width));
  }
}

Eigen::AlignedBox2i image_box(int width, int height) {
  return {Eigen::Vector2i(0, 0), Eigen::Vector2i(width - 1, height - 1)};
}

/// The box grown by `share` of its sides on each side, inside the image.
Eigen::AlignedBox2i padded(const Eigen::AlignedBox2i& box, float share,
                           const Eigen::AlignedBox2i& image) {
  const Eigen::Vector2f size = (box.sizes().array() + 1).cast<float>();
  const Eigen::Vector2i pad = (size * share).array().round().cast<int>();
  return Eigen::AlignedBox2i(box.min() - pad, box.max() + pad).intersection(image);
}

template <class Pixel>
Image<Pixel> cut(const Image<Pixel>& image, const Eigen::AlignedBox2i& box) {
  Image<Pixel> result(box.sizes().x() + 1, box.sizes().y() + 1);
  for (int y = 0; y < result.height(); ++y)
    std::copy_n(image.row(box.min().y() + y) + box.min().x(), result.width(), result.row(y));
  return result;
}

/// Half the side of the block that one depth pixel paints in the colour image, so that a finer
/// colour image gets a mask without gaps.
int splat_radius_px(const Frame& frame) {
  if (frame.registered()) return 0;
  const float scale = std::max(frame.color_camera.fx / frame.depth_camera.fx,
                               frame.color_camera.fy / frame.depth_camera.fy);
  return static_cast<int>(std::ceil(0.5f * scale));
}

/// The object's pixels in `window`, a part of the colour image.
Image<std::uint8_t> paint_mask(const Frame& frame, const ObjectPixels& object,
                               const Eigen::AlignedBox2i& window) {
  Image<std::uint8_t> mask(window.sizes().x() + 1, window.sizes().y() + 1);
  const Eigen::AlignedBox2i inside = image_box(mask.width(), mask.height());
  const Eigen::Vector2i radius = Eigen::Vector2i::Constant(splat_radius_px(frame));
  for_each_color_pixel(frame, object, [&](const Eigen::Vector2i& pixel) {
    const Eigen::Vector2i at = pixel - window.min();
    const auto block = Eigen::AlignedBox2i(at - radius, at + radius).intersection(inside);
    for (int y = block.min().y(); y <= block.max().y(); ++y)
      for (int x = block.min().x(); x <= block.max().x(); ++x) mask.at(x, y) = 1;
  });
  return mask;
}

float widest_padding(const CropConfig& config) {
  return config.padding_step * static_cast<float>(config.scales - 1);
}

}  // namespace

void list_fields(CropConfig& config, ConfigFields& fields) {
  fields.add("scales", config.scales, 1, 8, "crops of one view, each wider than the one before");
  fields.add("padding_step", config.padding_step, 0.f, 2.f,
             "share of the object's box added on each side, per scale");
  fields.add("masked", config.masked, "every crop a second time, with the background removed");
  fields.add("background_level", config.background_level, 0, 255,
             "grey that stands for a removed background");
  fields.add("kept_views", config.kept_views, 0, 1000,
             "views of an object whose crops stay in the map");
  fields.add("kept_size_px", config.kept_size_px, 16, 4096, "long side of a crop in the map");
  fields.add("kept_quality", config.kept_quality, 1, 100, "JPEG quality of a crop in the map");
}

std::optional<ObjectCrop> cut_object(const Frame& frame, const ObjectPixels& object,
                                     const CropConfig& config) {
  Eigen::AlignedBox2i in_color;
  for_each_color_pixel(frame, object, [&](const Eigen::Vector2i& p) { in_color.extend(p); });
  if (in_color.isEmpty()) return std::nullopt;
  const Eigen::AlignedBox2i window = padded(in_color, widest_padding(config),
                                            image_box(frame.color.width(), frame.color.height()));
  const Eigen::Array2f size(static_cast<float>(frame.color.width()),
                            static_cast<float>(frame.color.height()));
  return ObjectCrop{cut(frame.color, window),
                    paint_mask(frame, object, window),
                    {in_color.min() - window.min(), in_color.max() - window.min()},
                    {in_color.min().cast<float>().array() / size,
                     (in_color.max().cast<float>().array() + 1.f) / size}};
}

std::vector<RgbImage> crop_variants(const ObjectCrop& crop, const CropConfig& config) {
  const auto level = static_cast<std::uint8_t>(config.background_level);
  RgbImage without_background = crop.image;
  if (config.masked)
    for (std::size_t i = 0; i < crop.mask.size(); ++i)
      if (crop.mask[i] == 0) without_background[i] = {level, level, level};
  const Eigen::AlignedBox2i whole = image_box(crop.image.width(), crop.image.height());
  std::vector<RgbImage> variants;
  for (int scale = 0; scale < config.scales; ++scale) {
    const Eigen::AlignedBox2i window =
        padded(crop.object_px, config.padding_step * static_cast<float>(scale), whole);
    variants.push_back(cut(crop.image, window));
    if (config.masked) variants.push_back(cut(without_background, window));
  }
  return variants;
}

StoredCrop store_crop(const ObjectCrop& crop, const CropConfig& config) {
  const int width = crop.image.width(), height = crop.image.height();
  const float scale = std::min(
      1.f, static_cast<float>(config.kept_size_px) / static_cast<float>(std::max(width, height)));
  const auto scaled = [&](int length) {
    return std::max(1, static_cast<int>(std::lround(static_cast<float>(length) * scale)));
  };
  IdImage mask(width, height);
  std::copy(crop.mask.begin(), crop.mask.end(), mask.begin());
  const Eigen::AlignedBox2i small = image_box(scaled(width), scaled(height));
  const auto corner = [&](const Eigen::Vector2i& at) -> Eigen::Vector2i {
    return (at.cast<float>() * scale).array().floor().cast<int>().min(small.max().array());
  };
  return {
      encode_jpeg(resize_bilinear(crop.image, scaled(width), scaled(height)), config.kept_quality),
      encode_png(resize_nearest(mask, scaled(width), scaled(height))),
      {corner(crop.object_px.min()), corner(crop.object_px.max())}};
}

ObjectCrop restore_crop(const StoredCrop& stored) {
  constexpr std::int64_t kMostPixels = 1 << 24;  // of a map from anywhere
  const ImageSize size = image_size(stored.image_jpeg);
  if (std::int64_t{size.width} * size.height > kMostPixels)
    throw Error(concat("a stored crop of ", size.width, "x", size.height, " is too large"));
  ObjectCrop crop{decode_rgb(stored.image_jpeg, size), {}, stored.object_px};
  const GrayPng mask = decode_gray(stored.mask_png, size);
  const Eigen::AlignedBox2i whole = image_box(crop.image.width(), crop.image.height());
  if (stored.object_px.isEmpty() || !whole.contains(stored.object_px))
    throw Error("the box of a stored crop does not fit its image");
  crop.mask = Image<std::uint8_t>(crop.image.width(), crop.image.height());
  std::transform(mask.values.begin(), mask.values.end(), crop.mask.begin(),
                 [](std::uint16_t value) { return static_cast<std::uint8_t>(value != 0); });
  return crop;
}

}  // namespace ovimap
