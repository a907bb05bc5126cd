// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/inference/things/thing_recognizer.h"

#include <sstream>

#include "ovimap/inference/things/thing_detector.h"

namespace ovimap {

namespace {

using Detectors = std::vector<ThingDetector>;

/// What several detectors say, one after the other.
class FoundThings : public ThingsInPicture {
 public:
  FoundThings(std::shared_ptr<const Detectors> detectors, const RgbImage& picture)
      : detectors_(std::move(detectors)) {
    for (const ThingDetector& detector : *detectors_) found_.push_back(detector.find(picture));
  }

  Eigen::VectorXf log_ratios(const Eigen::AlignedBox2f& box) const override {
    std::vector<float> all;
    for (std::size_t i = 0; i < found_.size(); ++i) {
      const Eigen::VectorXf ratios = (*detectors_)[i].log_ratios(found_[i], box);
      all.insert(all.end(), ratios.begin(), ratios.end());
    }
    return Eigen::Map<const Eigen::VectorXf>(all.data(), static_cast<Eigen::Index>(all.size()));
  }

 private:
  std::shared_ptr<const Detectors> detectors_;
  std::vector<ThingDetector::Found> found_;
};

class DetectorRecognizer : public ThingRecognizer {
 public:
  explicit DetectorRecognizer(Detectors detectors)
      : detectors_(std::make_shared<const Detectors>(std::move(detectors))) {
    for (const ThingDetector& detector : *detectors_) {
      identity_.name += (identity_.name.empty() ? "" : ", ") + detector.name();
      identity_.things.insert(identity_.things.end(), detector.things().begin(),
                              detector.things().end());
    }
  }
  const RecognizerIdentity& identity() const override { return identity_; }
  std::unique_ptr<const ThingsInPicture> look(const RgbImage& picture) const override {
    return std::make_unique<const FoundThings>(detectors_, picture);
  }

 private:
  std::shared_ptr<const Detectors> detectors_;
  RecognizerIdentity identity_;
};

std::vector<std::filesystem::path> folders_of(const std::string& spec,
                                              const std::vector<std::filesystem::path>& path) {
  std::vector<std::filesystem::path> folders;
  if (spec == "auto") {
    for (const ModelListing& listing : list_models(path))
      if (listing.kind == "detector") folders.push_back(listing.folder);
    return folders;
  }
  std::istringstream names(spec);
  for (std::string name; std::getline(names, name, ',');)
    folders.push_back(named_model(name, path));
  return folders;
}

}  // namespace

std::unique_ptr<ThingRecognizer> make_thing_recognizer(
    const std::string& spec, const RuntimeConfig& runtime,
    const std::vector<std::filesystem::path>& model_dirs) {
  if (spec == "none") return nullptr;
  Detectors detectors;
  for (const std::filesystem::path& folder : folders_of(spec, model_search_path(model_dirs)))
    detectors.emplace_back(read_model_folder(folder), runtime);
  if (detectors.empty()) return nullptr;
  return std::make_unique<DetectorRecognizer>(std::move(detectors));
}

}  // namespace ovimap
