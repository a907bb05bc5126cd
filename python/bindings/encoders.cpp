// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "encoders.h"

#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <limits>

#include "arrays.h"
#include "bindings.h"
#include "callback.h"
#include "ovimap/inference/encoders/text_cache.h"
#include "settings.h"
#include "without_gil.h"

namespace ovimap::python {

namespace {

using ColorView = nb::ndarray<nb::numpy, const std::uint8_t, nb::shape<-1, -1, 3>>;

/// Stands for a model's digest where its maker gives none: two of one name and length are taken for
/// the same.
std::string digest_of(nb::handle encoder, const std::string& name, int dimension) {
  if (nb::hasattr(encoder, "digest")) return nb::cast<std::string>(nb::str(encoder.attr("digest")));
  const nb::object sha256 = nb::module_::import_("hashlib").attr("sha256");
  const std::string text = concat("python ", name, " ", dimension);
  return nb::cast<std::string>(sha256(nb::bytes(text.data(), text.size())).attr("hexdigest")());
}

/// An encoder of Python's making. Called from whatever thread embeds; each call holds the GIL.
class PythonEncoder : public ImageTextEncoder {
 public:
  explicit PythonEncoder(nb::handle encoder) : encoder_(nb::borrow(encoder)) {
    if (!nb::hasattr(encoder, "name") || !nb::hasattr(encoder, "dimension"))
      throw nb::type_error(
          "an encoder must have the attributes name (a string) and dimension (numbers in an "
          "embedding)");
    identity_.name = nb::cast<std::string>(nb::str(encoder.attr("name")));
    const auto dimension = read_integer(encoder.attr("dimension"));
    if (!dimension)
      throw nb::type_error("an encoder's dimension must be an integer: numbers in an embedding");
    identity_.dimension =
        static_cast<int>(std::clamp<std::int64_t>(*dimension, 0, std::numeric_limits<int>::max()));
    if (identity_.dimension < 1 || identity_.name.empty())
      throw nb::value_error("an encoder needs a name and a dimension of at least 1");
    identity_.digest = digest_of(encoder, identity_.name, identity_.dimension);
  }
  ~PythonEncoder() override {
    if (!nb::is_alive()) {
      static_cast<void>(encoder_.release());
      return;
    }
    const nb::gil_scoped_acquire acquire;
    encoder_.reset();
  }

  const EncoderIdentity& identity() const override { return identity_; }
  std::optional<MatchCalibration> calibration() const override { return std::nullopt; }

  Embeddings encode_images(std::span<const RgbImage> images) override {
    return call_python([&] {
      nb::list arrays;
      for (const RgbImage& image : images) arrays.append(to_array_copy(image));
      return read_embeddings(encoder_.attr("encode_images")(arrays), "what encode_images returned",
                             images.size(), identity_.dimension);
    });
  }

  Embeddings encode_texts(std::span<const std::string> texts) override {
    return call_python([&] {
      if (!nb::hasattr(encoder_, "encode_texts"))
        throw Error(concat("encoder '", identity_.name,
                           "' has no encode_texts, so words cannot be searched; give it one, or "
                           "search by object or picture"));
      const std::vector<std::string> list(texts.begin(), texts.end());
      return read_embeddings(encoder_.attr("encode_texts")(list), "what encode_texts returned",
                             texts.size(), identity_.dimension);
    });
  }

 private:
  /// Python may keep it, and a view would not last.
  static nb::object to_array_copy(const RgbImage& image) {
    return nb::cast(view<ColorView>(reinterpret_cast<const std::uint8_t*>(image.data()),
                                    {static_cast<std::size_t>(image.height()),
                                     static_cast<std::size_t>(image.width()), 3},
                                    nb::handle()),
                    nb::rv_policy::copy);
  }

  nb::object encoder_;
  EncoderIdentity identity_;
};

EmbeddingArray encode_images(ImageTextEncoder& encoder, const std::vector<nb::object>& images) {
  std::vector<RgbImage> pixels;
  for (const nb::object& image : images) pixels.push_back(read_color(image, "image"));
  Embeddings rows;
  {
    const WithoutGil release;
    rows = encoder.encode_images(pixels);
  }
  return to_array(std::move(rows));
}

EmbeddingArray encode_texts(ImageTextEncoder& encoder, const std::vector<std::string>& texts) {
  Embeddings rows;
  {
    const WithoutGil release;
    rows = encoder.encode_texts(texts);
  }
  return to_array(std::move(rows));
}

/// With the lists of words that verdicts need encoded once per model and user, as the program does.
std::shared_ptr<ImageTextEncoder> shared_encoder(std::unique_ptr<ImageTextEncoder> encoder) {
  if (!encoder) return nullptr;
  return remember_text_lists(std::move(encoder), user_cache_folder());
}

}  // namespace

bool is_encoder_object(nb::handle encoder) {
  return nb::isinstance<ImageTextEncoder>(encoder) || nb::hasattr(encoder, "encode_images");
}

std::shared_ptr<ImageTextEncoder> to_encoder(nb::handle encoder) {
  if (encoder.is_none()) return nullptr;
  if (nb::isinstance<ImageTextEncoder>(encoder))
    return nb::cast<std::shared_ptr<ImageTextEncoder>>(encoder);
  if (nb::hasattr(encoder, "encode_images")) return std::make_shared<PythonEncoder>(encoder);
  if (is_path(encoder)) {
    const std::string spec = to_path(encoder, "encoder").string();
    const WithoutGil release;
    return shared_encoder(make_image_text_encoder(spec, {}));
  }
  throw nb::type_error(
      "encoder must be None, the name of a model or folder, an ImageTextEncoder, or an object with "
      "name, dimension and encode_images");
}

void bind_encoders(nb::module_& module) {
  nb::class_<ImageTextEncoder>(module, "ImageTextEncoder",
                               "Puts images and texts into one space, where what belongs together "
                               "is near (cosine).")
      .def_prop_ro("name", [](const ImageTextEncoder& e) { return e.identity().name; })
      .def_prop_ro(
          "dimension", [](const ImageTextEncoder& e) { return e.identity().dimension; },
          "numbers in an embedding")
      .def_prop_ro(
          "digest", [](const ImageTextEncoder& e) { return e.identity().digest; },
          "SHA-256 over the model's files")
      .def("encode_images", &encode_images, nb::arg("images"),
           nb::sig("def encode_images(self, images: typing.Sequence[typing.Any]) -> "
                   "numpy.typing.NDArray[numpy.float32]"),
           "Images uint8 [height, width, 3] of any size -> float32 [images, dimension], rows of "
           "length 1.")
      .def("encode_texts", &encode_texts, nb::arg("texts"),
           "Texts -> float32 [texts, dimension], rows of length 1.");
  module.def(
      "make_encoder",
      [](const std::string& spec, const nb::object& model_dirs, int threads) {
        const auto folders = to_paths(model_dirs, "model_dirs");
        RuntimeConfig runtime;
        runtime.threads = threads;
        const WithoutGil release;
        return shared_encoder(make_image_text_encoder(spec, runtime, folders));
      },
      nb::arg("spec") = "default", nb::kw_only(), nb::arg("model_dirs") = nb::list(),
      nb::arg("threads") = 0,
      nb::sig("def make_encoder(spec: str = 'default', *, model_dirs: typing.Sequence[str | "
              "os.PathLike[str]] = (), threads: int = 0) -> ImageTextEncoder | None"),
      "The encoder that spec names: \"default\", a model folder, a model on the search path, or "
      "\"none\" (None). Raises Error when there is no such thing.");
}

}  // namespace ovimap::python
