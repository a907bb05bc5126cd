// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/hub/trial/self_test.h"

#include <cmath>

#include "ovimap/base/error.h"
#include "ovimap/hub/trial/drawings.h"
#include "ovimap/inference/encoders/dual_encoder.h"
#include "ovimap/inference/sam/sam_network.h"

namespace ovimap {

namespace fs = std::filesystem;

namespace {

constexpr float kSameCosine = 0.9999f;  // of an item alone and among others
// Random networks tell one colour of eight and one shape of four right.
constexpr int kFewestColours = 6, kFewestShapes = 2;
constexpr float kFewestIou = 0.7f;  // of the disc and the mask that a point in it gives

void require_finite(const Embeddings& rows, const char* what) {
  for (Eigen::Index i = 0; i < rows.rows(); ++i)
    if (!(rows.row(i).squaredNorm() > 0))
      throw Error(concat("self-test: an embedding of ", what,
                         " is not finite or zero; fetch the "
                         "model again, or another variant"));
}

float least_cosine(const Embeddings& a, const Embeddings& b) {
  return a.cwiseProduct(b).rowwise().sum().minCoeff();
}

std::vector<RgbImage> pictures_of(const std::vector<Drawing>& drawings) {
  std::vector<RgbImage> pictures;
  for (const Drawing& drawing : drawings) pictures.push_back(drawing.picture);
  return pictures;
}

std::vector<std::string> texts_of(const std::vector<Drawing>& drawings, const std::string& before) {
  std::vector<std::string> texts;
  for (const Drawing& drawing : drawings) texts.push_back(before + drawing.name);
  return texts;
}

/// How many pictures are nearest to their own name. Texts that all pictures are near to, and
/// pictures that all texts are near to, are set right first.
int told_right(const Embeddings& images, const Embeddings& texts) {
  Eigen::MatrixXf scores = images * texts.transpose();
  scores.rowwise() -= scores.colwise().mean().eval();
  int right = 0;
  for (Eigen::Index i = 0; i < scores.rows(); ++i) {
    Eigen::Index best = 0;
    scores.row(i).maxCoeff(&best);
    right += best == i;
  }
  return right;
}

/// The items one by one.
template <class Items, class Encode>
Embeddings alone(const Items& items, const Embeddings& like, const Encode& encode) {
  Embeddings rows(like.rows(), like.cols());
  for (std::size_t i = 0; i < items.size(); ++i)
    rows.row(static_cast<Eigen::Index>(i)) = encode(std::span(items).subspan(i, 1)).row(0);
  return rows;
}

struct Told {
  int right = 0;
  bool batch_agrees = true;
};

Told tell(DualEncoder& encoder, const std::vector<Drawing>& drawings, const std::string& before) {
  const std::vector<RgbImage> pictures = pictures_of(drawings);
  const std::vector<std::string> texts = texts_of(drawings, before);
  const auto images = [&](auto items) { return encoder.encode_images(items); };
  const auto words = [&](auto items) { return encoder.encode_texts(items); };
  const Embeddings of_images = images(std::span<const RgbImage>(pictures)),
                   of_texts = words(std::span<const std::string>(texts));
  require_finite(of_images, "an image");
  require_finite(of_texts, "a text");
  const Embeddings images_alone = alone(pictures, of_images, images),
                   texts_alone = alone(texts, of_texts, words);
  const bool agrees = least_cosine(of_images, images_alone) > kSameCosine &&
                      least_cosine(of_texts, texts_alone) > kSameCosine;
  return {told_right(images_alone, texts_alone), agrees};
}

SelfTest test_encoder(const ModelFolder& model) {
  DualEncoder encoder(model, {});
  const std::vector<Drawing> colours = drawn_colours(), shapes = drawn_shapes();
  const Told colour = tell(encoder, colours, "the colour "), shape = tell(encoder, shapes, "a ");
  SelfTest test;
  test.batch_agrees = colour.batch_agrees && shape.batch_agrees;
  test.right = colour.right + shape.right;
  test.asked = static_cast<int>(colours.size() + shapes.size());
  test.summary =
      concat(encoder.identity().dimension, " numbers; ", colour.right, " of ", colours.size(),
             " plain colours and ", shape.right, " of ", shapes.size(), " drawn shapes told right",
             test.batch_agrees ? ""
                               : "; several at once differ from one alone, so it "
                                 "runs one by one");
  if (colour.right < kFewestColours || shape.right < kFewestShapes)
    test.warnings.push_back(concat("of drawn colours and shapes it tells ", colour.right, " of ",
                                   colours.size(), " and ", shape.right, " of ", shapes.size(),
                                   " right, fewer than ", kFewestColours, " and ", kFewestShapes,
                                   ": its words will be wrong; another variant may do"));
  return test;
}

float iou_with_disc(const MaskProposals& proposals, int token, const InputFrame& frame,
                    const RgbImage& picture, float input_per_grid) {
  const RgbImage background(1, 1, picture.at(0, 0));
  const auto is_disc = [&](int x, int y) { return !(picture.at(x, y) == background.at(0, 0)); };
  int both = 0, either = 0;
  const std::size_t start =
      static_cast<std::size_t>(token) * proposals.grid_size * proposals.grid_size;
  for (int y = 0; y < picture.height(); ++y)
    for (int x = 0; x < picture.width(); ++x) {
      const auto at = [&](int pixel, float scale) {
        return static_cast<std::size_t>((static_cast<float>(pixel) + 0.5f) * scale /
                                        input_per_grid);
      };
      const std::size_t cell =
          at(y, frame.scale.y()) * proposals.grid_size + at(x, frame.scale.x());
      const bool masked = proposals.logits[start + cell] > 0, disc = is_disc(x, y);
      both += masked && disc;
      either += masked || disc;
    }
  return either > 0 ? static_cast<float>(both) / static_cast<float>(either) : 0.f;
}

SelfTest test_sam(const ModelFolder& model) {
  constexpr int kWidth = 320, kHeight = 240, kRadius = 60;
  const SamNetwork network(model, {});
  const RgbImage picture = drawn_disc(kWidth, kHeight, kRadius);
  const ImageFeatures features = network.encode(picture);
  const PromptPoints prompt = {{{kWidth / 2.f, kHeight / 2.f}, PointLabel::kForeground},
                               {{0, 0}, PointLabel::kPadding}};
  const MaskProposals proposals = network.decode(features, {&prompt, 1}).front();
  for (const float logit : proposals.logits)
    if (!std::isfinite(logit)) throw Error("self-test: a mask is not finite; take another variant");
  const float input_per_grid =
      static_cast<float>(network.input_size_px()) / static_cast<float>(network.grid_size());
  float best = 0;
  for (int token = 0; token < proposals.tokens; ++token)
    best = std::max(best, iou_with_disc(proposals, token, features.frame, picture, input_per_grid));
  SelfTest test;
  test.asked = 1;
  test.right = best >= kFewestIou;
  test.summary =
      concat("a point in a drawn disc gives a mask with IoU ", std::round(best * 100) / 100);
  if (!test.right)
    test.warnings.push_back(concat("the mask of a drawn disc has IoU ",
                                   std::round(best * 100) / 100, ", less than ", kFewestIou,
                                   ": its masks will be wrong; another variant may do"));
  return test;
}

}  // namespace

SelfTest self_test(const fs::path& folder) {
  const ModelFolder model = read_model_folder(folder);
  return model.kind == "sam" ? test_sam(model) : test_encoder(model);
}

}  // namespace ovimap
