# SPDX-License-Identifier: BSD-3-Clause
"""What a worker on this computer does first: Ctrl-C is for the study, which ends its workers."""
import signal

signal.signal(signal.SIGINT, signal.SIG_IGN)
