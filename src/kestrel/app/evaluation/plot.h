// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "kestrel/app/evaluation/statistics.h"

namespace kestrel {

enum class PlotStyle { kLine, kDashes, kDots, kPoints, kCircles, kCrosses, kErrorBars };

using Points2d = std::vector<Eigen::Vector2d>;

// Points of one kind; a point with a coordinate that is not finite interrupts a line.
struct PlotSeries {
  std::string label;
  PlotStyle style = PlotStyle::kLine;
  Points2d points;
  std::vector<Interval> bars;  // for kErrorBars: low and high y, one for each point
  std::string color = "";      // as "#d55e00"; empty: one of the plot's palette
};

struct PlotPanel {
  std::string x_label;  // with the unit
  std::string y_label;
  std::vector<PlotSeries> series;
  bool equal_axes = false;  // as for a map: same scale in x and y
  // Limits of the y axis; chosen from the data when both are equal.
  Interval y_range = {};
};

// Panels, one below the other.
struct Plot {
  std::string name;  // file name without the extension
  std::string title;
  std::vector<PlotPanel> panels;
};

// Returns the gnuplot script that draws 'plot' into the PNG 'file'.
std::string PlotScript(const Plot& plot, const std::string& file);

// Draws the plot with the program gnuplot; the script stays beside the picture as 'file'.gnuplot.
// Throws InputError when gnuplot is not installed or fails.
void WritePlot(const Plot& plot, const std::string& file);

}  // namespace kestrel
