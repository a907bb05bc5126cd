// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/hub/description/image_processor.h"

#include <gtest/gtest.h>

#include "ovimap/inference/models/test_support.h"

namespace ovimap {
namespace {

ImageInputSpec read(const std::string& text) {
  const fixture::TemporaryFolder scratch;
  scratch.write("preprocessor_config.json", text);
  return read_image_processor(scratch.path() / "preprocessor_config.json");
}

TEST(ImageProcessor, ReadsSiglips) {
  const ImageInputSpec spec = read(R"({"do_normalize": true, "do_rescale": true, "do_resize": true,
    "image_mean": [0.5, 0.5, 0.5], "image_std": [0.5, 0.5, 0.5], "resample": 3,
    "rescale_factor": 0.00392156862745098, "size": {"height": 224, "width": 224}})");
  EXPECT_EQ(spec.size_px, 224);
  EXPECT_EQ(spec.resize, ResizeRule::kStretch);
  EXPECT_EQ(spec.filter, ResizeFilter::kBicubic);
  EXPECT_FLOAT_EQ(spec.mean[0], 127.5f);
  EXPECT_FLOAT_EQ(spec.std[2], 127.5f);
}

TEST(ImageProcessor, ReadsClipsOldAndNewForm) {
  const std::string rest =
      R"("do_center_crop": true, "do_normalize": true, "do_resize": true, "resample": 3,
    "image_mean": [0.48145466, 0.4578275, 0.40821073], "image_std": [0.26862954, 0.26130258, 0.27577711]})";
  for (const std::string size :
       {R"("size": 224, "crop_size": 224, )",
        R"("size": {"shortest_edge": 224}, "crop_size": {"height": 224, "width": 224}, )"}) {
    const ImageInputSpec spec = read("{" + size + rest);
    EXPECT_EQ(spec.size_px, 224);
    EXPECT_EQ(spec.resize, ResizeRule::kShortSide);
    EXPECT_NEAR(spec.mean[0], 122.770938f, 1e-4);
    EXPECT_NEAR(spec.std[2], 70.323163f, 1e-4);
  }
}

TEST(ImageProcessor, ReadsSams) {
  const ImageInputSpec spec = read(R"({"do_pad": true, "pad_size": {"height": 1024, "width": 1024},
    "image_mean": [0.485, 0.456, 0.406], "image_std": [0.229, 0.224, 0.225], "resample": 2,
    "size": {"longest_edge": 1024}})");
  EXPECT_EQ(spec.resize, ResizeRule::kLongSide);
  EXPECT_EQ(spec.filter, ResizeFilter::kBilinear);
  EXPECT_NEAR(spec.mean[0], 123.675f, 1e-4);
}

TEST(ImageProcessor, WithoutNormalisationPixelsAreScaledAlone) {
  const ImageInputSpec spec = read(R"({"do_normalize": false, "resample": 2,
    "size": {"height": 8, "width": 8}})");
  EXPECT_FLOAT_EQ(spec.mean[1], 0.f);
  EXPECT_FLOAT_EQ(spec.std[1], 255.f);
}

TEST(ImageProcessor, RefusesWhatOvimapCannotDo) {
  const std::string values = R"("image_mean": [0.5, 0.5, 0.5], "image_std": [0.5, 0.5, 0.5])";
  const auto fault = [&](const std::string& keys) {
    return error_of([&] { read("{" + keys + ", " + values + "}"); });
  };
  EXPECT_TRUE(contains(fault(R"("size": {"height": 8, "width": 8}, "resample": 1)"), "filter 1"));
  EXPECT_TRUE(contains(fault(R"("size": {"height": 8, "width": 9}, "resample": 2)"), "no square"));
  EXPECT_TRUE(contains(fault(R"("size": {"shortest_edge": 8}, "resample": 2)"), "aspect ratio"));
  EXPECT_TRUE(contains(
      fault(
          R"("size": {"shortest_edge": 9}, "do_center_crop": true, "crop_size": 8, "resample": 2)"),
      "crops another size"));
  EXPECT_TRUE(contains(fault(R"("size": {"height": 8, "width": 8})"), "resample"));
}

}  // namespace
}  // namespace ovimap
