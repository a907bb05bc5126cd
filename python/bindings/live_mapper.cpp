// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/live/live_mapper.h"

#include <nanobind/stl/string.h>

#include <mutex>
#include <optional>

#include "bindings.h"
#include "encoders.h"
#include "mapping.h"
#include "masks.h"
#include "open_handle.h"
#include "ovimap/io/map_file/map_file.h"
#include "without_gil.h"

namespace ovimap::python {

namespace {

class LiveMapperHandle final : public OpenHandle {
 public:
  LiveMapperHandle(MapperSetup setup, const LiveConfig& live, std::shared_ptr<MaskSource> masks,
                   std::shared_ptr<ImageTextEncoder> encoder)
      : config_text_("# live\n" + setup.config_text),
        mapper_(std::make_unique<LiveMapper>(setup.config, live, std::move(masks),
                                             std::move(encoder))) {}
  ~LiveMapperHandle() override {
    const nb::gil_scoped_release release;
    close();
  }

  bool push(const Frame& frame) {
    const auto turn = calls_.begin("LiveMapper");
    return open_mapper().push(taken(frame));
  }
  void push_and_wait(const Frame& frame) {
    const auto turn = calls_.begin("LiveMapper");
    open_mapper().push_and_wait(taken(frame));
  }
  void drain() {
    {
      const WithoutGil release;
      const auto turn = calls_.begin("LiveMapper");
      open_mapper().drain();
    }
    warn_of_encoder();
  }
  void cancel() {
    const auto turn = calls_.begin("LiveMapper");
    open_mapper().cancel();
    cancelled_ = true;
  }
  LiveStatistics statistics() const {
    const std::lock_guard lock(mutex_);
    if (!mapper_) return last_statistics_;
    return mapper_->statistics();
  }

  std::size_t save(const std::filesystem::path& path, const std::string& source) {
    std::size_t objects = 0;
    {
      const WithoutGil release;
      const auto turn = calls_.begin("LiveMapper");
      check_map_target(path);
      if (!map_.ready()) take_map(source);
      objects = map_.save(path);
    }
    warn_of_encoder();
    return objects;
  }

 protected:
  nb::object self() override { return nb::find(*this); }
  void close() noexcept override {
    {
      const std::lock_guard lock(mutex_);
      if (mapper_) mapper_->stop();
    }
    calls_.close();
    const std::lock_guard lock(mutex_);
    mapper_.reset();
    finished_.reset();
    map_.drop();
  }

 private:
  /// Whatever throws, what was fused waits for the next call.
  void take_map(const std::string& source) {
    if (!finished_) {
      LiveMapper& live = open_mapper();
      if (!cancelled_) live.drain();
      sequence_.frames = live.frames();
      if (sequence_.frames.empty())
        throw Error("no frame was mapped, so there is nothing to save; push some first");
      require_motion(sequence_.frames, live.config());
      finished_.emplace(live.take());
      const std::lock_guard lock(mutex_);
      last_statistics_ = live.statistics();
      mapper_.reset();
    }
    finished_->finish();
    EncoderFailures failures = finished_->encoder_failures();
    {
      const std::lock_guard lock(mutex_);
      last_statistics_.views_failed = failures.views;
      last_statistics_.encoder_fault = std::move(failures.first);
    }
    map_.take(std::move(*finished_), sequence_, source, config_text_);
    finished_.reset();
  }

  /// Once, with the GIL held. Throws where warnings are errors.
  void warn_of_encoder() {
    const LiveStatistics done = statistics();
    if (done.views_failed == 0 || std::exchange(warned_, true)) return;
    const std::string text = concat("the encoder failed on ", done.views_failed,
                                    " view(s), the first: ", done.encoder_fault,
                                    "; `ovimap reembed` gives their objects embeddings");
    if (PyErr_WarnEx(PyExc_RuntimeWarning, text.c_str(), 1) < 0) nb::raise_python_error();
  }

  LiveMapper& open_mapper() {
    if (!mapper_)
      throw Error("this LiveMapper was saved, which ends it; make another, or open the saved map");
    return *mapper_;
  }

  Frame taken(const Frame& frame) {
    require_fitting(frame, sequence_.depth_camera);
    Frame mine = frame;
    if (mine.index < 0) mine.index = next_index_;
    next_index_ = mine.index + 1;
    sequence_.depth_camera = mine.depth_camera;
    return mine;
  }

