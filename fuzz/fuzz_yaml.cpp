// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
// YAML files of a recording and of the program: calibration and settings.
#include "input_file.h"
#include "ovimap/base/error.h"
#include "ovimap/frames/frame/camera_rig.h"
#include "ovimap/io/settings/config_file.h"
#include "ovimap/semantics/query/query_config.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto path = input_file(".yaml", {data, size});
  try {
    ovimap::CameraRig rig;
    ovimap::apply_calibration(path, rig);
  } catch (const ovimap::Error&) {
  }
  try {
    ovimap::QueryConfig config;
    ovimap::ConfigFields fields;
    ovimap::list_fields(config, fields);
    ovimap::load_config(path, fields);
  } catch (const ovimap::Error&) {
  }
  std::filesystem::remove(path);
  return 0;
}
