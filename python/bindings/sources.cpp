// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/unique_ptr.h>
#include <nanobind/stl/vector.h>

#include <future>
#include <mutex>

#include "arrays.h"
#include "bindings.h"
#include "ovimap/base/error.h"
#include "ovimap/pipeline/sequence/sequence_run.h"
#include "settings.h"
#include "source.h"
#include "without_gil.h"

namespace ovimap::python {

namespace {

/// Walks over frames and decodes the next while one is at work.
class FrameIterator {
 public:
  FrameIterator(std::shared_ptr<const FrameSource> frames, std::vector<std::int64_t> positions)
      : frames_(std::move(frames)), positions_(std::move(positions)) {
    read_ahead();
  }

  Frame next() {
    const std::lock_guard lock(mutex_);
    while (ahead_.valid()) {
      const std::int64_t position = positions_[begun_ - 1];
      FrameRead read = ahead_.get();
      read_ahead();
      if (read.frame) {
        any_usable_ = true;
        return std::move(*read.frame);
      }
      skipped_.push_back({position, read.fault});
    }
    if (!any_usable_ && !skipped_.empty())
      throw Error(concat("none of the ", skipped_.size(), " frames is usable: ",
                         commonest_fault(skipped_), "; ovimap.check tells more"));
    throw nb::stop_iteration();
  }

  std::vector<std::pair<std::int64_t, std::string>> skipped() const {
    const std::lock_guard lock(mutex_);
    std::vector<std::pair<std::int64_t, std::string>> result;
    for (const SkippedFrame& frame : skipped_) result.emplace_back(frame.position, frame.fault);
    return result;
  }
  std::size_t size() const { return positions_.size(); }

 private:
  void read_ahead() {
    if (begun_ == positions_.size()) return;
    ahead_ = std::async(std::launch::async, [frames = frames_, position = positions_[begun_]] {
      return frames->read(position);
    });
    ++begun_;
  }

  mutable std::mutex mutex_;  // threads may share one
  std::shared_ptr<const FrameSource> frames_;
  std::vector<std::int64_t> positions_;
  std::vector<SkippedFrame> skipped_;
  std::size_t begun_ = 0;
  bool any_usable_ = false;
  std::future<FrameRead> ahead_;  // last: it waits for its thread when it is destroyed
};

std::int64_t checked_position(const Source& source, std::int64_t position) {
  const std::int64_t size = source.frames->size();
  const std::int64_t from_start = position < 0 ? position + size : position;
  if (from_start < 0 || from_start >= size)
    throw nb::index_error(concat("frame ", position, " of ", size).c_str());
  return from_start;
}

Frame read_frame(const Source& source, std::int64_t position) {
  FrameRead read = source.frames->read(checked_position(source, position));
  if (!read.frame) throw FrameError(read.fault);
  return std::move(*read.frame);
}

std::unique_ptr<FrameIterator> iterate(const Source& source, const std::string& range) {
  return std::make_unique<FrameIterator>(
      source.frames, positions(parse_frame_range(range), source.frames->size()));
}

using IdArray = nb::ndarray<nb::numpy, const std::uint16_t, nb::ndim<2>>;

std::optional<IdArray> truth_ids(const Source& source, std::int64_t position) {
  std::optional<IdImage> ids = source.frames->truth_ids(checked_position(source, position));
  if (!ids) return std::nullopt;
  return own_image<IdArray>(std::move(*ids));
}

}  // namespace

void bind_sources(nb::module_& module) {
  nb::class_<FrameIterator>(module, "FrameIterator",
                            "The usable frames of a range, in order; the next one is decoded while "
                            "you work on one.")
      .def(
          "__iter__", [](nb::handle self) { return nb::borrow(self); },
          nb::sig("def __iter__(self) -> FrameIterator"))
      .def("__next__", &FrameIterator::next, nb::call_guard<WithoutGil>())
      .def("__len__", &FrameIterator::size, "Frames in the range, unusable ones included.")
      .def_prop_ro("skipped", &FrameIterator::skipped,
                   "(position, fault) of the frames met so far that cannot be used");
  nb::class_<Source>(module, "FrameSource",
                     "A recorded sequence. Iterating gives its usable frames; source[i] the frame "
                     "at a position, or FrameError with what is wrong with it.")
      .def_prop_ro(
          "kind", [](const Source& source) { return source.frames->kind(); },
          "the layout: \"replica\", \"tum\", \"folder\" ...")
      .def_ro("path", &Source::path)
      .def("__repr__",
           [](const Source& source) {
             return concat("FrameSource(", source.frames->kind(), " '", source.path,
                           "': ", source.frames->size(), " frames)");
           })
      .def("__len__", [](const Source& source) { return source.frames->size(); })
      .def("__getitem__", &read_frame, nb::arg("position"), nb::call_guard<WithoutGil>())
      .def("__iter__", [](const Source& source) { return iterate(source, ":"); })
      .def("frames", &iterate, nb::arg("range") = ":",
           "The frames of a range \"FIRST:LAST:STEP\", each part optional.")
      .def("truth_ids", &truth_ids, nb::arg("position"),
           "True instance ids in the colour camera, uint16 [height, width]; None where the "
           "recording has none.");
  module.def(
      "open_source",
      [](const nb::object& path, const Settings& settings) {
        const std::filesystem::path folder = to_path(path, "path");
        const auto config = configured<FrameSourceConfig>(settings);
        const WithoutGil release;
        return Source{open_frame_source(folder, config), folder.string()};
      },
      nb::arg("path"), nb::kw_only(), nb::arg("settings") = nb::none(),
      nb::sig("def open_source(path: str | os.PathLike[str], *, settings: dict[str, typing.Any] | "
              "None = None) -> FrameSource"),
      "Opens a recording; its layout is recognised by its files (docs/sources.md). "
      "settings(\"source\")"
      " lists what can be set. Raises Error when the path is missing or no layout fits.");
}

}  // namespace ovimap::python
