// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <memory>

#include "ovimap/inference/masks/mask_source.h"

namespace ovimap {

class FrameSource;

/// Entities from the frames' true instance images: the upper bound of the ablation. A frame without
/// such an image is not masked.
class GtMaskSource : public MaskSource {
 public:
  /// `frames` must outlive the source. Throws Error when it has no true instance images.
  explicit GtMaskSource(const FrameSource& frames);
  std::string kind() const override { return "gt"; }
  std::optional<Entities> entities(const Frame& frame,
                                   std::span<const MaskPrompt> prompts) override;

 private:
  const FrameSource& frames_;
};

/// Entities from a folder of grey PNGs with 8 or 16 bits, one a frame, 0 = no entity, written by
/// any tool. A frame's file has the frame's name (`frame-000012.color` or `frame-000012`), or ends
/// in its index with any number of leading zeros (`12.png`, `mask_0012.png`). A frame without a
/// file is not masked; one whose file is all 0 shows no entity. A `12.json` beside it says how sure
/// that tool is of each id, {"scores": [0.9, 0.75]}; without it each entity has score 1.
class DirMaskSource : public MaskSource {
 public:
  /// Throws Error when the folder holds no PNG, or when `frames` is given and no file matches any
  /// frame.
  explicit DirMaskSource(const std::filesystem::path& folder, const FrameSource* frames = nullptr);
  std::string kind() const override { return "dir"; }
  /// Throws Error when the frame's mask is not a grey PNG of the colour image's size, or its scores
  /// are none.
  std::optional<Entities> entities(const Frame& frame,
                                   std::span<const MaskPrompt> prompts) override;

 private:
  const std::filesystem::path* file_of(const std::string& name, std::int64_t index) const;
  void require_match(const FrameSource& frames) const;

  std::filesystem::path folder_;
  std::map<std::string, std::filesystem::path> by_stem_;
  std::map<std::int64_t, std::filesystem::path> by_index_;
};

/// Another source's entities, kept as PNGs and scores so that they are computed once: a folder that
/// a DirMaskSource reads. Whoever changes what the entities depend on takes another folder.
class KeptMaskSource : public MaskSource {
 public:
  /// Throws Error when the folder cannot be made.
  KeptMaskSource(std::filesystem::path folder, std::unique_ptr<MaskSource> source);
  std::string kind() const override { return source_->kind(); }
  bool is_slow() const override { return source_->is_slow(); }
  /// Frames that the source has no masks of are asked for again. Throws what the source throws, and
  /// Error when a mask cannot be written.
  std::optional<Entities> entities(const Frame& frame,
                                   std::span<const MaskPrompt> prompts) override;

 private:
  std::filesystem::path folder_;
  std::unique_ptr<MaskSource> source_;
};

}  // namespace ovimap
