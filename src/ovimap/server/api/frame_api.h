// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <mutex>
#include <optional>

#include "ovimap/frames/decoding/frame_decoder.h"
#include "ovimap/pipeline/live/frame_intake.h"
#include "ovimap/server/http/http_message.h"

namespace ovimap {

/// Takes a camera's frames from requests (docs/http-api.md, "Frames"). Thread-safe; one frame is
/// decoded at a time.
class FrameApi {
 public:
  /// `intake` may be null: then every request is refused and told how frames are taken.
  /// `moves_frames`: poses can be corrected, for the run keeps its frames.
  FrameApi(FrameIntake* intake, const FrameSourceConfig& config, bool moves_frames = false)
      : intake_(intake), config_(config), moves_frames_(moves_frames) {}

  bool takes_frames() const { return intake_ != nullptr; }

  /// What a frame is answered of which only the head is there, so that nobody sends images in vain:
  /// there is no room for it. Such a frame counts as skipped. Nothing where it is to be read.
  std::optional<HttpReply> early_refusal(const HttpRequest& head) const;

  // Handlers of POST. They throw BadRequest, and Error for what a frame or a camera has wrong.
  HttpReply camera(const HttpRequest& request);
  HttpReply frame(const HttpRequest& request);
  HttpReply poses(const HttpRequest& request);
  HttpReply finish();

 private:
  FrameIntake& intake() const;
  HttpReply counts(int status) const;
  HttpReply reply_to(FrameIntake::Answer answer) const;

  FrameIntake* intake_;
  const FrameSourceConfig config_;
  const bool moves_frames_;
  std::mutex mutex_;
  std::shared_ptr<const FrameDecoder> decoder_;  ///< null until a camera is given
};

}  // namespace ovimap
