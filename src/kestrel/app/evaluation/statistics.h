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

// Returns the 95 % confidence interval of a share with 'successes' of 'trials' (Wilson 1927); 0 to
// 1 without trials.
Interval WilsonInterval(int successes, int trials);

// Returns the bounds between which a chi-square variable with 'degrees' of freedom (at least 1)
// lies with a probability of 95 %, 2.5 % on either side. By the cube root approximation of Wilson
// and Hilferty (1931), which is right to 0.05 for 3 degrees and more.
Interval ChiSquareBounds(int degrees);

// Returns the 95 % bounds for the mean of 'count' (at least 1) normalised squared errors (NEES)
// with 'dimensions' degrees of freedom each, for right covariances (Bar-Shalom et al. 2001, section
// 5.4).
Interval MeanNeesBounds(int count, int dimensions);

// Returns the number of independent values that determine their mean as well as a correlated series
// does, taken as a first-order autoregressive process with the correlation of its neighbours. At
// least 1 and at most the number of values.
int IndependentCount(std::span<const double> series);

// All return NaN without values. The quantile, 'part' 0 to 1, is interpolated between neighbours.
double Mean(std::span<const double> values);
double RootMeanSquare(std::span<const double> values);
double Quantile(std::vector<double> values, double part);
inline double Median(std::vector<double> values) { return Quantile(std::move(values), 0.5); }

}  // namespace kestrel
