// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include <nanobind/stl/map.h>
#include <nanobind/stl/string.h>

#include <cmath>

#include "arrays.h"
#include "bindings.h"
#include "encoders.h"
#include "mapping.h"
#include "masks.h"
#include "open_handle.h"
#include "ovimap/frames/decoding/frame_decoder.h"
#include "ovimap/io/map_file/map_file.h"
#include "without_gil.h"

namespace ovimap::python {

namespace {

constexpr std::size_t kFramesUntilMotion = 30;  // as run_sequence has it

class MapperHandle final : public OpenHandle {
 public:
  MapperHandle(MapperSetup setup, std::shared_ptr<MaskSource> masks,
               std::shared_ptr<ImageTextEncoder> encoder)
      : setup_(std::move(setup)),
        mapper_(std::make_unique<Mapper>(setup_.config, std::move(masks), std::move(encoder))) {}
  ~MapperHandle() override {
    const nb::gil_scoped_release release;
    close();
  }

  FrameReport process(Frame& frame) {
    const auto turn = calls_.begin("Mapper");
    Mapper& mapper = open_mapper();
    if (frame.index < 0) frame.index = static_cast<std::int64_t>(sequence_.frames.size());
    require_fitting(frame, sequence_.depth_camera);
    const FrameReport report = mapper.process(frame);
    sequence_.depth_camera = frame.depth_camera;
    sequence_.frames.push_back(
        {frame.index, frame.timestamp_s, frame.name, frame.world_from_camera, report.labelled});
    if (sequence_.frames.size() == kFramesUntilMotion)
      require_motion(sequence_.frames, mapper.config());
    return report;
  }

  InstanceView project(const Frame& frame) {
    const auto turn = calls_.begin("Mapper");
    return open_mapper().project(frame);
  }

  std::size_t save(const std::filesystem::path& path, const std::string& source) {
    const auto turn = calls_.begin("Mapper");
    check_map_target(path);
    if (!map_.ready()) {
      Mapper& mapper = open_mapper();
      if (sequence_.frames.empty())
        throw Error("no frame was mapped, so there is nothing to save; process some first");
      require_motion(sequence_.frames, mapper.config());
      mapper.finish();
      map_.take(std::move(mapper), sequence_, source, setup_.config_text);
      mapper_.reset();
    }
    return map_.save(path);
  }

  std::size_t frames() {
    const auto turn = calls_.begin("Mapper");
    return sequence_.frames.size();
  }
  std::map<std::string, StageSummary> timings() {
    const auto turn = calls_.begin("Mapper");
    return open_mapper().timers().summary();
  }

 protected:
  nb::object self() override { return nb::find(*this); }
  void close() noexcept override {
    calls_.close();
    mapper_.reset();
    map_.drop();
  }

 private:
  Mapper& open_mapper() {
    if (!mapper_)
      throw Error("this Mapper was saved, which ends it; make another, or open the saved map");
    return *mapper_;
  }

  OneCall calls_;
  MapperSetup setup_;
  std::unique_ptr<Mapper> mapper_;
  SequenceResult sequence_;
  FinishedMap map_;
};

void bind_reports(nb::module_& module) {
  nb::class_<FrameReport>(module, "FrameReport", "What became of one frame.")
      .def_ro("regions", &FrameReport::regions, "geometric regions")
      .def_ro("entities", &FrameReport::entities,
              "2D entities; 0 as well when the frame was not masked")
      .def_ro("segments", &FrameReport::segments, "pieces lifted to 3D")
      .def_ro("founded", &FrameReport::founded, "new super-points")
      .def_ro("views", &FrameReport::views, "views of objects chosen for embedding")
      .def_ro("labelled", &FrameReport::labelled, "the frame voted for labels")
      .def("__repr__", [](const FrameReport& report) {
        return concat("FrameReport(regions=", report.regions, ", entities=", report.entities,
                      ", segments=", report.segments, ", founded=", report.founded,
                      ", views=", report.views, ", labelled=", report.labelled ? "True" : "False",
                      ")");
      });
  nb::class_<StageSummary>(module, "StageSummary", "Durations of one stage, in milliseconds.")
      .def_ro("p50_ms", &StageSummary::p50_ms)
      .def_ro("p95_ms", &StageSummary::p95_ms)
      .def_ro("p99_ms", &StageSummary::p99_ms)
      .def_ro("total_ms", &StageSummary::total_ms)
      .def_ro("count", &StageSummary::count);
  nb::class_<InstanceView>(module, "InstanceView", "The map of instances as one camera sees it.")
      .def_prop_ro(
          "depth",
          [](const InstanceView& seen) {
            return view<nb::ndarray<nb::numpy, const float, nb::ndim<2>>>(
                seen.depth.data(),
                {static_cast<std::size_t>(seen.depth.height()),
                 static_cast<std::size_t>(seen.depth.width())},
                nb::find(seen));
          },
          "float32 [height, width], metres, 0 = no surface")
      .def_prop_ro(
          "instances",
          [](const InstanceView& seen) {
            return view<nb::ndarray<nb::numpy, const std::uint32_t, nb::ndim<2>>>(
                seen.instances.data(),
                {static_cast<std::size_t>(seen.instances.height()),
                 static_cast<std::size_t>(seen.instances.width())},
                nb::find(seen));
          },
          "uint32 [height, width], 0 = none");
}

constexpr const char* kMapperText = R"(Builds a map of objects frame by frame.

masks: None (geometry alone), the name of a model or a folder of PNGs, a MaskSource, or a callable
    (frame, prompts) -> integer ids [height, width] of frame.color's size, 0 = no entity, or a tuple
    of these and scores (how sure it is of id 1, id 2 and so on, from 0 to 1), or None:
    there are no masks of this frame, which then adds geometry and colour alone, while an image of
    zeros says that no entity is to be seen. It is asked when what is in view has moved by
    mask_motion of the picture's width, or every mask_interval frames if that is set. What it raises ends the call that asked; FrameError leaves that frame out.
encoder: None, "default", the name of a model, an ImageTextEncoder, or an object with name,
    dimension and encode_images(list of uint8 [h, w, 3]) -> [images, dimension] (and
    encode_texts(list of str) -> [texts, dimension] for searching). It is called from another thread;
    what it raises comes out of the next call, once, and the views it was given stay without
    embedding: process the frame again, or save again, to go on.
preset: "default" or "reference". settings: as ovimap.settings("mapper") lists them.

Synchronous and deterministic: the same frames give the same map, bit for bit. One call at a time;
a second one, from another thread or from a callback, raises Error. Heavy calls release the GIL.)";

}  // namespace

