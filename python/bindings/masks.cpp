// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "masks.h"

#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "arrays.h"
#include "bindings.h"
#include "callback.h"
#include "ovimap/base/error.h"
#include "ovimap/inference/mask_source_factory.h"
#include "ovimap/inference/masks/entity_ids.h"
#include "settings.h"
#include "source.h"
#include "without_gil.h"

namespace ovimap::python {

namespace {

/// How sure a callable is of ids 1 to `count`.
std::vector<float> read_scores(const nb::object& given, std::size_t count) {
  std::vector<float> scores;
  if (!nb::try_cast(given, scores))
    throw nb::type_error("scores of masks must be a list of numbers, of id 1, id 2 and so on");
  for (const float score : scores)
    if (!(score >= 0 && score <= 1))
      throw nb::value_error(concat("scores of masks must be from 0 to 1, not ", score).c_str());
  if (scores.size() < count)
    throw nb::value_error(concat("the masks have id ", count, ", but only ", scores.size(),
                                 " scores: give one of id 1, id 2 and so on")
                              .c_str());
  scores.resize(count);
  return scores;
}

/// Masks of a Python callable. Called from whatever thread maps; each call holds the GIL.
class CallableMasks : public MaskSource {
 public:
  explicit CallableMasks(nb::handle callable) : callable_(nb::borrow(callable)) {}
  ~CallableMasks() override {
    if (!nb::is_alive()) {
      static_cast<void>(callable_.release());
      return;
    }
    const nb::gil_scoped_acquire acquire;
    callable_.reset();
  }

  std::string kind() const override { return "python"; }
  /// A user's model is taken for a network: mask_motion says on which frames it is asked.
  bool is_slow() const override { return true; }

  std::optional<Entities> entities(const Frame& frame,
                                   std::span<const MaskPrompt> prompts) override {
    return call_python([&] {
      try {
        return ask(frame, prompts);
      } catch (const nb::python_error& error) {
        if (!error.matches(frame_error_type())) throw;
        throw FrameError(nb::cast<std::string>(nb::str(error.value())));
      }
    });
  }

 private:
  std::optional<Entities> ask(const Frame& frame, std::span<const MaskPrompt> prompts) const {
    // A copy: the callable may keep it, and the mapper's frame does not last.
    const nb::object found = callable_(Frame(frame), std::vector(prompts.begin(), prompts.end()));
    if (found.is_none()) return std::nullopt;
    const bool rated = nb::isinstance<nb::tuple>(found) && nb::len(found) == 2;
    const nb::object ids = rated ? nb::object(found[0]) : found;
    IdImage image = read_ids(ids, "what the masks callable returned", frame.color.width(),
                             frame.color.height());
    if (!rated) return entities_of_ids(image);
    std::vector<float> scores = read_scores(found[1], last_id(image));
    return keep_visible({std::move(image), std::move(scores)}, 0);
  }

  nb::object callable_;
};

/// True masks, which keep their recording open.
class TruthMasks : public MaskSource {
 public:
  explicit TruthMasks(std::shared_ptr<const FrameSource> frames)
      : frames_(std::move(frames)),
        masks_(make_mask_source("gt", {}, {.frames = frames_.get(), .model_dirs = {}})) {}
  std::string kind() const override { return masks_->kind(); }
  std::optional<Entities> entities(const Frame& frame,
                                   std::span<const MaskPrompt> prompts) override {
    return masks_->entities(frame, prompts);
  }

 private:
  std::shared_ptr<const FrameSource> frames_;
  std::unique_ptr<MaskSource> masks_;
};

std::shared_ptr<MaskSource> open_masks(const std::string& spec, const Source* source,
                                       const Settings& settings, const nb::object& model_dirs) {
  const auto config = configured<MaskSourceConfig>(settings);
  const MaskSourceContext context{source ? source->frames.get() : nullptr,
                                  to_paths(model_dirs, "model_dirs")};
  const WithoutGil release;
  if (spec == "gt" && source) return std::make_shared<TruthMasks>(source->frames);
  return make_mask_source(spec, config, context);
}

}  // namespace

std::shared_ptr<MaskSource> to_masks(nb::handle masks) {
  if (masks.is_none()) return nullptr;
  if (is_path(masks)) return open_masks(to_path(masks, "masks").string(), nullptr, {}, nb::list());
  if (nb::isinstance<MaskSource>(masks)) return nb::cast<std::shared_ptr<MaskSource>>(masks);
  if (PyCallable_Check(masks.ptr())) return std::make_shared<CallableMasks>(masks);
  throw nb::type_error(
      "masks must be None, the name of a model or folder, a MaskSource, or a callable of (frame, "
      "prompts) that returns an id image, (id image, scores) or None");
}

void bind_masks(nb::module_& module) {
  nb::class_<MaskPrompt>(module, "MaskPrompt",
                         "Where a promptable network should look for an entity, in pixels of the "
                         "colour image.")
      .def_prop_ro(
          "interior_px",
          [](const MaskPrompt& prompt) {
            return nb::make_tuple(prompt.interior_px.x(), prompt.interior_px.y());
          },
          nb::sig("def interior_px(self) -> tuple[float, float]"), "(x, y) well inside the region")
      .def_prop_ro(
          "extent_px",
          [](const MaskPrompt& prompt) {
            const auto &min = prompt.extent_px.min(), &max = prompt.extent_px.max();
            return nb::make_tuple(min.x(), min.y(), max.x(), max.y());
          },
          nb::sig("def extent_px(self) -> tuple[float, float, float, float]"),
          "(x, y, x, y) of the region's box")
      .def_ro("area_px", &MaskPrompt::area_px, "the region's size");
  nb::class_<MaskSource>(module, "MaskSource", "Finds the 2D entities of a frame.")
      .def_prop_ro("kind", &MaskSource::kind, "\"sam\", \"entity\", \"dir\" or \"gt\"")
      .def(
          "__call__",
          [](MaskSource& masks, const Frame& frame) -> nb::object {
            std::optional<Entities> found;
            {
              const WithoutGil release;
              found = masks.entities(frame, {});
            }
            if (!found) return nb::none();
            return nb::cast(own_image<nb::ndarray<nb::numpy, const std::uint16_t, nb::ndim<2>>>(
                std::move(found->ids)));
          },
          nb::arg("frame"),
          nb::sig("def __call__(self, frame: Frame) -> numpy.typing.NDArray[numpy.uint16] | None"),
          "The entities of a frame, without prompts: uint16 [height, width] in the colour image, 0 "
          "= none; None where there are no masks of the frame.");
  module.def(
      "make_mask_source", &open_masks, nb::arg("spec"), nb::arg("source") = nb::none(),
      nb::kw_only(), nb::arg("settings") = nb::none(), nb::arg("model_dirs") = nb::list(),
      nb::sig("def make_mask_source(spec: str, source: FrameSource | None = None, *, settings: "
              "dict[str, typing.Any] | None = None, model_dirs: typing.Sequence[str | "
              "os.PathLike[str]] = ()) -> MaskSource | None"),
      "The masks that spec names: \"none\" (None), \"sam\", \"gt\" (needs the source), a model "
      "folder, a folder of PNGs, or a model on the search path. Raises Error when there is no "
      "such thing.");
}

}  // namespace ovimap::python
