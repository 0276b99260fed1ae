#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# roslaunch looks for programs in the package's own folder; this one is in <prefix>/bin.
exec "$(dirname "$0")/../../bin/kestrel_node" "$@"