MapperSetup mapper_setup(const std::string& preset, const Settings& settings) {
  MapperSetup setup{configured(settings, mapper_preset(preset)), {}};
  ConfigFields fields;
  list_fields(setup.config, fields);
  setup.config_text = concat("# preset ", preset, ", made with Python\n", fields.dump());
  return setup;
}

void require_fitting(const Frame& frame, const PinholeCamera& depth_camera) {
  if (!has_depth(frame.depth))
    throw FrameError(
        "this frame has no depth that counts: floats are metres, integers depth_scale a metre, and "
        "what is not from min_depth_m to max_depth_m is none");
  const PinholeCamera& next = frame.depth_camera;
  constexpr float kSameZoom = 0.1f;  // phones give every frame focal lengths of its own
  if (depth_camera.width == 0) return;
  const bool same = depth_camera.width == next.width && depth_camera.height == next.height &&
                    std::abs(next.fx - depth_camera.fx) <= kSameZoom * depth_camera.fx;
  if (!same)
    throw Error(
        "this frame is of another depth camera than those before; a map has one: make another "
        "Mapper and merge the maps (ovimap merge)");
}

void FinishedMap::take(Mapper&& mapper, const SequenceResult& sequence, const std::string& source,
                       const std::string& config_text) {
  document_ =
      make_document(std::move(mapper), sequence, {.source = source, .config_text = config_text});
}

std::size_t FinishedMap::save(const std::filesystem::path& path) const {
  save_map(path, *document_);
  return document_->instances.size();
}

void bind_mapper(nb::module_& module) {
  bind_reports(module);
  module.def(
      "check_map_target", [](const nb::object& path) { check_map_target(to_path(path, "path")); },
      nb::arg("path"), nb::sig("def check_map_target(path: str | os.PathLike[str]) -> None"),
      "Raises Error where no map can be written; changes nothing.");
  const auto release = nb::call_guard<WithoutGil>();
  nb::class_<MapperHandle>(module, "Mapper", kMapperText)
      .def(
          "__init__",
          [](MapperHandle* self, const nb::object& masks, const nb::object& encoder,
             const std::string& preset, const Settings& settings) {
            new (self)
                MapperHandle(mapper_setup(preset, settings), to_masks(masks), to_encoder(encoder));
          },
          nb::arg("masks") = nb::none(), nb::arg("encoder") = nb::none(), nb::kw_only(),
          nb::arg("preset") = "default", nb::arg("settings") = nb::none(),
          nb::sig(
              "def __init__(self, masks: MaskSource | str | os.PathLike[str] | "
              "typing.Callable[[Frame, list[MaskPrompt]], typing.Any] | None = None, encoder: "
              "typing.Any = None, *, preset: str = 'default', settings: dict[str, typing.Any] | "
              "None = None) -> None"))
      .def("process", &MapperHandle::process, nb::arg("frame"), release,
           "Fuses one frame. Raises what the masks raise; the map is then as it was before.")
      .def("project", &MapperHandle::project, nb::arg("frame"), release,
           "The map as it is now, seen by the frame's depth camera.")
      .def(
          "save",
          [](MapperHandle& self, const nb::object& path, const std::string& source) {
            const std::filesystem::path file = to_path(path, "path");
            const WithoutGil without_gil;
            return self.save(file, source);
          },
          nb::arg("path"), nb::kw_only(), nb::arg("source") = "python",
          nb::sig("def save(self, path: str | os.PathLike[str], *, source: str = 'python') -> int"),
          "Finishes the map and writes it; returns the number of objects. No frame can be added "
          "afterwards. source: what the map says of where its frames came from. When writing fails "
          "(Error), call it again with another path.")
      .def_prop_ro("frames", &MapperHandle::frames, "frames in the map")
      .def("timings", &MapperHandle::timings, "How long each stage took so far.");
}

}  // namespace ovimap::python
