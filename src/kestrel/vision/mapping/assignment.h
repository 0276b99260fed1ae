// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

namespace kestrel {

// Cost of an impossible pair, far above that of all possible ones.
inline constexpr double kImpossibleCost = 1e9;

// Assigns every row to a column of its own at the least total cost (Hungarian method, Kuhn 1955, in
// the O(rows^2 columns) form with potentials). Keeps its memory between calls.
class AssignmentSolver {
 public:
  // Returns the column of each row, valid until the next call. 'costs': rows x columns, finite, not
  // more rows than columns.
  const std::vector<int>& Solve(const Eigen::Ref<const Eigen::MatrixXd>& costs);

 private:
  std::vector<double> row_potential_;
  std::vector<double> column_potential_;
  std::vector<double> slack_;
  std::vector<int> row_of_column_;
  std::vector<int> previous_;
  std::vector<char> is_used_;
  std::vector<int> column_of_row_;
};

}  // namespace kestrel
