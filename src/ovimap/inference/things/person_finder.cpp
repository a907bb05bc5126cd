// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/inference/things/person_finder.h"

#include <algorithm>
#include <sstream>

#include "ovimap/base/error.h"
#include "ovimap/geometry/box_overlap.h"

namespace ovimap {

namespace {

constexpr const char* kPerson = "person";
constexpr float kSamePerson = 0.5f;  // overlap of two boxes of one
constexpr float kSquare = 0.15f;     // a picture whose sides differ by less of the shorter is one

/// Whether one of the words (a|b|c) says it.
bool says_person(const std::string& words) {
  std::istringstream stream(words);
  for (std::string word; std::getline(stream, word, '|');)
    if (word == kPerson) return true;
  return false;
}

Eigen::AlignedBox2f box_in(const RgbImage& picture, const Eigen::Vector4f& shares) {
  const auto at = [](float share, int side) {
    return std::clamp(share, 0.f, 1.f) * static_cast<float>(side) - 0.5f;
  };
  return {Eigen::Vector2f(at(shares[0], picture.width()), at(shares[1], picture.height())),
          Eigen::Vector2f(at(shares[2], picture.width()), at(shares[3], picture.height()))};
}

RgbImage square_of(const RgbImage& picture, const Eigen::Vector2i& corner, int side) {
  RgbImage square(side, side);
  for (int y = 0; y < side; ++y)
    std::copy_n(picture.row(corner.y() + y) + corner.x(), side, square.row(y));
  return square;
}

}  // namespace

PersonFinder::PersonFinder(const ModelFolder& model, const RuntimeConfig& runtime)
    : detector_(model, runtime) {
  const auto& things = detector_.things();
  const auto found = std::find_if(things.begin(), things.end(), says_person);
  if (found == things.end())
    throw Error(concat("model ", model.folder.string(), " knows no thing called '", kPerson,
                       "', so it finds no people"));
  person_ = found - things.begin();
}

void PersonFinder::look(const RgbImage& part, const Eigen::Vector2i& corner, float min_score,
                        std::vector<PersonBox>& people) const {
  const ThingDetector::Found found = detector_.find(part);
  for (Eigen::Index row = 0; row < found.boxes.rows(); ++row) {
    const float score = found.scores(row, person_);
    if (score < min_score) continue;
    Eigen::AlignedBox2f box = box_in(part, found.boxes.row(row).transpose());
    box.translate(corner.cast<float>());
    if (!box.isEmpty()) people.push_back({box, score});
  }
}

std::vector<PersonBox> PersonFinder::find(const RgbImage& picture, float min_score) const {
  std::vector<PersonBox> all, surest, whole;
  look(picture, {0, 0}, min_score, all);
  const int side = std::min(picture.width(), picture.height());
  const Eigen::Vector2i far(picture.width() - side, picture.height() - side);
  if (static_cast<float>(far.maxCoeff()) > kSquare * static_cast<float>(side))
    for (const Eigen::Vector2i& corner : {Eigen::Vector2i(0, 0), far})
      look(square_of(picture, corner, side), corner, min_score, all);
  std::stable_sort(all.begin(), all.end(),
                   [](const PersonBox& a, const PersonBox& b) { return a.score > b.score; });
  for (const PersonBox& person : all) {
    const auto same = std::find_if(surest.begin(), surest.end(), [&](const PersonBox& other) {
      return overlap(person.in_image_px, other.in_image_px) > kSamePerson;
    });
    if (same == surest.end())
      surest.push_back(person), whole.push_back(person);
    else
      whole[static_cast<std::size_t>(same - surest.begin())].in_image_px.extend(person.in_image_px);
  }
  return whole;
}

std::unique_ptr<PersonFinder> make_person_finder(
    const std::string& detector, const RuntimeConfig& runtime,
    const std::vector<std::filesystem::path>& model_dirs) {
  const auto search_path = model_search_path(model_dirs);
  const std::vector<ModelListing> models = list_models(search_path);
  const bool folder =
      std::filesystem::is_regular_file(std::filesystem::path(detector) / "model.yaml");
  if (!folder && std::none_of(models.begin(), models.end(),
                              [&](const ModelListing& model) { return model.name == detector; }))
    throw Error(
        concat("people are found by the detector '", detector,
               "', which is not installed; run `ovimap models fetch default` (in a checkout: "
               "tools/setup.sh), or name another by --set people.detector=NAME"));
  return std::make_unique<PersonFinder>(read_model_folder(named_model(detector, search_path)),
                                        runtime);
}

}  // namespace ovimap
