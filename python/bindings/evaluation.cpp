// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include <nanobind/stl/string.h>

#include "apps/evaluation/eval_report.h"
#include "bindings.h"
#include "settings.h"
#include "wording.h"
#ifdef OVIMAP_SYNTH
#include "apps/rendering/synth_room.h"
#include "without_gil.h"
#endif

namespace ovimap::python {

namespace {

/// What `ovimap eval --json` prints.
std::string evaluate(const nb::object& maps, const nb::object& truths, const std::string& classes,
                     const std::string& encoder, const Settings& settings,
                     const nb::object& model_dirs) {
  const auto map_paths = to_paths(maps, "maps"), truth_paths = to_paths(truths, "truths");
  if (map_paths.size() != truth_paths.size())
    throw nb::value_error(concat(map_paths.size(), " maps but ", truth_paths.size(),
                                 " truths; give one truth for each map, in order")
                              .c_str());
  const auto config = configured<EvaluationConfig>(settings);
  EvaluationOptions options;
  options.classes = classes;
  options.encoder = encoder;
  options.model_dirs = to_paths(model_dirs, "model_dirs");
  const WithoutGil release;
  std::vector<MapAndTruth> pairs;
  for (std::size_t i = 0; i < map_paths.size(); ++i)
    pairs.push_back({map_paths[i], truth_paths[i]});
  Evaluation evaluation = evaluate_maps(pairs, options, config);
  for (std::string& notice : evaluation.notices) notice = in_python_words(notice);
  return apps::eval_json(evaluation, apps::table_of(evaluation, config, {})).dump();
}

#ifdef OVIMAP_SYNTH
std::string synthesize(const nb::object& out, const apps::RoomOptions& options) {
  const std::filesystem::path folder = to_path(out, "out");
  const WithoutGil release;
  return apps::write_room(folder, options, "room").scene;
}
#endif

}  // namespace

void bind_evaluation(nb::module_& module) {
  module.def("eval_json", &evaluate, nb::arg("maps"), nb::arg("truths"), nb::arg("classes"),
             nb::arg("encoder"), nb::arg("settings"), nb::arg("model_dirs"),
             nb::sig("def eval_json(maps: object, truths: object, classes: str, encoder: str, "
                     "settings: dict[str, typing.Any] | None, model_dirs: object) -> str"));
#ifdef OVIMAP_SYNTH
  module.def(
      "synth",
      [](const nb::object& out, const std::string& room, int frames, std::uint64_t seed,
         bool noise) {
        apps::RoomOptions options;
        options.room = room;
        options.frames = frames;
        options.seed = seed;
        options.frames_as.noise = noise;
        return synthesize(out, options);
      },
      nb::arg("out"), nb::arg("room") = "tiny", nb::kw_only(), nb::arg("frames") = 0,
      nb::arg("seed") = 1, nb::arg("noise") = false,
      nb::sig(
          "def synth(out: str | os.PathLike[str], room: str = 'tiny', *, frames: int = 0, seed: "
          "int = 1, noise: bool = False) -> str"),
      "Renders a furnished room with exact truth into OUT/room and returns that path. frames: 0 = "
      "as "
      "the room says. noise: as a depth camera sees it. Raises Error for an unknown room (the "
      "message "
      "lists them).");
#endif
}

}  // namespace ovimap::python
