# SPDX-License-Identifier: BSD-3-Clause
"""Results of a run as a table."""

import io


class ResultTable:
    """A sink of a Session that keeps its table: the rows of landing_detections.csv or
    object_detections.csv, as the commands write them.

        table = kestrel.ResultTable()
        kestrel.Session("flight", sinks=[table]).run()
        table.dataframe().plot("timestamp_ns", "quality")
    """

    def __init__(self):
        self._header = ""
        self._rows = []

    def __call__(self, observation):
        self._header = observation.csv_header
        self._rows.append(observation.csv_rows)

    def __len__(self):
        """Number of frames."""
        return len(self._rows)

    def __repr__(self):
        return f"<ResultTable: {len(self)} frames>"

    def csv(self):
        """Returns the table as text."""
        return self._header + "".join(self._rows)

    def dataframe(self):
        """Returns the table as a pandas.DataFrame; unknown values are NaN. Needs pandas."""
        import pandas

        return pandas.read_csv(io.StringIO(self.csv())) if self._rows else pandas.DataFrame()
