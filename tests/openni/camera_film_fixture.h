// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdlib>
#include <cstring>

#include "camera_film.h"
#include "ovimap/frames/recording/sequence_fixture.h"

namespace ovimap::fixture {

/// The room as a camera shows it that looks straight through the middle of its images.
inline CameraFilm film_of(const Sequence& sequence, int fps) {
  const PinholeCamera& camera = sequence.depth_camera;
  CameraFilm film{camera.width,
                  camera.height,
                  fps,
                  static_cast<std::int32_t>(1e6 / sequence.depth_units_per_m),
                  2 * std::atan(static_cast<float>(camera.width) / 2 / camera.fx),
                  2 * std::atan(static_cast<float>(camera.height) / 2 / camera.fy),
                  {}};
  for (int i = 0; i < sequence.frames; ++i) {
    const Image<std::uint16_t> depth = sequence.stored_depth(i);
    const RgbImage color = sequence.color(i);
    FilmFrame frame{static_cast<std::uint64_t>(1'000'000 + std::lround(i * 1e6 / 30)), {}, {}};
    frame.depth.assign(depth.begin(), depth.end());
    frame.color.resize(3 * color.size());
    std::memcpy(frame.color.data(), color.data(), frame.color.size());
    film.frames.push_back(std::move(frame));
  }
  return film;
}

/// Plugs the camera in that shows a film, for this process and those that it starts.
inline void plug_in(const fs::path& file, const CameraFilm& film) {
  write_film(file, film);
  ::setenv("OVIMAP_CAMERA_FILM", file.c_str(), 1);
}

}  // namespace ovimap::fixture
