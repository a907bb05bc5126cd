// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/report/map_report.h"

#include <limits>

#include <gtest/gtest.h>

#include "ovimap/pipeline/report/html_text.h"

namespace ovimap {
namespace {

InstanceSummary instance(InstanceId id, std::size_t points) {
  InstanceSummary summary;
  summary.id = id;
  summary.super_points = {id};
  summary.points = points;
  summary.views = 3;
  summary.centroid = {1.f, -2.5f, 0.25f};
  summary.box = {Eigen::Vector3f(0, -3, 0), Eigen::Vector3f(2, -2, 0.5f)};
  return summary;
}

ObjectView view(std::int64_t frame, int visible_px, Bytes jpeg) {
  ObjectView result;
  result.frame = frame;
  result.visible_px = visible_px;
  result.embedding = Eigen::Vector2f(0, 1);
  result.crop.image_jpeg = std::move(jpeg);
  return result;
}

/// Three objects: 2 is the largest and has crops, 5 has a given name, 9 was hardly seen.
MapRecord small_map() {
  MapRecord map;
  map.instances = {instance(2, 4000), instance(5, 700), instance(9, 700)};
  map.names[5] = "<b>tea & pot</b>";
  map.semantics.encoder = {"enc<1>", 2, ""};
  SuperPointLook& look = map.semantics.looks[2];
  look.queries = 6;
  look.views = {view(10, 50, {0xFF, 1}), view(20, 90, {0xFF, 2}), view(30, 70, {0xFF, 3}),
                view(40, 99, {})};
  map.frames.resize(12);
  map.mask_frames = 4;
  map.source = "folder:/data/\"x\"";
  map.version = "0.1.0 (abc)";
  map.config_text = "a.b: 1\nrun.masks: <none>\n";
  map.timings = "integrate 12.500 40.000 12\nfuse_masks 3.000 4.000 12\n";
  return map;
}

MapReport small_report() {
  MapReport report;
  report.title = "kitchen <1>";
  report.voxel_size_m = 0.01f;
  report.instances_picture = {0x89, 1};
  report.colors_picture = {0xFF, 9};
  return report;
}

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (std::size_t at = 0; (at = text.find(part, at)) != std::string::npos; at += part.size())
    ++found;
  return found;
}

std::size_t place(const std::string& text, const std::string& part) {
  const std::size_t at = text.find(part);
  EXPECT_NE(at, std::string::npos) << part;
  return at;
}

TEST(MapReport, EscapesEveryText) {
  MapReport report = small_report();
  report.names = {"set<2>", {{2, {{"cup</li>", 0.31f}}}}};
  const std::string html = map_report_html(small_map(), report);
  for (const char* raw :
       {"kitchen <1>", "<b>tea", "enc<1>", "/data/\"x\"", "<none>", "set<2>", "cup</li>"})
    EXPECT_EQ(count(html, raw), 0u) << raw;
  for (const char* escaped :
       {"kitchen &lt;1&gt;", "&lt;b&gt;tea &amp; pot&lt;/b&gt;", "enc&lt;1&gt;",
        "/data/&quot;x&quot;", "&lt;none&gt;", "set&lt;2&gt;", "cup&lt;/li&gt;"})
    EXPECT_GE(count(html, escaped), 1u) << escaped;
  report.names.reset();
  report.why_no_names = "no <encoder>";
  EXPECT_EQ(count(map_report_html(small_map(), report), "no &lt;encoder&gt;"), 1u);
}

TEST(MapReport, NeedsNothingFromOutside) {
  const std::string html = map_report_html(small_map(), small_report());
  EXPECT_EQ(count(html, "<script"), 0u);
  EXPECT_EQ(count(html, "http:") + count(html, "https:") + count(html, "url("), 0u);
  EXPECT_EQ(count(html, " src=\""), count(html, " src=\"data:image/"));
  EXPECT_EQ(count(html, "<img"), count(html, "alt=\""));
  EXPECT_EQ(html.rfind("<!DOCTYPE html>", 0), 0u);
}

TEST(MapReport, ShowsEveryObjectLargestFirst) {
  const std::string html = map_report_html(small_map(), small_report());
  EXPECT_EQ(count(html, "<article"), 3u);
  EXPECT_LT(place(html, "id=\"object-2\""), place(html, "id=\"object-5\""));
  EXPECT_LT(place(html, "id=\"object-5\""), place(html, "id=\"object-9\""));
  const std::string card = html.substr(place(html, "id=\"object-2\""));
  for (const char* text : {"1.00, -2.50, 0.25 m", "2.00 &times; 1.00 &times; 0.50 m", "4,000",
                           "<dd>3</dd>", "<dd>6</dd>"})
    EXPECT_LT(place(card, text), place(card, "</article>")) << text;
}

TEST(MapReport, ShowsTheLargestCropsFirst) {
  const std::string html = map_report_html(small_map(), small_report(), {2});
  const auto crop = [](std::uint8_t last) { return picture_uri(Bytes{0xFF, last}); };
  EXPECT_LT(place(html, crop(2)), place(html, crop(3)));
  EXPECT_EQ(count(html, crop(1)), 0u);
  EXPECT_EQ(count(html, "alt=\"Object 2 in frame 20\""), 1u);
  EXPECT_EQ(count(html, "class=\"none\""), 2u);  // objects 5 and 9
}

TEST(MapReport, ShowsPicturesFromAboveWhenThereAreSome) {
  MapReport report = small_report();
  const std::string html = map_report_html(small_map(), report);
  EXPECT_EQ(count(html, picture_uri(report.instances_picture)), 1u);
  EXPECT_EQ(count(html, picture_uri(report.colors_picture)), 1u);
  report.instances_picture.clear(), report.colors_picture.clear();
  EXPECT_EQ(count(map_report_html(small_map(), report), "From above"), 0u);
}

TEST(MapReport, ShowsNamesWithScoresAndWhoHasNone) {
  MapReport report = small_report();
  report.names = {"scannet200", {{2, {{"cup", 0.314f}, {"bowl", 0.2f}}}}};
  const std::string html = map_report_html(small_map(), report);
  EXPECT_LT(place(html, "<span>cup</span> <span class=\"score\">0.31</span>"),
            place(html, "<span>bowl</span> <span class=\"score\">0.20</span>"));
  EXPECT_EQ(count(html, "No embedding, so no name"), 2u);
  EXPECT_EQ(count(html, "No names are guessed"), 0u);
}

TEST(MapReport, SaysWhyThereAreNoNames) {
  MapRecord map = small_map();
  MapReport report = small_report();
  EXPECT_EQ(count(map_report_html(map, report), "they were not asked for"), 1u);
  for (ObjectView& known : map.semantics.looks[2].views) known.embedding.resize(0);
  EXPECT_EQ(count(map_report_html(map, report), "no embeddings. <code>ovimap reembed"), 1u);
  map.semantics = {};
  const std::string html = map_report_html(map, report);
  EXPECT_EQ(count(html, "no embeddings. Mapping with 2D masks"), 1u);
  EXPECT_EQ(count(html, "class=\"none\"") + count(html, "class=\"crops\""), 0u);
  EXPECT_EQ(count(html, "<article"), 3u);
}

TEST(MapReport, ShowsTimingsAndSettingsWhenThereAreSome) {
  MapRecord map = small_map();
  std::string html = map_report_html(map, small_report());
  EXPECT_LT(place(html, "<th scope=\"row\">integrate</th><td>12.50</td><td>40.00</td><td>12</td>"),
            place(html, "<th scope=\"row\">fuse masks</th>"));
  EXPECT_EQ(count(html, "width:24.0%"), 1u);
  EXPECT_EQ(count(html, "<details"), 1u);
  map.timings = map.config_text = "";
  html = map_report_html(map, small_report());
  EXPECT_EQ(count(html, "<table") + count(html, "<details"), 0u);
}

TEST(MapReport, BearsAnEmptyMapAndNumbersThatAreNone) {
  EXPECT_EQ(count(map_report_html({}, {}), "The map has none"), 1u);
  MapRecord map;
  map.instances = {instance(1, 0)};
  map.instances[0].centroid.setConstant(std::numeric_limits<float>::quiet_NaN());
  map.instances[0].box.setEmpty();
  const std::string html = map_report_html(map, {});
  EXPECT_EQ(count(html, "nan") + count(html, "inf"), 0u);
}

}  // namespace
}  // namespace ovimap
