// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <vector>

namespace ovimap {

struct FilmFrame {
  std::uint64_t time_us = 0;
  std::vector<std::uint16_t> depth;  ///< in units of unit_um
  std::vector<std::uint8_t> color;   ///< red first
};

/// What the software camera shows.
struct CameraFilm {
  std::int32_t width = 0, height = 0;
  std::int32_t fps = 30;
  std::int32_t unit_um = 1000;  ///< of depth: 1000 or 100
  float horizontal_fov_rad = 0, vertical_fov_rad = 0;
  std::vector<FilmFrame> frames;
};

namespace film {

template <class T>
void read(std::istream& in, T* values, std::size_t count) {
  in.read(reinterpret_cast<char*>(values), static_cast<std::streamsize>(count * sizeof(T)));
}
template <class T>
void write(std::ostream& out, const T* values, std::size_t count) {
  out.write(reinterpret_cast<const char*>(values), static_cast<std::streamsize>(count * sizeof(T)));
}

}  // namespace film

inline void write_film(const std::filesystem::path& file, const CameraFilm& shown) {
  std::ofstream out(file, std::ios::binary);
  const std::int32_t head[] = {shown.width, shown.height, shown.fps, shown.unit_um,
                               static_cast<std::int32_t>(shown.frames.size())};
  const float view[] = {shown.horizontal_fov_rad, shown.vertical_fov_rad};
  film::write(out, head, 5);
  film::write(out, view, 2);
  for (const FilmFrame& frame : shown.frames) {
    film::write(out, &frame.time_us, 1);
    film::write(out, frame.depth.data(), frame.depth.size());
    film::write(out, frame.color.data(), frame.color.size());
  }
}

inline CameraFilm read_film(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::int32_t head[5] = {};
  float view[2] = {};
  film::read(in, head, 5);
  film::read(in, view, 2);
  CameraFilm shown{head[0], head[1], head[2], head[3], view[0], view[1], {}};
  const auto pixels =
      static_cast<std::size_t>(shown.width) * static_cast<std::size_t>(shown.height);
  shown.frames.resize(static_cast<std::size_t>(head[4]));
  for (FilmFrame& frame : shown.frames) {
    frame.depth.resize(pixels);
    frame.color.resize(3 * pixels);
    film::read(in, &frame.time_us, 1);
    film::read(in, frame.depth.data(), pixels);
    film::read(in, frame.color.data(), 3 * pixels);
  }
  return shown;
}

}  // namespace ovimap
