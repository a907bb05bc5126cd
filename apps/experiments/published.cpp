// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "published.h"

namespace ovimap::apps {

namespace {

constexpr double kNone = kNotPublished;
const std::string kReplica = "Replica", kScanNet = "ScanNet";

std::vector<PublishedRow> methods_on_replica() {
  return {{"Mask3D + OpenMask3D, offline",
           kReplica,
           {23.1, 14.3, 31.2, 56.2, 18.7, 29.4, 6.8, 4.5, 3.2}},
          {"Segment3D + OpenMask3D, offline",
           kReplica,
           {29.3, 6.5, 14.5, 24.9, 17.3, 30.9, 19.9, 15.2, 9.0}},
          {"Semantic Gaussians, offline",
           kReplica,
           {kNone, kNone, kNone, kNone, 16.1, 22.1, kNone, kNone, kNone}},
          {"OpenScene, offline",
           kReplica,
           {kNone, kNone, kNone, kNone, 19.8, 33.9, kNone, kNone, kNone}},
          {"OpenNeRF, offline",
           kReplica,
           {kNone, kNone, kNone, kNone, 19.2, 30.9, kNone, kNone, kNone}},
          {"OpenFusion", kReplica, {kNone, kNone, kNone, kNone, 14.9, 22.4, kNone, kNone, kNone}},
          {"OVO-SLAM", kReplica, {42.7, 11.1, 23.6, 32.8, 24.9, 34.0, 28.1, 17.5, 9.1}},
          {"OVI-MAP", kReplica, {36.3, 22.0, 50.8, 76.7, 26.5, 32.2, 34.5, 21.2, 8.5}},
          {"OVO-SLAM, 30 fps", kReplica, {kNone, kNone, kNone, kNone, 21.8, 27.5, 21.5, 15.2, 8.1}},
          {"OVI-MAP, 30 fps", kReplica, {kNone, kNone, kNone, kNone, 27.0, 32.5, 31.8, 17.7, 8.0}}};
}

std::vector<PublishedRow> methods_on_scannet() {
  return {{"Mask3D (trained on ScanNet) + OpenMask3D, offline",
           kScanNet,
           {47.6, 16.9, 36.1, 47.8, 8.6, 17.5, 10.4, 8.0, 5.1}},
          {"Segment3D + OpenMask3D, offline",
           kScanNet,
           {42.0, 2.5, 9.3, 16.5, 4.5, 13.5, 5.0, 3.9, 2.3}},
          {"Semantic Gaussians, offline",
           kScanNet,
           {kNone, kNone, kNone, kNone, 10.7, 17.8, kNone, kNone, kNone}},
          {"OpenScene, offline",
           kScanNet,
           {kNone, kNone, kNone, kNone, 10.3, 17.3, kNone, kNone, kNone}},
          {"OpenNeRF, offline (printed as failed)", kScanNet, std::vector<double>(9, kNone)},
          {"OpenFusion", kScanNet, {kNone, kNone, kNone, kNone, 8.3, 11.5, kNone, kNone, kNone}},
          {"OVO-SLAM", kScanNet, {39.8, 2.0, 7.4, 14.4, 14.6, 27.8, 19.4, 12.6, 5.5}},
          {"OVI-MAP", kScanNet, {41.2, 9.8, 24.0, 37.4, 17.5, 27.6, 23.4, 15.7, 7.2}},
          {"OVO-SLAM, 30 fps", kScanNet, {kNone, kNone, kNone, kNone, 15.5, 26.9, 19.4, 13.7, 5.8}},
          {"OVI-MAP, 30 fps", kScanNet, {kNone, kNone, kNone, kNone, 16.3, 25.4, 21.1, 14.4, 7.0}}};
}

}  // namespace

std::vector<PublishedRow> published_methods(const std::string& where) {
  return where == kScanNet ? methods_on_scannet() : methods_on_replica();
}

std::vector<PublishedRow> published_views() {
  return {{"random", kReplica, {23.8, 30.4, 31.4, 18.6, 50.3}},
          {"pixels", kReplica, {26.5, 31.8, 33.2, 19.8, 18.7}},
          {"coverage", kReplica, {26.5, 32.2, 34.5, 21.2, 8.6}},
          {"true objects, pixels", kReplica, {38.0, 50.3, 37.6, 37.6, 20.7}},
          {"true objects, coverage", kReplica, {37.6, 48.4, 36.2, 36.2, 10.4}},
          {"random", kScanNet, {14.7, 22.4, 19.2, 13.7, 23.0}},
          {"pixels", kScanNet, {17.5, 27.5, 24.7, 17.0, 15.8}},
          {"coverage", kScanNet, {17.5, 27.2, 23.4, 15.7, 7.6}},
          {"true objects, pixels", kScanNet, {34.8, 48.9, 39.8, 39.8, 23.0}},
          {"true objects, coverage", kScanNet, {30.7, 44.8, 34.7, 34.7, 12.3}}};
}

std::vector<PublishedRow> published_masks() {
  std::vector<PublishedRow> rows = {
      {"SAM 2", kReplica, {36.6, 14.2, 27.8, kNone, 20.2, 26.4, 26.2, 18.6}},
      {"CropFormer", kReplica, {36.3, 22.0, 50.8, 76.7, 26.9, 33.2, 36.4, 22.0}},
      {"true 2D masks", kReplica, {53.9, 38.8, 65.7, kNone, 26.6, 33.8, 36.1, 27.3}},
      {"true objects", kReplica, {100, 100, 100, kNone, 38.0, 50.3, 37.6, 37.6}}};
  for (PublishedRow& row : methods_on_replica())
    if (row.name.starts_with("Mask3D") || row.name.starts_with("Segment3D") ||
        row.name == "OVO-SLAM") {
      row.figures.pop_back();  // AP, which this table has no column for
      rows.push_back(std::move(row));
    }
  return rows;
}

std::vector<PublishedRow> published_fusion() {
  return {{"mean", kReplica, {26.5, 31.8, 33.2, 19.8, 8.3}},
          {"pixel_weighted", kReplica, {26.9, 33.2, 36.4, 22.0, 8.6}},
          {"max_cosine", kReplica, {25.1, 31.9, 33.1, 19.7, 8.4}},
          {"min_l1", kReplica, {24.8, 31.2, 32.8, 19.5, 8.3}}};
}

std::vector<PublishedRow> published_encoders() {
  return {{"clip-vit-large-patch14-336", kReplica, {15.4, 24.7, 20.6, 14.9, 6.7}},
          {"siglip-large-patch16-384", kReplica, {26.9, 33.2, 36.4, 22.0, 8.6}},
          {"siglip-so400m-patch14-384", kReplica, {25.2, 33.8, 32.4, 19.1, 9.7}},
          {"siglip2-large-patch16-384", kReplica, {26.7, 33.9, 35.9, 22.2, 10.4}},
          {"siglip2-so400m-patch14-384", kReplica, {26.4, 34.3, 36.4, 23.1, 9.4}}};
}

std::vector<PublishedRow> published_schedule() {
  return {{"offline", kReplica, {26.5, 32.2, 34.5, 21.2, 8.5, kNone, kNone}},
          {"30 fps", kReplica, {27.0, 32.5, 31.8, 17.7, 8.0, kNone, kNone}},
          {"offline", kScanNet, {17.5, 27.6, 23.4, 15.7, 7.2, kNone, kNone}},
          {"30 fps", kScanNet, {16.3, 25.4, 21.1, 14.4, 7.0, kNone, kNone}}};
}

}  // namespace ovimap::apps
