"""Pictures by matplotlib, where it is installed, and what notebooks show."""

from __future__ import annotations

import base64
import html
import io
from collections.abc import Iterable, Sequence
from typing import Any

__all__ = ["image", "new_figure", "page", "table"]


def new_figure(size: tuple[float, float], call: str) -> Any:
    """An empty figure of pyplot, for the caller to keep or to show."""
    try:
        import matplotlib.pyplot as plt
    except ImportError:
        raise ImportError(
            f"{call} needs matplotlib: pip install matplotlib (or pip install 'liepoisson[plot]')"
        ) from None
    return plt.figure(figsize=size, layout="constrained")


def shown(figure: Any, show: bool) -> Any:
    """The figure, in a window where that is asked for."""
    if show:
        import matplotlib.pyplot as plt

        plt.show()
    return figure


def image(draw: Any, size: tuple[float, float], text: str) -> str:
    """What ``draw`` draws, as an element of a page; empty without matplotlib. No state of pyplot changes."""
    try:
        from matplotlib.figure import Figure
    except ImportError:
        return ""
    figure = Figure(figsize=size, layout="constrained")
    draw(figure)
    file = io.BytesIO()
    figure.savefig(file, format="png", dpi=110)
    data = base64.b64encode(file.getvalue()).decode("ascii")
    return (
        f'<img alt="{html.escape(text)}" style="max-width:100%" src="data:image/png;base64,{data}">'
    )


def table(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """A table for a page."""

    def line(cells: Sequence[str], tag: str) -> str:
        style = ' style="text-align:left"'
        inner = "".join(f"<{tag}{style}>{html.escape(cell)}</{tag}>" for cell in cells)
        return f"<tr>{inner}</tr>"

    body = "".join(line(row, "td") for row in rows)
    return f"<table><thead>{line(head, 'th')}</thead><tbody>{body}</tbody></table>"


def page(title: str, *parts: str) -> str:
    """The parts below a title, which is text."""
    inner = "".join(part for part in parts if part)
    return f"<div><p><strong>{html.escape(title)}</strong></p>{inner}</div>"
