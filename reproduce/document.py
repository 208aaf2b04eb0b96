"""A document of headings, paragraphs, tables and pictures, written as Markdown and as one HTML page."""

import base64
import csv
import html
import math
import os

STYLE = """
body { font: 16px/1.5 system-ui, sans-serif; color: #1d1d1f; max-width: 62rem; margin: 2rem auto;
       padding: 0 1rem }
h1 { font-size: 1.8rem } h2 { margin-top: 2.5rem; border-bottom: 1px solid #ccc } h3 { margin-top: 2rem }
table { border-collapse: collapse; font-size: .85rem; font-variant-numeric: tabular-nums; margin: 1rem 0 }
th, td { padding: .15rem .7rem; text-align: right; border-bottom: 1px solid #e4e4e4; white-space: nowrap }
th { border-bottom: 2px solid #888; vertical-align: bottom }
td.text, th.text { text-align: left; white-space: normal }
figure { margin: 1.5rem 0 } figure img { max-width: 100%; height: auto; border: 1px solid #e4e4e4 }
figcaption { color: #555; font-size: .9rem }
.scroll { overflow-x: auto }
"""

MIME = {".svg": "image/svg+xml", ".png": "image/png"}


def figure(value):
    """Four significant digits from 1 on, three below, at most six decimals, never powers of ten."""
    if value == 0:
        return "0"
    if value >= 1000:
        return f"{value:.0f}"
    digits = 3 if value >= 1 else 2
    return f"{value:.{min(6, digits - math.floor(math.log10(value)))}f}"


def written(path, header, rows):
    with open(path, "w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(header)
        writer.writerows(rows)


class Document:
    def __init__(self, title):
        self.title = title
        self._blocks = []

    def heading(self, text, level=2):
        self._blocks.append(("heading", text, level))

    def paragraph(self, text):
        self._blocks.append(("paragraph", text))

    def table(self, header, rows):
        """Rows of texts; columns whose cells are all numbers are set flush right. A table without rows is none."""
        if not rows:
            return
        assert all(len(row) == len(header) for row in rows), f"a row has not the {len(header)} columns of {header}"
        numeric = [all(_is_number(row[i]) for row in rows) for i in range(len(header))]
        self._blocks.append(("table", header, rows, numeric))

    def picture(self, path, caption):
        self._blocks.append(("picture", path, caption))

    def add(self, other):
        """All that another document has, but its title."""
        self._blocks += other._blocks

    def tables(self):
        """Of each table the headings above it, from the first level on, its header and its rows; headings whose place in the
        document another one has taken are none."""
        above, out = {}, []
        for kind, *block in self._blocks:
            if kind == "heading":
                above = {level: text for level, text in above.items() if level < block[1]} | {block[1]: block[0]}
            elif kind == "table":
                out.append({"under": [text for _, text in sorted(above.items())], "header": block[0], "rows": block[1]})
        return out

    def markdown(self, folder=None):
        """Pictures are linked relative to `folder`; None: left out."""
        out = [f"# {self.title}"] if self.title else []
        for kind, *block in self._blocks:
            if kind == "heading":
                out.append("#" * block[1] + " " + block[0])
            elif kind == "paragraph":
                out.append(block[0])
            elif kind == "table":
                header, rows, numeric = block
                rule = ["---:" if right else "---" for right in numeric]
                lines = [[cell.replace("|", "\\|") for cell in line] for line in (header, rule, *rows)]
                out.append("\n".join("| " + " | ".join(line) + " |" for line in lines))
            elif folder is not None:
                out.append(f"![{block[1]}]({os.path.relpath(block[0], folder)})")
        return "\n\n".join(out) + "\n"

    def html(self):
        """Self-contained: pictures are inside."""
        out = ["<!doctype html>", '<html lang="en"><head><meta charset="utf-8">',
               '<meta name="viewport" content="width=device-width, initial-scale=1">',
               f"<title>{html.escape(self.title)}</title><style>{STYLE}</style></head><body>",
               f"<h1>{html.escape(self.title)}</h1>"]
        for kind, *block in self._blocks:
            if kind == "heading":
                out.append(f"<h{block[1]}>{html.escape(block[0])}</h{block[1]}>")
            elif kind == "paragraph":
                out.append(f"<p>{html.escape(block[0])}</p>")
            elif kind == "table":
                out.append(_html_table(*block))
            else:
                data = base64.b64encode(block[0].read_bytes()).decode()
                text = html.escape(block[1])
                out.append(f'<figure><img alt="{text}" src="data:{MIME[block[0].suffix]};base64,{data}">'
                           f"<figcaption>{text}</figcaption></figure>")
        return "\n".join(out) + "\n</body></html>\n"


def _is_number(text):
    return not text or text[0] in "0123456789—<≤" or text.endswith("×")


def _html_table(header, rows, numeric):
    def line(tag, cells):
        return "<tr>" + "".join(
            f"<{tag}{'' if right else ' class=text'}>{html.escape(cell)}</{tag}>"
            for cell, right in zip(cells, numeric)) + "</tr>"
    return "\n".join(['<div class="scroll"><table>', line("th", header),
                      *(line("td", row) for row in rows), "</table></div>"])
