// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

namespace ovimap {

/// A set of frames as runs of consecutive ones: what is seen at all is mostly seen for a while.
class FrameRuns {
 public:
  struct Run {
    std::uint32_t begin = 0, end = 0;  ///< `end` is the frame after the last
    bool operator==(const Run&) const = default;
  };

  FrameRuns() = default;
  /// Runs that are not empty, in order and apart.
  explicit FrameRuns(std::vector<Run> runs) : runs_(std::move(runs)) {}

  /// Adds a frame that is not before the last one.
  void add(std::uint32_t frame);
  FrameRuns& operator|=(const FrameRuns& other);
  int count() const;
  const std::vector<Run>& runs() const { return runs_; }
  bool operator==(const FrameRuns&) const = default;

 private:
  std::vector<Run> runs_;
};

}  // namespace ovimap
