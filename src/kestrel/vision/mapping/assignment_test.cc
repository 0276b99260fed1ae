// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/mapping/assignment.h"

#include <algorithm>
#include <limits>
#include <numeric>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/core/base/random.h"

namespace kestrel {
namespace {

using ::testing::ElementsAre;

double CostOf(const Eigen::MatrixXd& costs, const std::vector<int>& columns) {
  double sum = 0;
  for (std::size_t i = 0; i < columns.size(); ++i) sum += costs(static_cast<int>(i), columns[i]);
  return sum;
}

double LeastCost(const Eigen::MatrixXd& costs) {
  std::vector<int> columns(costs.cols());
  std::iota(columns.begin(), columns.end(), 0);
  double least = std::numeric_limits<double>::infinity();
  do {
    least = std::min(least, CostOf(costs, {columns.begin(), columns.begin() + costs.rows()}));
  } while (std::next_permutation(columns.begin(), columns.end()));
  return least;
}

TEST(AssignmentSolver, MinimisesTotalCostRatherThanNearest) {
  Eigen::MatrixXd costs(2, 2);
  costs << 1, 2,  //
      1.1, 10;
  EXPECT_THAT(AssignmentSolver().Solve(costs), ElementsAre(1, 0));
}

TEST(AssignmentSolver, MatchesBestOfAllAssignments) {
  Random random(1);
  AssignmentSolver solver;
  for (int i = 0; i < 200; ++i) {
    const int rows = random.Integer(1, 4);
    Eigen::MatrixXd costs(rows, random.Integer(rows, 6));
    for (double& cost : costs.reshaped()) cost = random.Uniform(-5, 20);
    EXPECT_NEAR(CostOf(costs, solver.Solve(costs)), LeastCost(costs), 1e-9);
  }
}

}  // namespace
}  // namespace kestrel
