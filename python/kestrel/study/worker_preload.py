# SPDX-License-Identifier: BSD-3-Clause
"""The start of a worker on this computer: it ignores Ctrl-C, as the study ends its workers."""
import signal

signal.signal(signal.SIGINT, signal.SIG_IGN)
