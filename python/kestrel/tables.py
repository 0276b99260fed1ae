# SPDX-License-Identifier: BSD-3-Clause
"""Results of a run as a table."""

from __future__ import annotations

import io
from typing import Any

from ._kestrel import Observation


class ResultTable:
    """A sink of a Session that keeps its table: the rows of landing_detections.csv or
    object_detections.csv, as the commands write them.

        table = kestrel.ResultTable()
        kestrel.Session("flight", sinks=[table]).run()
        table.dataframe().plot("timestamp_ns", "quality")
    """

    def __init__(self) -> None:
        self._header = ""
        self._rows: list[str] = []

    def __call__(self, observation: Observation) -> None:
        self._header = observation.csv_header
        self._rows.append(observation.csv_rows)

    def __len__(self) -> int:
        """Number of frames."""
        return len(self._rows)

    def __repr__(self) -> str:
        return f"<ResultTable: {len(self)} frames>"

    def csv(self) -> str:
        """Returns the table as text."""
        return self._header + "".join(self._rows)

    def dataframe(self) -> Any:
        """Returns the table as a pandas.DataFrame; unknown values are NaN. Needs pandas."""
        import pandas

        return pandas.read_csv(io.StringIO(self.csv())) if self._rows else pandas.DataFrame()
