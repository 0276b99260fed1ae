// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/evaluation/plot.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <fstream>

#include <fmt/format.h>

#include "kestrel/core/base/error.h"

namespace kestrel {
namespace {

constexpr int kWidth_px = 1400;
constexpr int kMapHeight_px = 1100;
constexpr int kPanelHeight_px = 420;
constexpr int kTitleHeight_px = 60;

// Colours of Okabe and Ito (2008), which stay distinct for the colour-blind and in gray prints.
constexpr std::array<const char*, 6> kColors = {"#000000", "#0072B2", "#D55E00",
                                                "#009E73", "#CC79A7", "#E69F00"};

// A gnuplot string in which only the quote has a special meaning.
std::string Quoted(const std::string& text) {
  std::string quoted = "'";
  for (const char c : text) quoted.append(c == '\'' ? 2 : 1, c);
  return quoted + "'";
}

// A word quoted for the shell.
std::string ShellQuoted(const std::string& text) {
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? "'\\''" : std::string(1, c);
  return quoted + "'";
}

int HeightOf(const Plot& plot) {
  int height_px = kTitleHeight_px;
  for (const PlotPanel& panel : plot.panels) {
    height_px += panel.equal_axes ? kMapHeight_px : kPanelHeight_px;
  }
  return height_px;
}

std::string DataBlock(const PlotSeries& series, const std::string& name) {
  std::string text = fmt::format("{} << EOD\n", name);
  for (std::size_t i = 0; i < series.points.size(); ++i) {
    const Eigen::Vector2d& point = series.points[i];
    if (!point.allFinite()) {
      text += "\n";
    } else if (series.style == PlotStyle::kErrorBars) {
      text += fmt::format("{:.9g} {:.9g} {:.9g} {:.9g}\n", point.x(), point.y(), series.bars[i].low,
                          series.bars[i].high);
    } else {
      text += fmt::format("{:.9g} {:.9g}\n", point.x(), point.y());
    }
  }
  return text + "EOD\n";
}

const char* StyleWords(PlotStyle style) {
  switch (style) {
    case PlotStyle::kLine:
      return "with linespoints lw 2.5 pt 7 ps 0.3";
    case PlotStyle::kDashes:
      return "with lines lw 2.5 dt 2";
    case PlotStyle::kDots:
      return "with points pt 7 ps 0.3";
    case PlotStyle::kPoints:
      return "with points pt 7 ps 1";
    case PlotStyle::kCircles:
      return "with points pt 6 ps 2.5 lw 2";
    case PlotStyle::kCrosses:
      return "with points pt 2 ps 2 lw 2.5";
    case PlotStyle::kErrorBars:
      return "with yerrorbars pt 7 ps 1.5 lw 2.5";
  }
  return "";
}

std::string PanelScript(const PlotPanel& panel, std::size_t index) {
  std::string blocks;
  std::vector<std::string> curves;
  for (const PlotSeries& series : panel.series) {
    if (series.points.empty()) continue;
    const std::string name = fmt::format("$panel{}_{}", index, curves.size());
    blocks += DataBlock(series, name);
    const auto of_palette = static_cast<std::size_t>(&series - panel.series.data());
    const std::string color =
        series.color.empty() ? kColors[of_palette % kColors.size()] : series.color;
    curves.push_back(fmt::format("{} {} lc rgb '{}' title {}", name, StyleWords(series.style),
                                 color, Quoted(series.label)));
  }
  if (curves.empty()) return "";
  return blocks + fmt::format("set xlabel {}\nset ylabel {}\nset size {}\nset yrange {}\nplot {}\n",
                              Quoted(panel.x_label), Quoted(panel.y_label),
                              panel.equal_axes ? "ratio -1" : "noratio",
                              panel.y_range.low == panel.y_range.high
                                  ? "[*:*]"
                                  : fmt::format("[{}:{}]", panel.y_range.low, panel.y_range.high),
                              fmt::join(curves, ", "));
}

}  // namespace

std::string PlotScript(const Plot& plot, const std::string& file) {
  std::string script = fmt::format(
      "set terminal pngcairo noenhanced size {},{} font 'DejaVu Sans,18'\n"
      "set output {}\n"
      "set grid lt 1 lc rgb '#cccccc'\nset key above right horizontal\nset autoscale xfix\n"
      "set offsets graph 0.02, graph 0.02\nset lmargin 11\nset rmargin 3\n"
      "set multiplot layout {},1 title {} font 'DejaVu Sans,22'\n",
      kWidth_px, HeightOf(plot), Quoted(file), plot.panels.size(), Quoted(plot.title));
  for (std::size_t i = 0; i < plot.panels.size(); ++i) script += PanelScript(plot.panels[i], i);
  return script + "unset multiplot\n";
}

void WritePlot(const Plot& plot, const std::string& file) {
  const std::string script = file + ".gnuplot";
  const bool is_written(std::ofstream(script) << PlotScript(plot, file));
  const std::string command = fmt::format("gnuplot {} >/dev/null 2>&1", ShellQuoted(script));
  if (is_written && std::system(command.c_str()) == 0) return;
  throw InputError(file + ": cannot be drawn, expected the program gnuplot (gnuplot-nox)");
}

}  // namespace kestrel
