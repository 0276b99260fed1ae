// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <utility>
#include <vector>

namespace kestrel {

struct Interval {
  double low = 0;
  double high = 0;
};

// 95 % confidence interval of a share of which 'successes' of 'trials' are known (Wilson 1927);
// 0 to 1 without trials.
Interval WilsonInterval(int successes, int trials);

// Bounds between which a chi-square variable with 'degrees' of freedom (at least 1) lies with 95 %,
// 2.5 % on either side, by the cube root approximation of Wilson and Hilferty (1931): right to
// 0.05 at 3 degrees and more.
Interval ChiSquareBounds(int degrees);

// Bounds of the mean of 'count' (at least 1) normalised errors squared (NEES) with 'dimensions'
// degrees of freedom each, when the covariances are right (Bar-Shalom et al. 2001, section 5.4).
Interval MeanNeesBounds(int count, int dimensions);

// How many independent values say as much of their mean as a series whose neighbours are alike: a
// first-order autoregressive process with the correlation of the neighbours. At least 1, and no
// more than there are values.
int IndependentCount(std::span<const double> series);

// These are NaN without values. The quantile, 'part' 0 to 1, is interpolated between neighbours.
double Mean(std::span<const double> values);
double RootMeanSquare(std::span<const double> values);
double Quantile(std::vector<double> values, double part);
inline double Median(std::vector<double> values) { return Quantile(std::move(values), 0.5); }

}  // namespace kestrel
