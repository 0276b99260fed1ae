// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/mapping/assignment.h"

#include <limits>

namespace kestrel {

const std::vector<int>& AssignmentSolver::Solve(const Eigen::Ref<const Eigen::MatrixXd>& costs) {
  const auto rows = static_cast<int>(costs.rows());
  const auto columns = static_cast<int>(costs.cols());
  // Rows and columns count from 1; 0 stands for none.
  row_potential_.assign(rows + 1, 0);
  column_potential_.assign(columns + 1, 0);
  row_of_column_.assign(columns + 1, 0);
  previous_.assign(columns + 1, 0);
  for (int row = 1; row <= rows; ++row) {
    // The cheapest alternating path from this row to a free column (Dijkstra on reduced costs).
    slack_.assign(columns + 1, std::numeric_limits<double>::infinity());
    is_used_.assign(columns + 1, 0);
    row_of_column_[0] = row;
    int column = 0;
    do {
      is_used_[column] = 1;
      const int from = row_of_column_[column];
      double least = std::numeric_limits<double>::infinity();
      int next = 0;
      for (int k = 1; k <= columns; ++k) {
        if (is_used_[k]) continue;
        const double reduced = costs(from - 1, k - 1) - row_potential_[from] - column_potential_[k];
        if (reduced < slack_[k]) {
          slack_[k] = reduced;
          previous_[k] = column;
        }
        if (slack_[k] < least) {
          least = slack_[k];
          next = k;
        }
      }
      for (int k = 0; k <= columns; ++k) {
        if (is_used_[k]) {
          row_potential_[row_of_column_[k]] += least;
          column_potential_[k] -= least;
        } else {
          slack_[k] -= least;
        }
      }
      column = next;
    } while (row_of_column_[column] != 0);
    while (column != 0) {
      const int before = previous_[column];
      row_of_column_[column] = row_of_column_[before];
      column = before;
    }
  }
  column_of_row_.assign(rows, -1);
  for (int k = 1; k <= columns; ++k) {
    if (row_of_column_[k] != 0) column_of_row_[row_of_column_[k] - 1] = k - 1;
  }
  return column_of_row_;
}

}  // namespace kestrel
