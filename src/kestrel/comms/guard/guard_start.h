// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Conventions of the guard and the program that starts it, beside guard_messages.h.
namespace kestrel {

inline constexpr int kGuardFile = 3;      // the guard's socket
inline constexpr int kGuardTookOver = 3;  // its exit status: the program was taken for dead

}  // namespace kestrel
