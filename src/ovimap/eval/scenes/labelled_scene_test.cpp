// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/eval/scenes/labelled_scene.h"

#include <gtest/gtest.h>

#include "ovimap/base/config.h"

namespace ovimap {
namespace {

using Points = std::vector<Eigen::Vector3f>;
using Labels = std::vector<std::uint32_t>;

TEST(TransferLabels, TakesTheNearestWithinTheRadius) {
  const Points truth = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}};
  const Points predicted = {{0.04f, 0, 0}, {-0.01f, 0, 0}, {1.06f, 0, 0}, {2, 0.03f, 0.03f}};
  const Labels labels = {5, 6, 7, 8};
  // The second prediction is nearer; 6 cm is too far; 4.2 cm is near enough; nothing there.
  EXPECT_EQ(transfer_labels(truth, predicted, labels), (Labels{6, 0, 8, 0}));
  EXPECT_EQ(transfer_labels(truth, predicted, labels, {0.07f}), (Labels{6, 7, 8, 0}));
}

TEST(TransferLabels, KeepsTheTruthsLengthWhenNothingWasPredicted) {
  EXPECT_EQ(transfer_labels(Points(3, {0, 0, 0}), Points{}, Labels{}), (Labels{0, 0, 0}));
  EXPECT_EQ(transfer_labels(Points{}, Points(1, {0, 0, 0}), Labels{1}), Labels{});
}

TEST(TransferLabels, ListsItsRadius) {
  TransferConfig config;
  ConfigFields fields;
  list_fields(config, fields);
  fields.set("radius_m", "0.1");
  EXPECT_EQ(config.radius_m, 0.1f);
}

}  // namespace
}  // namespace ovimap
