// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// For tests only: a furniture library written by hand, so that they need no package.

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>

#include "ovimap/image/codec.h"

namespace ovimap::fixture {

inline std::uint32_t crc32_of(const std::string& bytes) {
  std::uint32_t crc = ~0u;
  for (const char byte : bytes) {
    crc ^= static_cast<unsigned char>(byte);
    for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ ((crc & 1) ? 0xedb88320u : 0u);
  }
  return ~crc;
}

inline void append(std::string& bytes, std::uint32_t value, int count) {
  for (int i = 0; i < count; ++i) bytes += static_cast<char>(value >> (8 * i));
}

/// A zip file whose entries are stored uncompressed.
inline void write_zip(const std::filesystem::path& path,
                      const std::map<std::string, std::string>& entries) {
  std::string file, directory;
  for (const auto& [name, content] : entries) {
    const auto offset = static_cast<std::uint32_t>(file.size());
    std::string shared;  // the fields that local and central headers have in common
    append(shared, 20, 2), append(shared, 0, 2), append(shared, 0, 2), append(shared, 0, 4);
    append(shared, crc32_of(content), 4);
    append(shared, static_cast<std::uint32_t>(content.size()), 4);
    append(shared, static_cast<std::uint32_t>(content.size()), 4);
    append(shared, static_cast<std::uint32_t>(name.size()), 2), append(shared, 0, 2);
    append(file, 0x04034b50, 4);
    file += shared + name + content;
    append(directory, 0x02014b50, 4), append(directory, 20, 2);
    directory += shared;
    append(directory, 0, 2), append(directory, 0, 2), append(directory, 0, 2),
        append(directory, 0, 4);
    append(directory, offset, 4);
    directory += name;
  }
  const auto start = static_cast<std::uint32_t>(file.size());
  file += directory;
  append(file, 0x06054b50, 4), append(file, 0, 4);
  append(file, static_cast<std::uint32_t>(entries.size()), 2);
  append(file, static_cast<std::uint32_t>(entries.size()), 2);
  append(file, static_cast<std::uint32_t>(directory.size()), 4), append(file, start, 4),
      append(file, 0, 2);
  write_file(path, Bytes(file.begin(), file.end()));
}

/// A library of one model: a wedge 2 wide, 4 high, 1 deep (units of the file) whose high side is at
/// the back (-z), with a face of two corners, a pane of glass far above it and one texture missing.
inline void write_wedge_library(const std::filesystem::path& folder) {
  RgbImage image(4, 4, {200, 0, 0});
  const Bytes png = encode_png(image);
  write_zip(
      folder / "Test.sh3f",
      {{"PluginFurnitureCatalog.properties",
        "# comment\nid=Test\nlicense=CC0\n\nname#1=W\\u00e9dge\ncategory#1=Shapes\n"
        "model#1=/models/wedge/"
        "wedge.obj\nwidth#1=100\ndepth#1=60.0\nheight#1=80\ncreator#1=Caf\xe9\n"
        "modelRotation#1=1 0 0 0 1 0 0 0 1\nname#2=No model\nwidth#2=1\ndepth#2=1\nheight#2=1\n"},
       {"models/wedge/wedge.obj",
        "mtllib wedge.mtl\nv -1 0 1\nv 1 0 1\nv 1 0 0\nv -1 0 0\nv -1 2 0\nv 1 2 0\nv 0 4 0\n"
        "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nusemtl red\nf 1/1 2/2 3/3 4/4\nf 1/1 2/2 6/3 5/4\n"
        "usemtl lost\nf 3 4 5 6\nf 1 2\nusemtl glass\nf 5 6 7\n"},
       {"models/wedge/wedge.mtl",
        "newmtl red\nKd 0 0 0\nmap_Kd Red Wood.PNG\t\nnewmtl lost\nKd 1 1 1\nmap_Kd lost.png\n"
        "newmtl glass\nKd 1 1 1\nd 0.3\n"},
       {"models/wedge/red wood.png", std::string(png.begin(), png.end())}});
}

}  // namespace ovimap::fixture
