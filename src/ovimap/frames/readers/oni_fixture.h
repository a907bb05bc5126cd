// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// For tests only: writes .oni files record by record, without OpenNI.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <string>

#include "ovimap/frames/recording/sequence_fixture.h"

namespace ovimap::fixture {

/// Builds a file's bytes.
class OniWriter {
 public:
  static constexpr std::uint32_t kDepth = 1, kColor = 2;

  OniWriter() : bytes_("NI10\1\0\1\0\0\0\0\0", 12) {  // version 1.0.1.0
    bytes_ += raw(~std::uint64_t{0}) + raw(std::uint32_t{2});
  }

  void add_node(std::uint32_t node, std::uint32_t type, const char* codec) {
    std::string fields =
        text(node == kDepth ? "Depth" : "Image") + raw(type) + std::string(codec, 4);
    fields.append(28, '\0');  // counts, times, where the seek table is
    record(0x0D, node, fields);
  }
  template <class Value>
  void add_property(std::uint32_t node, const char* name, const Value& value) {
    record(0x06, node, text(name) + raw(std::uint32_t{sizeof(Value)}) + raw(value));
  }
  void add_number(std::uint32_t node, const char* name, std::uint64_t value) {
    record(0x03, node, text(name) + raw(std::uint32_t{8}) + raw(value));
  }
  void add_image(std::uint32_t node, std::uint64_t time_us, std::uint32_t number,
                 const std::string& image) {
    record(0x0A, node, raw(time_us) + raw(number), image);
  }
  void end() { record(0x0B, 0, {}); }

  Bytes bytes() const { return {bytes_.begin(), bytes_.end()}; }

 private:
  template <class Value>
  static std::string raw(const Value& value) {
    std::string bytes(sizeof(Value), '\0');
    std::memcpy(bytes.data(), &value, sizeof(Value));
    return bytes;
  }
  static std::string text(const std::string& value) {
    return raw(static_cast<std::uint32_t>(value.size() + 1)) + value + '\0';
  }
  void record(std::uint32_t type, std::uint32_t node, const std::string& fields,
              const std::string& payload = {}) {
    bytes_ += std::string("NIR\0", 4) + raw(type) + raw(node);
    bytes_ += raw(static_cast<std::uint32_t>(28 + fields.size()));
    bytes_ += raw(static_cast<std::uint32_t>(payload.size())) + raw(std::uint64_t{0});
    bytes_ += fields + payload;
  }

  std::string bytes_;
};

/// What a recording of the room is stored as.
struct OniStyle {
  bool mirrored = true;  ///< as OpenNI's own viewer does
  bool jpeg = false;
  std::uint64_t color_late_us = 0;
};

template <class Pixel>
std::string stored_rows(Image<Pixel> image, bool mirrored) {
  for (int v = 0; mirrored && v < image.height(); ++v)
    std::reverse(image.row(v), image.row(v) + image.width());
  return {reinterpret_cast<const char*>(image.data()), image.size() * sizeof(Pixel)};
}

inline OniWriter begin_oni(const Sequence& sequence, const OniStyle& style) {
  struct Size {
    std::uint32_t width, height, fps;
  };
  OniWriter writer;
  for (const std::uint32_t node : {OniWriter::kDepth, OniWriter::kColor}) {
    const bool depth = node == OniWriter::kDepth;
    const PinholeCamera& camera = depth ? sequence.depth_camera : sequence.color_camera;
    writer.add_node(node, depth ? 2 : 3, !depth && style.jpeg ? "JPEG" : "NONE");
    writer.add_property(node, "xnMapOutputMode",
                        Size{std::uint32_t(camera.width), std::uint32_t(camera.height), 30});
    writer.add_property(node, "xnFOV",
                        std::array{2 * std::atan(camera.width / 2. / camera.fx),
                                   2 * std::atan(camera.height / 2. / camera.fy)});
    writer.add_number(node, "oniPixelFormat", depth ? 100 : 200);
    writer.add_number(node, "xnMirror", style.mirrored);
  }
  return writer;
}

/// The room in a file; its camera looks straight through the middle of its images.
inline OniWriter oni_of(const Sequence& sequence, const OniStyle& style = {}) {
  OniWriter writer = begin_oni(sequence, style);
  for (int i = 0; i < sequence.frames; ++i) {
    const auto time_us = static_cast<std::uint64_t>(i) * 33333;
    const auto number = static_cast<std::uint32_t>(i + 1);
    RgbImage color = sequence.color(i);
    std::string stored = stored_rows(color, style.mirrored);
    if (style.jpeg) {
      std::memcpy(static_cast<void*>(color.data()), stored.data(), stored.size());
      const Bytes jpeg = encode_jpeg(color, 95);
      stored.assign(jpeg.begin(), jpeg.end());
    }
    writer.add_image(OniWriter::kColor, time_us + style.color_late_us, number, stored);
    writer.add_image(OniWriter::kDepth, time_us, number,
                     stored_rows(sequence.stored_depth(i), style.mirrored));
  }
  writer.end();
  return writer;
}

}  // namespace ovimap::fixture
