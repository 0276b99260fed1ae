// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>

namespace kestrel {

inline constexpr std::size_t kMostColumns = 24;

// Writes the sums over 'count' rows of the products of every two columns, columns.size() squared
// values, to 'products'. At most kMostColumns columns. Sums in double precision, with the best
// vector instructions of the machine, chosen at run time.
void SumProducts(std::span<const float* const> columns, std::size_t count, double* products);

}  // namespace kestrel
