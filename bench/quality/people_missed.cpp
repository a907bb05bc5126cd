// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
//
// How many people a detector misses in photographs: of each person's box, drawn by hand, it tells
// how much the found boxes cover. One that they cover by less than four fifths is missed.
//   ovimap_people_missed PHOTOS LIST [MIN_SCORE [DETECTOR]]
// LIST: a line "FILE POSE LEFT TOP RIGHT BOTTOM" for each person (people_photos.txt says where the
// files are had), or "FILE nobody".
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "ovimap/image/codec.h"
#include "ovimap/inference/things/person_finder.h"
#include "ovimap/pipeline/people/people_config.h"

namespace {

using namespace ovimap;

constexpr double kCovered = 0.8;

struct Somebody {
  std::string pose;
  Eigen::AlignedBox2i box;
};

std::map<std::string, std::vector<Somebody>> read_list(const std::string& file) {
  std::map<std::string, std::vector<Somebody>> photos;
  std::ifstream stream(file);
  for (std::string line; std::getline(stream, line);) {
    std::istringstream words(line.substr(0, line.find('#')));
    std::string photo, pose;
    int left = 0, top = 0, right = 0, bottom = 0;
    if (!(words >> photo >> pose)) continue;
    auto& people = photos[photo];
    if (words >> left >> top >> right >> bottom)
      people.push_back({pose, {Eigen::Vector2i(left, top), Eigen::Vector2i(right, bottom)}});
  }
  return photos;
}

double covered(const Eigen::AlignedBox2i& box, const std::vector<PersonBox>& found) {
  int inside = 0, all = 0;
  for (int y = box.min().y(); y < box.max().y(); ++y)
    for (int x = box.min().x(); x < box.max().x(); ++x, ++all)
      for (const PersonBox& person : found)
        if (person.in_image_px.contains(
                Eigen::Vector2f(static_cast<float>(x), static_cast<float>(y)))) {
          ++inside;
          break;
        }
  return static_cast<double>(inside) / all;
}

void measure(const std::string& folder, const std::string& list, float min_score,
             const std::string& detector) {
  const auto finder = make_person_finder(detector, {});
  std::map<std::string, std::pair<int, int>> missed;  // by pose, of how many
  int without = 0, taken_for_people = 0;
  for (const auto& [photo, people] : read_list(list)) {
    const auto found = finder->find(read_rgb(std::filesystem::path(folder) / photo), min_score);
    std::printf("%-28s", photo.c_str());
    for (const Somebody& person : people) {
      const double share = covered(person.box, found);
      std::printf(" %s %.2f", person.pose.c_str(), share);
      ++missed[person.pose].second;
      missed[person.pose].first += share < kCovered;
    }
    if (people.empty()) {
      std::printf(" nobody, found %zu", found.size());
      ++without, taken_for_people += !found.empty();
    }
    std::printf("\n");
  }
  for (const auto& [pose, count] : missed)
    std::printf("%s: missed %d of %d\n", pose.c_str(), count.first, count.second);
  std::printf("photographs of nobody in which somebody was found: %d of %d\n", taken_for_people,
              without);
}

}  // namespace

int main(int count, char** arguments) {
  if (count < 3) {
    std::fprintf(stderr, "usage: ovimap_people_missed PHOTOS LIST [MIN_SCORE [DETECTOR]]\n");
    return 2;
  }
  try {
    const ovimap::PeopleConfig config;
    measure(arguments[1], arguments[2],
            count > 3 ? std::strtof(arguments[3], nullptr) : config.min_score,
            count > 4 ? arguments[4] : config.detector);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
}
