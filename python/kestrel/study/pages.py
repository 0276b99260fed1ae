# SPDX-License-Identifier: BSD-3-Clause
"""A report as Markdown, as a page for the browser and as CSV files."""

from __future__ import annotations

import csv
import html
import io
from dataclasses import dataclass, field

_STYLE = """
body { font: 15px/1.5 system-ui, sans-serif; color: #1c2733; background: #f6f7f9; margin: 0; }
main { max-width: 68rem; margin: 0 auto; padding: 1.5rem; }
h1 { font-size: 1.5rem; margin: 0 0 .75rem; } h2 { font-size: 1.15rem; margin: 2rem 0 .25rem; }
.verdict { background: #fff; border-left: .4rem solid #60738a; padding: .75rem 1rem;
  font-size: 1.05rem; }
.verdict.worse { border-color: #c2410c; } .verdict.better { border-color: #15803d; }
p { max-width: 52rem; } .table { overflow-x: auto; margin: .5rem 0 1rem; }
table { border-collapse: collapse; background: #fff; font-size: .9rem; }
th, td { padding: .3rem .7rem; border-bottom: 1px solid #dfe4ea; text-align: left;
  white-space: nowrap; }
td.number { text-align: right; font-variant-numeric: tabular-nums; }
tr.worse td { background: #fdeee6; } tr.better td { background: #e8f5ec; }
img { max-width: 100%; background: #fff; } summary { cursor: pointer; color: #35506b; }
"""


@dataclass
class Table:
    """A table of text. name: of its CSV file. Rows with a cell 'worse' or 'better' are coloured."""

    name: str
    columns: list[str]
    rows: list[list[str]]
    is_folded: bool = False

    def to_csv(self) -> str:
        """Returns the table as CSV."""
        text = io.StringIO()
        writer = csv.writer(text, lineterminator="\n")
        writer.writerow(self.columns)
        writer.writerows(self.rows)
        return text.getvalue()


@dataclass
class Section:
    """A part of a report. picture: name of a PNG file beside it."""

    title: str
    text: str = ""
    tables: list[Table] = field(default_factory=list)
    picture: str = ""


@dataclass
class Page:
    """A report: its verdict is the first line. tone: 'worse', 'better' or ''."""

    title: str
    verdict: str
    tone: str
    notes: list[str]
    sections: list[Section]

    def tables(self) -> list[Table]:
        """Returns all tables."""
        return [table for section in self.sections for table in section.tables]


def to_markdown(page: Page) -> str:
    """Returns the page as Markdown; the first line is the verdict."""
    lines = [f"**{page.verdict}**", ""]
    lines += [f"- {note}" for note in page.notes] + [""] * bool(page.notes)
    lines += [f"# {page.title}", ""]
    for section in page.sections:
        lines += [f"## {section.title}", ""]
        lines += [section.text, ""] * bool(section.text)
        if section.picture:
            lines += [f"![{section.title}]({section.picture})", ""]
        for table in section.tables:
            lines += [_row(table.columns), _row(["---"] * len(table.columns)),
                      *(_row(row) for row in table.rows), ""]
    return "\n".join(lines)


def _row(cells: list[str]) -> str:
    return "| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |"


def to_html(page: Page) -> str:
    """Returns the page for a browser; it needs no other file but its pictures."""
    parts = ["<!DOCTYPE html><html lang='en'><head><meta charset='utf-8'>",
             "<meta name='viewport' content='width=device-width, initial-scale=1'>",
             f"<title>{html.escape(page.title)}</title><style>{_STYLE}</style></head><body><main>",
             f"<h1>{html.escape(page.title)}</h1>",
             f"<p class='verdict {page.tone}'>{html.escape(page.verdict)}</p>"]
    if page.notes:
        parts += ["<ul>", *(f"<li>{html.escape(note)}</li>" for note in page.notes), "</ul>"]
    for section in page.sections:
        parts += [f"<h2>{html.escape(section.title)}</h2>"]
        parts += [f"<p>{html.escape(section.text)}</p>"] * bool(section.text)
        if section.picture:
            parts += [f"<img src='{html.escape(section.picture)}' "
                      f"alt='{html.escape(section.title)}'>"]
        parts += [_html_table(table) for table in section.tables]
    return "\n".join([*parts, "</main></body></html>", ""])


def _html_table(table: Table) -> str:
    head = "".join(f"<th>{html.escape(column)}</th>" for column in table.columns)
    rows = "".join(map(_html_row, table.rows))
    text = f"<div class='table'><table><tr>{head}</tr>{rows}</table></div>"
    if not table.is_folded:
        return text
    count = "1 row" if len(table.rows) == 1 else f"{len(table.rows)} rows"
    return f"<details><summary>{count}</summary>{text}</details>"


def _html_row(row: list[str]) -> str:
    tone = next((cell for cell in row if cell in ("worse", "better")), "")
    cells = "".join(f"<td{' class=number' if _is_number(cell) else ''}>{html.escape(cell)}</td>"
                    for cell in row)
    return f"<tr class='{tone}'>{cells}</tr>"


def _is_number(cell: str) -> bool:
    return cell[:1].isdigit() or cell[:2].lstrip("+-\u2212")[:1].isdigit()
