// SPDX-License-Identifier: BSD-3-Clause
// In place of Highway's header of that name: there is one target, so the source is compiled once.
#pragma once
