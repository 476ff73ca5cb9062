"""Certificates as HTML: one page that needs no other files. All text from elsewhere is escaped."""

from __future__ import annotations

import base64
from html import escape
from typing import Any

import numpy as np
import numpy.typing as npt

from ._pinhole import Judged, png_of

#: The colour and the meaning of each verdict, as in the program's report.
VERDICTS = {
    "decided": ("e4ebef", "one answer is legal, and the device gave it"),
    "silhouette": ("0072b2", "a sphere and a miss are legal; the device gave one of them"),
    "tie": ("56b4e9", "several spheres are legal; the device gave one of them"),
    "violation": ("d55e00", "the device gave an answer that is not legal"),
}

#: The words for the outcomes.
OUTCOMES = {
    "proved": ("Legal", "Every pixel is one that a conforming device may have made."),
    "undecided": ("Undecided", "No violation was found, but more than 1 % of the pixels have several legal answers."),
    "violated": ("Not legal", "The device gave answers that no conforming device gives."),
}

#: The colour of verdicts that are not in the list.
OTHER = ("808080", "")

#: The longest side of the picture of verdicts. Each pixel of a reduced picture shows the worst verdict that it covers.
LONGEST = 1024

#: Maximum number of violations in the list.
LISTED = 50


def part(judged: Judged) -> str:
    """The report as a part of a page."""
    counts = dict(judged.counts())
    pixels = sum(counts.values())
    title, says = OUTCOMES[judged.outcome]
    color, ground = ("#00563f", "#e6f2ee") if judged.is_legal else ("#9a3f00", "#fdeee3")
    verdicts = judged.verdicts()
    height, width = verdicts.shape
    rows = "".join(_row(name, count, pixels) for name, count in counts.items())
    parts = [
        '<div style="max-width: 60em; padding: 1em; color: #1b1f23; background: #fbfbfa; '
        'font: 15px/1.5 system-ui, sans-serif">',
        f'<div style="padding: 0.8em 1.2em; border-left: 8px solid {color}; background: {ground}">'
        f'<b style="font-size: 1.6em; color: {color}">{title}</b><br>{says}<br>'
        f"{width}\u2009×\u2009{height} pixels on {escape(judged.adapter)}, one ray for each. "
        "Light is not checked.</div>",
        '<table style="margin: 1em 0; border-collapse: collapse; color: inherit">'
        "<tr><th></th><th style='text-align: left'>verdict</th><th style='text-align: right'>pixels</th>"
        f"<th></th><th style='text-align: left'>meaning</th></tr>{rows}</table>",
        _violations(judged.violations()),
    ]
    if verdicts.size:
        shown = max(width, min(640, 8 * width))
        parts.append(
            f'<img alt="the verdict about each pixel" src="data:image/png;base64,{_picture(verdicts, list(counts))}" '
            f'style="width: {shown}px; max-width: 100%; image-rendering: pixelated; border: 1px solid #dde1e5">'
            "<br>The verdict about each pixel, in the colors of the table."
        )
    numbers = escape(str(judged))
    parts.append(f"<details><summary>All numbers</summary><pre style='color: inherit'>{numbers}</pre></details></div>")
    return "\n".join(parts)


def page(judged: Judged) -> str:
    """The report as a page."""
    title = f"{OUTCOMES[judged.outcome][0]}: {escape(judged.adapter)}"
    return (
        '<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
        '<meta name="viewport" content="width=device-width, initial-scale=1">\n'
        f'<title>{title}</title>\n</head>\n<body style="margin: 0; background: #fbfbfa">\n{part(judged)}\n</body>\n</html>\n'
    )


def _row(name: str, count: int, pixels: int) -> str:
    color, meaning = VERDICTS.get(name, OTHER)
    swatch = f'<span style="display: inline-block; width: 1em; height: 1em; background: #{color}"></span>'
    percent = 100 * count / max(pixels, 1)
    right = "style='text-align: right; padding-left: 1em'"
    return (
        f"<tr><td>{swatch}</td><td style='text-align: left'>{escape(name)}</td><td {right}>{count}</td>"
        f"<td {right}>{percent:.4f}\u2009%</td><td style='text-align: left; padding-left: 1em'>{meaning}</td></tr>"
    )


def _violations(violations: list[str]) -> str:
    if not violations:
        return ""
    items = "".join(f"<li>{escape(words)}</li>" for words in violations[:LISTED])
    more = len(violations) - LISTED
    rest = f"<p>{more} more are not listed.</p>" if more > 0 else ""
    return f"<b>The first violations</b><ol>{items}</ol>{rest}"


def _picture(verdicts: npt.NDArray[Any], names: list[str]) -> str:
    """The verdicts as a PNG file, in base64."""
    height, width = verdicts.shape
    step = -(-max(height, width) // LONGEST)
    if step > 1:
        # Verdicts are ordered from the best to the worst.
        rows = np.maximum.reduceat(verdicts, range(0, height, step), axis=0)
        verdicts = np.maximum.reduceat(rows, range(0, width, step), axis=1)
    palette = np.array([list(bytes.fromhex(VERDICTS.get(name, OTHER)[0])) for name in names], np.uint8)
    return base64.b64encode(png_of(palette[verdicts])).decode()
