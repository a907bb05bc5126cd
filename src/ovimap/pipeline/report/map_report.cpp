// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/report/map_report.h"

#include <algorithm>
#include <cstdio>

#include "ovimap/base/error.h"
#include "ovimap/io/pictures/palette.h"
#include "ovimap/pipeline/report/html_text.h"
#include "ovimap/pipeline/report/map_report_style.h"
#include "ovimap/pipeline/revise/percent_text.h"
#include "ovimap/pipeline/sequence/timings_text.h"

namespace ovimap {

namespace {

/// "<div><dt>term</dt><dd>value</dd></div>"; `value` is HTML.
std::string fact(const std::string& term, const std::string& value) {
  return concat("<div><dt>", term, "</dt><dd>", value, "</dd></div>\n");
}

std::string plural(std::size_t count, const std::string& thing) {
  return concat(grouped_number(count), " ", thing, count == 1 ? "" : "s");
}

std::string given_name(const MapRecord& map, InstanceId id) {
  const auto found = map.names.find(id);
  return found == map.names.end() ? std::string() : found->second;
}

/// "Object 12" or, with a name, "Object 12 (mug)", as HTML.
std::string spoken_name(const MapRecord& map, InstanceId id) {
  const std::string name = given_name(map, id);
  return concat("Object ", std::to_string(id), name.empty() ? "" : " (" + escape_html(name) + ")");
}

/// Images and styles may come from the page alone: a browser that opens a report asks no one.
std::string head(const MapReport& report) {
  return concat(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n",
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; img-src data:; ",
      "style-src 'unsafe-inline'\">\n",
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n",
      "<meta name=\"color-scheme\" content=\"light dark\">\n<link rel=\"icon\" href=\"data:,\">\n",
      "<title>", escape_html(report.title), " &ndash; ovimap report</title>\n<style>",
      kMapReportStyle, "</style>\n</head>\n");
}

std::string page_header(const MapRecord& map, const MapReport& report) {
  constexpr double kMillimetres = 1000;
  const std::string& encoder = map.semantics.encoder.name;
  return concat(
      "<header>\n<h1>", escape_html(report.title), "</h1>\n<dl class=\"tiles\">\n",
      fact("objects", grouped_number(map.instances.size())),
      fact("frames", grouped_number(map.frames.size())),
      fact("frames with 2D masks", grouped_number(static_cast<std::size_t>(map.mask_frames))),
      fact("voxel size", fixed_number(kMillimetres * double{report.voxel_size_m}, 1) + "&nbsp;mm"),
      "</dl>\n<dl class=\"facts\">\n",
      fact("Encoder", encoder.empty() ? "none" : escape_html(encoder)),
      fact("Recording", map.source.empty() ? "not known" : escape_html(map.source)),
      fact("Mapped by", "ovimap " + escape_html(map.version)), "</dl>\n</header>\n");
}

std::string figure(const Bytes& picture, const std::string& alt, const std::string& caption) {
  if (picture.empty()) return {};
  return concat("<figure><img src=\"", picture_uri(picture), "\" alt=\"", alt, "\"><figcaption>",
                caption, "</figcaption></figure>\n");
}

std::string overview(const MapRecord& map, const MapReport& report) {
  if (report.instances_picture.empty() && report.colors_picture.empty()) return {};
  return concat(
      "<section id=\"overview\">\n<h2>From above</h2>\n<div class=\"views\">\n",
      figure(report.instances_picture,
             concat("The map from above, each of its ", plural(map.instances.size(), "object"),
                    " in a colour of its own"),
             "A colour per object, the same as on its card below; grey belongs to no object."),
      figure(report.colors_picture, "The map from above in its true colours", "True colours."),
      "</div>\n</section>\n");
}

bool has_crops(const MapRecord& map) {
  const SuperPointLooks& looks = map.semantics.looks;
  return std::any_of(looks.begin(), looks.end(), [](const auto& look) {
    return std::any_of(look.second.views.begin(), look.second.views.end(),
                       [](const ObjectView& view) { return !view.crop.empty(); });
  });
}

/// Why there are names or none, and how to read them.
std::string names_note(const MapRecord& map, const MapReport& report) {
  if (report.names)
    return concat("Names are guesses: those of the set ", escape_html(report.names->class_set),
                  " that fit an object best, with the cosine of the object's and the name's "
                  "embedding. Compare scores within one object.");
  if (has_embeddings(map))
    return "No names are guessed: " + (report.why_no_names.empty()
                                           ? "they were not asked for."
                                           : escape_html(report.why_no_names));
  if (has_crops(map))
    return "No names are guessed: this map has no embeddings. <code>ovimap reembed</code> makes "
           "them from the pictures below.";
  return "No names are guessed: this map has no embeddings. Mapping with 2D masks and an encoder "
         "gives it some.";
}

std::vector<const ObjectView*> best_crops(const MapRecord& map, InstanceId id, int count) {
  std::vector<const ObjectView*> views;
  for (const ObjectView* view : appearance_of(map, id).views)
    if (!view->crop.empty()) views.push_back(view);
  std::stable_sort(views.begin(), views.end(), [](const ObjectView* a, const ObjectView* b) {
    return a->visible_px > b->visible_px;
  });
  views.resize(std::min(views.size(), static_cast<std::size_t>(std::max(count, 0))));
  return views;
}

std::string crops(const MapRecord& map, InstanceId id, const MapReportConfig& config) {
  if (!has_crops(map)) return {};
  std::string images;
  for (const ObjectView* view : best_crops(map, id, config.crops))
    images +=
        concat("<img loading=\"lazy\" src=\"", picture_uri(view->crop.image_jpeg), "\" alt=\"",
               spoken_name(map, id), " in frame ", std::to_string(view->frame), "\">\n");
  if (images.empty()) return "<p class=\"none\">No view of it was good enough to keep.</p>\n";
  return "<div class=\"crops\">\n" + images + "</div>\n";
}

std::string guesses(const MapReport& report, InstanceId id) {
  if (!report.names) return {};
  const auto found = report.names->guesses.find(id);
  if (found == report.names->guesses.end())
    return "<p class=\"muted\">No embedding, so no name.</p>\n";
  std::string items;
  for (const NameGuess& guess : found->second)
    items += concat("<li><span>", escape_html(guess.name), "</span> <span class=\"score\">",
                    fixed_number(double{guess.cosine}, 2), "</span></li>\n");
  return "<ol class=\"guesses\" aria-label=\"Best names\">\n" + items + "</ol>\n";
}

/// "1.20 &times; 0.40 &times; 0.75" or, as a place, "1.20, 0.40, 0.75".
std::string triple(const Eigen::Vector3f& v, const std::string& separator) {
  return concat(fixed_number(double{v.x()}, 2), separator, fixed_number(double{v.y()}, 2),
                separator, fixed_number(double{v.z()}, 2));
}

std::string facts(const MapRecord& map, const InstanceSummary& instance) {
  const Eigen::Vector3f sizes = instance.box.isEmpty() ? Eigen::Vector3f::Constant(std::nanf(""))
                                                       : Eigen::Vector3f(instance.box.sizes());
  const Appearance look = appearance_of(map.semantics.looks, instance.super_points);
  return concat(
      "<dl class=\"facts\">\n", fact("Position", triple(instance.centroid, ", ") + " m"),
      fact("Size", triple(sizes, " &times; ") + " m"),
      fact("Points", grouped_number(instance.points)),
      fact("Views", grouped_number(static_cast<std::size_t>(instance.views))),
      instance.confidence ? fact("Whole by its masks", percent_text(*instance.confidence)) : "",
      fact("Encoder queries", grouped_number(static_cast<std::size_t>(look.queries))), "</dl>\n");
}

std::string card(const MapRecord& map, const MapReport& report, const InstanceSummary& instance,
                 const MapReportConfig& config) {
  const Rgb8 color = instance_color(instance.id);
  char hex[8];
  std::snprintf(hex, sizeof(hex), "#%02x%02x%02x", color.r, color.g, color.b);
  const std::string id = std::to_string(instance.id), name = given_name(map, instance.id);
  const std::string title = name.empty() ? "Object " + id : escape_html(name);
  return concat("<article class=\"card\" id=\"object-", id, "\" style=\"--color:", hex,
                "\">\n<h3><span class=\"swatch\"></span><span>", title, "</span>",
                name.empty() ? "" : "<span class=\"id\">object " + id + "</span>", "</h3>\n",
                crops(map, instance.id, config), guesses(report, instance.id), facts(map, instance),
                "</article>\n");
}

std::string objects(const MapRecord& map, const MapReport& report, const MapReportConfig& config) {
  std::vector<const InstanceSummary*> by_size;
  for (const InstanceSummary& instance : map.instances) by_size.push_back(&instance);
  std::sort(by_size.begin(), by_size.end(), [](const auto* a, const auto* b) {
    return a->points != b->points ? a->points > b->points : a->id < b->id;
  });
  std::string cards;
  for (const InstanceSummary* instance : by_size) cards += card(map, report, *instance, config);
  if (cards.empty())
    return "<section id=\"objects\">\n<h2>Objects</h2>\n<p>The map has none.</p>\n</section>\n";
  return concat(
      "<section id=\"objects\">\n<h2>Objects</h2>\n<p>Those with most surface come first. ",
      names_note(map, report), "</p>\n",
      "<p class=\"muted\">Position and size are along the axes x, y and z of the recording's "
      "world. Points are voxels on its surface, views are frames that showed it, encoder queries "
      "are views that were chosen to be embedded.</p>\n<div class=\"cards\">\n",
      cards, "</div>\n</section>\n");
}

std::string timing_row(const std::string& stage, const StageSummary& timing, double longest_ms) {
  std::string words = stage;
  std::replace(words.begin(), words.end(), '_', ' ');
  constexpr double kPercent = 100;
  const double share = longest_ms > 0 ? kPercent * timing.p50_ms / longest_ms : 0;
  return concat("<tr><th scope=\"row\">", escape_html(words), "</th><td>",
                fixed_number(timing.p50_ms, 2), "</td><td>", fixed_number(timing.p95_ms, 2),
                "</td><td>", grouped_number(timing.count),
                "</td><td class=\"bar\"><span style=\"width:", fixed_number(share, 1),
                "%\"></span></td></tr>\n");
}

std::string timings(const MapRecord& map) {
  const std::map<std::string, StageSummary> by_name = parse_timings(map.timings);
  if (by_name.empty()) return {};
  std::vector<std::pair<std::string, StageSummary>> stages(by_name.begin(), by_name.end());
  std::stable_sort(stages.begin(), stages.end(),
                   [](const auto& a, const auto& b) { return a.second.p50_ms > b.second.p50_ms; });
  std::string rows;
  for (const auto& [stage, timing] : stages)
    rows += timing_row(stage, timing, stages.front().second.p50_ms);
  return concat(
      "<section id=\"timings\">\n<h2>Timings</h2>\n<p>Milliseconds that each stage took when the "
      "map was made, slowest first.</p>\n<div class=\"scroll\" role=\"region\" tabindex=\"0\" "
      "aria-labelledby=\"timings-title\"><table>\n<caption id=\"timings-title\">Milliseconds per "
      "stage</caption>\n<thead><tr><th scope=\"col\">Stage</th><th scope=\"col\">Median</th>"
      "<th scope=\"col\">95th percentile</th><th scope=\"col\">Times</th><td></td></tr></thead>\n"
      "<tbody>\n",
      rows, "</tbody>\n</table></div>\n</section>\n");
}

std::string settings(const MapRecord& map) {
  if (map.config_text.empty()) return {};
  return concat(
      "<section id=\"settings\">\n<h2>Settings</h2>\n<details>\n<summary>The settings that made "
      "this map</summary>\n<pre tabindex=\"0\">",
      escape_html(map.config_text), "</pre>\n</details>\n</section>\n");
}

}  // namespace

std::string map_report_html(const MapRecord& map, const MapReport& report,
                            const MapReportConfig& config) {
  return concat(head(report), "<body>\n", page_header(map, report), "<main>\n",
                overview(map, report), objects(map, report, config), timings(map), settings(map),
                "</main>\n", "<footer>Report of an ovimap map</footer>\n</body>\n</html>\n");
}

}  // namespace ovimap