  OneCall calls_;
  std::string config_text_;
  mutable std::mutex mutex_;  ///< for statistics, which any thread may ask for
  std::unique_ptr<LiveMapper> mapper_;
  LiveStatistics last_statistics_;
  std::optional<Mapper> finished_;  ///< taken from the threads, not yet a map
  SequenceResult sequence_;
  std::int64_t next_index_ = 0;
  bool cancelled_ = false, warned_ = false;
  FinishedMap map_;
};

void bind_statistics(nb::module_& module) {
  nb::class_<LiveStatistics>(module, "LiveStatistics", "What a live run did and left out.")
      .def_ro("frames_pushed", &LiveStatistics::frames_pushed)
      .def_ro("frames_fused", &LiveStatistics::frames_fused)
      .def_ro("frames_dropped", &LiveStatistics::frames_dropped)
      .def_ro("mask_frames", &LiveStatistics::mask_frames, "frames whose masks are in the map")
      .def_ro("masks_late", &LiveStatistics::masks_late, "... after their frame was fused")
      .def_ro("masks_waiting", &LiveStatistics::masks_waiting, "frames that are to get masks yet")
      .def_ro("masks_skipped", &LiveStatistics::masks_skipped,
              "frames that wanted masks, of which there were too many")
      .def_ro("masks_failed", &LiveStatistics::masks_failed, "frames whose masks were bad")
      .def_ro("masks_absent", &LiveStatistics::masks_absent,
              "frames that the source had no masks of")
      .def_ro("mask_fault", &LiveStatistics::mask_fault, "of the first that failed")
      .def_ro("views_skipped", &LiveStatistics::views_skipped, "looks at objects left out")
      .def_ro("views_failed", &LiveStatistics::views_failed,
              "views without embedding, because the encoder raised something")
      .def_ro("encoder_fault", &LiveStatistics::encoder_fault, "of the first of these")
      .def_ro("geometry_lag", &LiveStatistics::geometry_lag, "from push until the frame was fused")
      .def_ro("mask_lag", &LiveStatistics::mask_lag, "from push until its masks were in the map");
}

constexpr const char* kLiveText = R"(Mapper for a camera that does not wait (docs/live.md).

Frames go through threads of their own; when it falls behind it leaves out masks first, views
second, frames last, and counts them. Arguments as those of Mapper, which are called from those
threads; live: as ovimap.settings("live") lists them. What masks raise comes out of the next push,
drain or save; after cancel, save keeps what was fused. What the encoder raises costs its views their
embedding: statistics() counts them, and drain or save warns. One call at a time.)";

}  // namespace

void bind_live_mapper(nb::module_& module) {
  bind_statistics(module);
  const auto release = nb::call_guard<WithoutGil>();
  nb::class_<LiveMapperHandle>(module, "LiveMapper", kLiveText)
      .def(
          "__init__",
          [](LiveMapperHandle* self, const nb::object& masks, const nb::object& encoder,
             const std::string& preset, const Settings& settings, const Settings& live) {
            new (self)
                LiveMapperHandle(mapper_setup(preset, settings), configured<LiveConfig>(live),
                                 to_masks(masks), to_encoder(encoder));
          },
          nb::arg("masks") = nb::none(), nb::arg("encoder") = nb::none(), nb::kw_only(),
          nb::arg("preset") = "default", nb::arg("settings") = nb::none(),
          nb::arg("live") = nb::none(),
          nb::sig(
              "def __init__(self, masks: MaskSource | str | os.PathLike[str] | "
              "typing.Callable[[Frame, list[MaskPrompt]], typing.Any] | None = None, encoder: "
              "typing.Any = None, *, preset: str = 'default', settings: dict[str, typing.Any] | "
              "None = None, live: dict[str, typing.Any] | None = None) -> None"))
      .def("push", &LiveMapperHandle::push, nb::arg("frame"), release,
           "Takes a frame without waiting; False when it had to be dropped.")
      .def("push_and_wait", &LiveMapperHandle::push_and_wait, nb::arg("frame"), release,
           "Takes a frame; waits for room.")
      .def("drain", &LiveMapperHandle::drain,
           "Waits until everything pushed is in the map; then no more frames are taken.")
      .def("cancel", &LiveMapperHandle::cancel, release,
           "Stops as soon as each stage has finished what it is at. What was fused stays.")
      .def("statistics", &LiveMapperHandle::statistics, release)
      .def(
          "save",
          [](LiveMapperHandle& self, const nb::object& path, const std::string& source) {
            return self.save(to_path(path, "path"), source);
          },
          nb::arg("path"), nb::kw_only(), nb::arg("source") = "python",
          nb::sig("def save(self, path: str | os.PathLike[str], *, source: str = 'python') -> int"),
          "Drains, finishes the map and writes it; returns the number of objects. When writing "
          "fails (Error), call it again with another path.");
}

}  // namespace ovimap::python
