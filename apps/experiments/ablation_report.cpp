// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>

#include "ablation.h"
#include "svg.h"

namespace ovimap::apps {

namespace {

constexpr std::array kProtocols = {Protocol::kStandard, Protocol::kReference};
const char* protocol_name(Protocol protocol) {
  return protocol == Protocol::kStandard ? "standard" : "reference";
}

std::string cell(const std::optional<double>& value) {
  return value ? one_decimal(*value) : "-";
}

/// CSV: quotes around what holds a comma or a quote.
std::string field(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

/// Pictures of 760 x 360 units; the plot itself leaves room for a scale and a legend.
constexpr double kWidth = 760, kHeight = 360, kLeft = 50, kRight = 20, kTop = 40, kBottom = 60;
constexpr double kCharacter = 6.2;  ///< mean width of one

double plot_y(double value, double most) {
  return kHeight - kBottom - (kHeight - kBottom - kTop) * value / most;
}

std::string scale_lines(double most) {
  std::string svg;
  constexpr int kLines = 5;
  for (int i = 0; i <= kLines; ++i) {
    const double value = most * i / kLines, y = plot_y(value, most);
    svg += concat("<line x1=\"", kLeft, "\" y1=\"", y, "\" x2=\"", kWidth - kRight, "\" y2=\"", y,
                  "\" stroke=\"#ddd\"/>\n");
    svg += svg_text({kLeft - 8, y + 4}, one_decimal(value), "end");
  }
  return svg;
}

std::string legend(const std::vector<AblationColumn>& columns) {
  std::string svg;
  const double step = std::min(110.0, (kWidth - kLeft) / static_cast<double>(columns.size()));
  double x = kLeft;
  for (std::size_t c = 0; c < columns.size(); ++c, x += step) {
    svg += concat("<rect x=\"", x, "\" y=\"14\" width=\"12\" height=\"12\" fill=\"",
                  kSvgColors[c % kSvgColors.size()], "\"/>\n");
    svg += svg_text({x + 18, 24}, columns[c].name, "start");
  }
  return svg;
}

/// Every figure that is a percentage.
std::vector<AblationColumn> percentages(const Ablation& ablation) {
  std::vector<AblationColumn> columns = ablation.columns;
  std::erase_if(columns, [](const AblationColumn& column) { return column.name == "AQ"; });
  return columns;
}

std::string bars(const std::vector<AblationColumn>& columns,
                 const std::vector<AblationResult>& results, double most) {
  std::string svg;
  const double group = (kWidth - kLeft - kRight) / static_cast<double>(results.size());
  const double bar = 0.8 * group / static_cast<double>(columns.size());
  for (std::size_t r = 0; r < results.size(); ++r) {
    const double left = kLeft + group * (static_cast<double>(r) + 0.1);
    for (std::size_t c = 0; c < columns.size(); ++c) {
      const double y = plot_y(value_of(columns[c], results[r]), most);
      svg += concat("<rect x=\"", left + bar * static_cast<double>(c), "\" y=\"", y, "\" width=\"",
                    0.9 * bar, "\" height=\"", kHeight - kBottom - y, "\" fill=\"",
                    kSvgColors[c % kSvgColors.size()], "\"/>\n");
    }
    // Long names take two lines by turns, so that neighbours do not meet, and end in the picture.
    const double half = 0.5 * kCharacter * static_cast<double>(results[r].variant.name.size());
    svg += svg_text({std::min(left + 0.4 * group, kWidth - half),
                     kHeight - kBottom + (r % 2 == 0 ? 20.0 : 38.0)},
                    results[r].variant.name);
  }
  return svg;
}

}  // namespace

std::string ablation_markdown(const Ablation& ablation, const std::vector<AblationResult>& results,
                              const std::string& heading) {
  std::string text =
      concat("## ", ablation.title, "\n\n", heading, "\n\n| ", ablation.name, " | protocol |");
  for (const AblationColumn& column : ablation.columns) text += concat(" ", column.name, " |");
  text += "\n| --- | --- |";
  for (std::size_t c = 0; c < ablation.columns.size(); ++c) text += " --- |";
  text += "\n";
  for (const Protocol protocol : kProtocols)
    for (const AblationResult& result : results) {
      text += concat("| ", result.variant.name, " | ", protocol_name(protocol), " |");
      for (const AblationColumn& column : ablation.columns)
        text += concat(" ", cell(column.figure(result.figures, protocol)), " |");
      text += "\n";
    }
  for (const PublishedRow& row : ablation.published) {
    text += concat("| ", row.name, " | *published, ", row.where, "* |");
    for (const double figure : row.figures) text += concat(" *", one_decimal(figure), "* |");
    text += "\n";
  }
  return text;
}

std::string ablation_csv(const Ablation& ablation, const std::vector<AblationResult>& results) {
  std::string text = "variant,protocol,measured_or_published";
  for (const AblationColumn& column : ablation.columns) text += "," + field(column.name);
  text += "\n";
  for (const AblationResult& result : results)
    for (const Protocol protocol : kProtocols) {
      text += concat(field(result.variant.name), ",", protocol_name(protocol), ",measured");
      for (const AblationColumn& column : ablation.columns) {
        const auto figure = column.figure(result.figures, protocol);
        text += figure ? concat(",", *figure) : ",";
      }
      text += "\n";
    }
  for (const PublishedRow& row : ablation.published) {
    text += concat(field(row.name), ",reference,", field("published, " + row.where));
    for (const double figure : row.figures)
      text += std::isfinite(figure) ? concat(",", figure) : ",";
    text += "\n";
  }
  return text;
}

std::string ablation_bars(const Ablation& ablation, const std::vector<AblationResult>& results) {
  const std::vector<AblationColumn> columns = percentages(ablation);
  double most = 0;
  for (const AblationResult& result : results)
    for (const AblationColumn& column : columns) most = std::max(most, value_of(column, result));
  constexpr double kStep = 10;  // percent
  most = std::max(kStep, kStep * std::ceil(most / kStep));
  return concat("<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 ", kWidth, " ", kHeight,
                "\" font-family=\"sans-serif\" font-size=\"12\">\n<rect width=\"100%\" "
                "height=\"100%\" fill=\"#fff\"/>\n",
                legend(columns), scale_lines(most), bars(columns, results, most), "</svg>\n");
}

}  // namespace ovimap::apps
