// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "ablation.h"
#include "svg.h"

namespace ovimap::apps {

namespace {

/// Panels stand in rows of four; the scale is to the left of each, the frames below.
constexpr int kPanelsInRow = 4;
constexpr double kPanelWidth = 190, kPanelHeight = 160;
constexpr double kPanelLeft = 34, kPanelRight = 10, kPanelTop = 26, kPanelBottom = 30,
                 kLegendHeight = 24;

/// Where a panel's plot begins, and what its scale ends with.
struct Panel {
  Point corner;
  double most_frames = 1, most = 1;

  Point at(double frames, double value) const {
    return {corner.x + kPanelLeft + (kPanelWidth - kPanelLeft - kPanelRight) * frames / most_frames,
            corner.y + kPanelHeight - kPanelBottom -
                (kPanelHeight - kPanelTop - kPanelBottom) * value / most};
  }
};

std::vector<std::string> curves_of(const std::vector<AblationResult>& results) {
  std::vector<std::string> curves;
  for (const AblationResult& result : results)
    if (std::find(curves.begin(), curves.end(), result.variant.curve) == curves.end())
      curves.push_back(result.variant.curve);
  return curves;
}

std::string polyline(const Panel& panel, const AblationColumn& column,
                     const std::vector<AblationResult>& results, const std::string& curve,
                     const char* color) {
  std::string points;
  for (const AblationResult& result : results) {
    if (result.variant.curve != curve) continue;
    const Point point = panel.at(result.variant.frame_count, value_of(column, result));
    points += concat(point.x, ",", point.y, " ");
  }
  return concat("<polyline points=\"", points, "\" fill=\"none\" stroke-width=\"2\" stroke=\"",
                color, "\"/>\n");
}

/// The scale's ends, the frames' ends and the column's name.
std::string frame_of(const Panel& panel, const std::string& name) {
  const Point origin = panel.at(0, 0), end = panel.at(panel.most_frames, 0),
              top = panel.at(0, panel.most);
  std::string svg;
  for (const Point& left : {origin, top})
    svg += concat("<line x1=\"", left.x, "\" y1=\"", left.y, "\" x2=\"", end.x, "\" y2=\"", left.y,
                  "\" stroke=\"#ddd\"/>\n");
  svg += svg_text({origin.x - 4, origin.y + 4}, "0", "end");
  svg += svg_text({top.x - 4, top.y + 4}, one_decimal(panel.most), "end");
  svg += svg_text({end.x, end.y + 16}, concat(panel.most_frames, " frames"), "end");
  return svg + svg_text({0.5 * (origin.x + end.x), panel.corner.y + 14}, name);
}

}  // namespace

std::string ablation_curves(const Ablation& ablation, const std::vector<AblationResult>& results) {
  const std::vector<std::string> curves = curves_of(results);
  std::string svg;
  for (std::size_t k = 0; k < curves.size(); ++k)
    svg += concat("<g fill=\"", kSvgColors[k % kSvgColors.size()], "\">",
                  svg_text({kPanelLeft + 120.0 * static_cast<double>(k), 16}, curves[k], "start"),
                  "</g>\n");
  for (std::size_t c = 0; c < ablation.columns.size(); ++c) {
    const AblationColumn& column = ablation.columns[c];
    Panel panel;
    panel.corner = {kPanelWidth * static_cast<double>(c % kPanelsInRow),
                    kLegendHeight + kPanelHeight * static_cast<double>(c / kPanelsInRow)};
    for (const AblationResult& result : results) {
      panel.most_frames = std::max<double>(panel.most_frames, result.variant.frame_count);
      panel.most = std::max(panel.most, value_of(column, result));
    }
    svg += frame_of(panel, column.name);
    for (std::size_t k = 0; k < curves.size(); ++k)
      svg += polyline(panel, column, results, curves[k], kSvgColors[k % kSvgColors.size()]);
  }
  const std::size_t rows = (ablation.columns.size() + kPanelsInRow - 1) / kPanelsInRow;
  return concat("<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 ",
                kPanelWidth * kPanelsInRow, " ",
                kLegendHeight + kPanelHeight * static_cast<double>(rows),
                "\" font-family=\"sans-serif\" font-size=\"12\">\n<rect width=\"100%\" "
                "height=\"100%\" fill=\"#fff\"/>\n",
                svg, "</svg>\n");
}

}  // namespace ovimap::apps
