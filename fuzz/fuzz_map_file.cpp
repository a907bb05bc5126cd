// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
// Whole map files. Nearly every change is caught by SQLite or a hash, so voxels have a target of
// their own: fuzz_tile.
#include "input_file.h"
#include "ovimap/base/error.h"
#include "ovimap/io/map_file/map_check.h"
#include "ovimap/io/map_file/map_edits.h"
#include "ovimap/io/map_file/searchable_map.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto path = input_file(".ovimap", {data, size});
  const auto attempt = [&](auto&& read) {
    try {
      read();
    } catch (const ovimap::Error&) {
    }
  };
  attempt([&] { (void)ovimap::read_searchable_map(path).shapes.whole(); });
  attempt([&] { (void)ovimap::load_corrected_map(path); });
  attempt([&] { (void)ovimap::check_map(path); });
  const ovimap::Bytes after = ovimap::read_file(path);
  if (!std::equal(after.begin(), after.end(), data, data + size)) __builtin_trap();
  std::filesystem::remove(path);
  return 0;
}
