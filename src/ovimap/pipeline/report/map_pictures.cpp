// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/report/map_pictures.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "ovimap/base/error.h"
#include "ovimap/image/codec.h"
#include "ovimap/io/mesh/map_mesh.h"
#include "ovimap/map/rays/ray_cast.h"

namespace ovimap {

namespace {

constexpr int kSheetFrames = 12;
constexpr float kSheetRange_m = 10.f;

/// Instance ids of the map in the frame's colour image: looked up through depth where there is
/// some.
IdImage project_instances(const MapDocument& document, const Frame& frame,
                          const std::vector<InstanceId>& instance_of) {
  const Pose world_from_color = frame.world_from_camera * frame.color_from_depth.inverse();
  const Projection seen =
      cast_rays(document.map, frame.color_camera, world_from_color, kSheetRange_m);
  IdImage ids(frame.color.width(), frame.color.height());
  for (std::size_t i = 0; i < ids.size(); ++i)  // the sheet's colours repeat after 65535 objects
    ids[i] = static_cast<std::uint16_t>(instance_of[seen.labels[i]]);
  return ids;
}

}  // namespace

TopDownPictures top_down_pictures(const MapDocument& document) {
  constexpr MeshColoring kBoth[] = {MeshColoring::kInstances, MeshColoring::kColors};
  std::vector<RgbImage> pictures = top_down(
      [&](const auto& visit) { for_each_visible_part(document, visit); }, document.up, kBoth);
  return {std::move(pictures[0]), std::move(pictures[1])};
}

RgbImage contact_sheet_picture(const MapDocument& document, const FrameSource& source, int frames) {
  std::vector<InstanceId> instance_of(document.map.labels().roots().size(), 0);
  for (const InstanceSummary& instance : document.instances)
    for (Label root : instance.super_points) instance_of[root] = instance.id;
  std::vector<SheetFrame> sheet;
  const MapVisit visit =  // the source is of the last
      document.history.visits.empty() ? MapVisit() : document.history.visits.back();
  const auto first = static_cast<std::size_t>(visit.first_frame);
  const std::size_t of_visit = document.frames.size() - first;
  const auto count =
      static_cast<int>(std::min<std::size_t>(static_cast<std::size_t>(frames), of_visit));
  for (int i = 0; i < count; ++i) {
    const std::size_t entry = first + (2 * static_cast<std::size_t>(i) + 1) * of_visit /
                                          (2 * static_cast<std::size_t>(count));
    FrameRead read = source.read(document.frames[entry].index - visit.first_index);
    if (read.frame)
      sheet.push_back({read.frame->color, project_instances(document, *read.frame, instance_of)});
  }
  SheetConfig config;
  config.columns = 2;
  return contact_sheet(sheet, config);
}

void make_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw Error(concat("folder ", folder.string(), " cannot be made: ", error.message()));
}

void write_map_pictures(const std::filesystem::path& folder, const MapDocument& document,
                        const FrameSource& source) {
  make_folder(folder);
  const TopDownPictures above = top_down_pictures(document);
  write_file(folder / "top_view.png", encode_png(above.instances));
  write_file(folder / "top_view_color.png", encode_png(above.colors));
  write_file(folder / "contact_sheet.png",
             encode_png(contact_sheet_picture(document, source, kSheetFrames)));
}

}  // namespace ovimap
