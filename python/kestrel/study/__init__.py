# SPDX-License-Identifier: BSD-3-Clause
"""Studies: many recordings, several configurations or versions, on this machine or on many.

`kestrel study run STUDY.yaml` does the work, `kestrel study report DIR` says what it shows; docs/study.md.
"""
