"""The exceptions of the package."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from ._ensemble import Ensemble

__all__ = ["DeclarationError", "IntegrationError", "Interrupted", "LostShares", "MethodError"]


class DeclarationError(ValueError):
    """A declaration with a mistake.

    ``kind`` is the kind of the first mistake, ``line`` and ``column`` are its place in the JSON text, counted from 1.
    The message lists all mistakes, each with its remedy.
    """

    def __init__(
        self, message: str, kind: str, line: int | None = None, column: int | None = None
    ) -> None:
        super().__init__(message)
        self.kind = kind
        self.line = line
        self.column = column

    def __reduce__(self) -> tuple[object, ...]:
        return type(self), (str(self), self.kind, self.line, self.column)


class MethodError(ValueError):
    """A method that there is not, or that does not apply to the system."""


class IntegrationError(RuntimeError):
    """A run that stopped early.

    ``partial`` is the :class:`Solution` up to there, or the :class:`Exponents`, ``step`` the number of the step that failed, ``time`` the
    time before it.
    """

    def __init__(self, message: str, partial: Any, step: int, time: float) -> None:
        super().__init__(message)
        self.partial = partial
        self.step = step
        self.time = time

    def __reduce__(self) -> tuple[object, ...]:
        return type(self), (str(self), self.partial, self.step, self.time)


class LostShares(RuntimeError):
    """An ensemble of which some workers ended, and their shares with them.

    ``missing`` are the members that are not there, a range for each share; ``partial`` is the :class:`Ensemble` of the others, in
    which those are not numbers. The same call does the missing shares alone.
    """

    def __init__(self, message: str, missing: list[range], partial: Ensemble) -> None:
        super().__init__(message)
        self.missing = missing
        self.partial = partial

    def __reduce__(self) -> tuple[object, ...]:
        return type(self), (str(self), self.missing, self.partial)


class Interrupted(KeyboardInterrupt):
    """A measurement that Ctrl-C ended.

    ``partial`` has what there was: a :class:`Bench`, a :class:`Stress`, a :class:`Verification` or :class:`Exponents`, whose ``complete`` is false.
    """

    def __init__(self, message: str, partial: Any) -> None:
        super().__init__(message)
        self.partial = partial

    def __reduce__(self) -> tuple[object, ...]:
        return type(self), (str(self), self.partial)
