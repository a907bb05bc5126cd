// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "settings.h"

#include <nanobind/stl/vector.h>

#include "bindings.h"
#include "ovimap/frames/calibration/color_calibration.h"
#include "ovimap/frames/check/source_check.h"
#include "ovimap/inference/mask_source_factory.h"
#include "ovimap/pipeline/evaluation/map_evaluation.h"
#include "ovimap/pipeline/live/live_mapper.h"
#include "ovimap/semantics/query/query_config.h"

namespace ovimap::python {

namespace {

/// A Python string's text, of an attribute of the value's type.
std::string type_text(nb::handle value, const char* attribute) {
  return nb::str(value.type().attr(attribute)).c_str();
}

bool is_numpy_bool(nb::handle value) {
  const std::string name = type_text(value, "__name__");
  return type_text(value, "__module__") == "numpy" && (name == "bool" || name == "bool_");
}

std::string text_of(nb::handle value) {
  if (nb::isinstance<nb::bool_>(value) || is_numpy_bool(value))
    return PyObject_IsTrue(value.ptr()) == 1 ? "true" : "false";
  return nb::cast<std::string>(nb::str(value));
}

struct Setting {
  std::string name, value, accepts, help;
};

template <class Config>
std::vector<Setting> settings_of() {
  Config config;
  ConfigFields fields;
  list_fields(config, fields);
  std::vector<Setting> settings;
  for (const ConfigField& field : fields.fields())
    settings.push_back({field.name, field.get(), field.accepts, field.help});
  return settings;
}

std::vector<Setting> list_settings(const std::string& of) {
  if (of == "mapper") return settings_of<MapperConfig>();
  if (of == "live") return settings_of<LiveConfig>();
  if (of == "source") return settings_of<FrameSourceConfig>();
  if (of == "masks") return settings_of<MaskSourceConfig>();
  if (of == "query") return settings_of<QueryConfig>();
  if (of == "check") return settings_of<SourceCheckConfig>();
  if (of == "calibrate") return settings_of<ColorCalibrationConfig>();
  if (of == "evaluation") return settings_of<EvaluationConfig>();
  throw Error(
      "there are no settings of '" + of +
      "'; accepted are mapper, live, source, masks, query, check, calibrate and evaluation");
}

}  // namespace

void apply_settings(const Settings& settings, ConfigFields& fields) {
  if (!settings) return;
  for (const auto& [name, value] : *settings) fields.set(text_of(name), text_of(value));
}

bool is_path(nb::handle path) {
  return nb::isinstance<nb::str>(path) || nb::hasattr(path, "__fspath__");
}

std::filesystem::path to_path(nb::handle path, const char* name) {
  if (!is_path(path))
    throw nb::type_error(concat(name, " must be a path: a string or os.PathLike").c_str());
  PyObject* bytes = nullptr;  // as the system has it: not every file name is UTF-8
  if (PyUnicode_FSConverter(path.ptr(), &bytes) == 0) throw nb::python_error();
  return std::string(nb::steal<nb::bytes>(bytes).c_str());
}

std::vector<std::filesystem::path> to_paths(nb::handle paths, const char* name) {
  if (is_path(paths)) return {to_path(paths, name)};
  std::vector<std::filesystem::path> result;
  for (const nb::handle path : paths) result.push_back(to_path(path, name));
  return result;
}

void bind_settings(nb::module_& module) {
  nb::class_<Setting>(module, "Setting", "One setting of a component.")
      .def_ro("name", &Setting::name, "dotted name, as the settings arguments take it")
      .def_ro("value", &Setting::value, "its default, as text")
      .def_ro("accepts", &Setting::accepts, "what it accepts, in words")
      .def_ro("help", &Setting::help, "what it means, with the unit")
      .def("__repr__", [](const Setting& setting) {
        return concat(setting.name, "=", setting.value, " (", setting.accepts, "): ", setting.help);
      });
  module.def("settings", &list_settings, nb::arg("of") = "mapper",
             "Every setting of a component: mapper, live, source, masks, query, check, calibrate "
             "or evaluation. Raises Error for another.");
}

}  // namespace ovimap::python
