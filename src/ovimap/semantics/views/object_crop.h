// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "ovimap/frames/frame/frame.h"
#include "ovimap/image/codec.h"
#include "ovimap/image/image.h"
#include "ovimap/instance/instance_registry.h"

namespace ovimap {

class ConfigFields;

/// How an object is cut out of a colour image (paper section 3.2; method section 10).
struct CropConfig {
  int scales = 3;              ///< crops of one view, each wider than the one before
  float padding_step = 0.1f;   ///< share of the object's box added on each side, per scale
  bool masked = true;          ///< every crop a second time, with the background removed
  int background_level = 128;  ///< grey that stands for a removed background
  int kept_views = 4;          ///< views of an object whose crops stay in the map; 0: none
  int kept_size_px = 224;      ///< long side of a crop in the map; larger ones are shrunk
  int kept_quality = 90;       ///< of the JPEG in the map
};
void list_fields(CropConfig& config, ConfigFields& fields);

/// An object in the frame's colour image with the surroundings that the widest scale shows. Owns
/// its pixels, so that nothing refers back to the frame.
struct ObjectCrop {
  RgbImage image;
  Image<std::uint8_t> mask;           ///< of `image`'s size: 1 on the object
  Eigen::AlignedBox2i object_px;      ///< the object's box in `image`, both corners included
  Eigen::AlignedBox2f in_frame = {};  ///< the same as shares of the frame's sides; empty: not known
};

/// Where one object appears in the map as seen from a frame's depth camera.
struct ObjectPixels {
  const Image<std::int32_t>& color_index;  ///< of the map's depth (Registration::color_index)
  const Image<InstanceId>& instances;      ///< same size
  InstanceId id = 0;
  Eigen::AlignedBox2i box_px;  ///< its pixels lie in it, both corners included
};

/// Cuts an object out of the frame's own colour image, which its pixels are registered to. Empty
/// when the colour image shows none of them.
std::optional<ObjectCrop> cut_object(const Frame& frame, const ObjectPixels& object,
                                     const CropConfig& config);

/// The images an encoder sees of one view: per scale the plain crop, then (CropConfig::masked) the
/// one without background.
std::vector<RgbImage> crop_variants(const ObjectCrop& crop, const CropConfig& config);

/// A crop as the map keeps it.
struct StoredCrop {
  Bytes image_jpeg;
  Bytes mask_png;  ///< grey, 1 on the object
  Eigen::AlignedBox2i object_px;

  bool empty() const { return image_jpeg.empty(); }
};
StoredCrop store_crop(const ObjectCrop& crop, const CropConfig& config);
/// Throws Error when the bytes are no images or do not fit each other.
ObjectCrop restore_crop(const StoredCrop& stored);

}  // namespace ovimap
