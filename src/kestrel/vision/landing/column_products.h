// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>

namespace kestrel {

inline constexpr std::size_t kMostColumns = 24;

// Sums over 'count' rows of the products of any two of at most so many columns, in double precision
// and with the best instructions of the machine at run time: writes columns.size() squared of them.
void SumProducts(std::span<const float* const> columns, std::size_t count, double* products);

}  // namespace kestrel
