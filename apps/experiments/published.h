// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <string>
#include <vector>

namespace ovimap::apps {

/// A row of a table in the literature, percent; NaN where there is none.
struct PublishedRow {
  std::string name, where;
  std::vector<double> figures;
};
inline constexpr double kNotPublished = std::numeric_limits<double>::quiet_NaN();

/// All methods of the paper's two comparisons (its tables of instances and of classes) on
/// "Replica" or "ScanNet": instances' mIoU, AP75, AP50, AP25, then classes' mIoU, mAcc, AP25,
/// AP50, AP.
std::vector<PublishedRow> published_methods(const std::string& where);

// The paper's ablations; columns as make_ablation has them.
std::vector<PublishedRow> published_views();     ///< classes' mIoU, mAcc, AP25, AP50, AQ
std::vector<PublishedRow> published_masks();     ///< instances' mIoU ... AP25, classes' ... AP50
std::vector<PublishedRow> published_fusion();    ///< classes' mIoU, mAcc, AP25, AP50, AP
std::vector<PublishedRow> published_encoders();  ///< classes' mIoU, mAcc, AP25, AP50, AP
std::vector<PublishedRow> published_schedule();  ///< the same, then instances' mIoU and AP50

}  // namespace ovimap::apps
