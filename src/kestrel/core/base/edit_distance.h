// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace kestrel {

// Levenshtein's distance: the number of letters to insert, delete or replace.
inline int EditDistance(std::string_view a, std::string_view b) {
  std::vector<int> row(b.size() + 1);
  std::iota(row.begin(), row.end(), 0);
  for (std::size_t i = 0; i < a.size(); ++i) {
    int diagonal = std::exchange(row[0], static_cast<int>(i) + 1);
    for (std::size_t j = 0; j < b.size(); ++j) {
      const int replaced = diagonal + (a[i] != b[j]);
      diagonal = row[j + 1];
      row[j + 1] = std::min({replaced, diagonal + 1, row[j] + 1});
    }
  }
  return row.back();
}

// Returns whether 'typed' is so near to 'name' that it was likely meant: one error in three
// letters, and one in a short name.
inline bool IsNearName(std::string_view typed, std::string_view name) {
  const auto errors = static_cast<std::size_t>(EditDistance(typed, name));
  return errors <= std::max<std::size_t>(1, typed.size() / 3);
}

// Returns the one of 'names', of which there is one at least, that is nearest to 'typed'.
inline const std::string& NearestName(std::string_view typed,
                                      const std::vector<std::string>& names) {
  return *std::min_element(names.begin(), names.end(), [&](std::string_view a, std::string_view b) {
    return EditDistance(typed, a) < EditDistance(typed, b);
  });
}

}  // namespace kestrel
