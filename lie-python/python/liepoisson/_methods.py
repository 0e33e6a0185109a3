"""The methods, with what is known of them."""

from __future__ import annotations

import json
from collections.abc import Sequence
from typing import Any, NamedTuple

from ._arguments import hint
from ._pictures import page, table

__all__ = ["Method", "Methods"]


class Method(NamedTuple):
    """A method, and whether it applies to a system.

    ``order``: of accuracy; of a composition, that which it gives. ``symmetric``: whether a step back undoes a step. ``explicit``:
    whether a step needs no equation to be solved. ``preserves``: what it keeps, such as "orbit", "poisson", "energy".
    ``keeps``: the same in words. ``needs``: what a system must have. ``options``: names and defaults, which stand with
    the id (``"lie-midpoint --retraction cayley"``). ``reason``: why it does not apply, else ``None``. ``here``: whether it
    runs in Python, where it applies; else the command has it.
    """

    id: str
    title: str
    order: int
    symmetric: bool
    explicit: bool
    preserves: tuple[str, ...]
    keeps: str
    needs: str
    options: dict[str, str]
    reference: str
    reason: str | None
    here: bool

    @property
    def applies(self) -> bool:
        """Whether it applies to the system."""
        return self.reason is None


class Methods(dict[str, Method]):
    """Every :class:`Method` by its id."""

    def __missing__(self, name: str) -> Method:
        raise KeyError(f"no method {name!r}{hint(str(name), list(self))} See System.methods()")

    @property
    def applicable(self) -> list[str]:
        """The ids of those that apply."""
        return [name for name, method in self.items() if method.applies]

    def _rows(self) -> list[tuple[str, ...]]:
        return [
            (
                method.id,
                str(method.order),
                "symmetric" if method.symmetric else "",
                "explicit" if method.explicit else "implicit",
                method.keeps,
                "applies" if method.reason is None else f"does not apply: {method.reason}",
            )
            for method in self.values()
        ]

    def __repr__(self) -> str:
        """A table: a line for each method."""
        rows = [_HEAD, *self._rows()]
        widths = [max(len(row[k]) for row in rows) for k in range(len(_HEAD) - 1)]
        lines = (
            "  ".join([*(cell.ljust(width) for cell, width in zip(row, widths)), row[-1]])
            for row in rows
        )
        return "\n".join(line.rstrip() for line in lines)

    def _repr_html_(self) -> str:
        return page(
            f"{len(self.applicable)} of {len(self)} methods apply", table(_HEAD, self._rows())
        )


_HEAD = ("method", "order", "", "", "keeps", "")


def read(text: str) -> Methods:
    """The methods as the core gives them."""
    found = Methods()
    for row in json.loads(text):
        kept = tuple(name for name, value in row.pop("preserves").items() if value)
        row.pop("built", None)
        found[row["id"]] = Method(preserves=kept, **row)
    return found


def labels_of(call: str, methods: Sequence[Any]) -> list[str]:
    """The methods, which are named one by one."""
    if any(not isinstance(method, str) for method in methods):
        example = ", ".join(f'"{name}"' for name in _flat(methods)) or '"rk4", "gauss4"'
        raise TypeError(f"methods are given one by one, as text: {call}({example})")
    if any(not method.strip() for method in methods):
        raise ValueError(f'a method is empty: name it, such as {call}("midpoint"), or leave it out')
    return list(methods)


def _flat(methods: Sequence[Any]) -> list[str]:
    """The names in a list that stands in their place."""
    inner = [name for method in methods if isinstance(method, (list, tuple)) for name in method]
    return [name for name in inner if isinstance(name, str)]
