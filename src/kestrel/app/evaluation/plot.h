// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "kestrel/app/evaluation/statistics.h"

namespace kestrel {

enum class PlotStyle { kLine, kDashes, kDots, kPoints, kCircles, kCrosses, kErrorBars };

using Points2d = std::vector<Eigen::Vector2d>;

// Points of one kind; coordinates that are not finite interrupt a line.
struct PlotSeries {
  std::string label;
  PlotStyle style = PlotStyle::kLine;
  Points2d points;
  std::vector<Interval> bars;  // kErrorBars: from low to high y, one for every point
};

struct PlotPanel {
  std::string x_label;  // with its unit
  std::string y_label;
  std::vector<PlotSeries> series;
  bool equal_axes = false;  // a map: a metre is as long in x as in y
  // Limits of the y axis; chosen from the data where they are equal.
  Interval y_range = {};
};

// Panels one below the other.
struct Plot {
  std::string name;  // of its file, without the ending
  std::string title;
  std::vector<PlotPanel> panels;
};

// The gnuplot script that draws 'plot' into the PNG 'file'.
std::string PlotScript(const Plot& plot, const std::string& file);

// Draws it by the program gnuplot; the script stays beside the picture, as 'file'.gnuplot. Throws
// InputError when that is not installed or fails.
void WritePlot(const Plot& plot, const std::string& file);

}  // namespace kestrel
