from collections.abc import Callable
from typing import Any

import numpy as np
import numpy.typing as npt
from typing_extensions import TypeAlias

__version__: str

Array: TypeAlias = npt.NDArray[np.float64]

#: Times, states, energies, Casimirs; method, step, steps; the span; what is not of every run.
Made: TypeAlias = tuple[
    Array, Array, Array, Array, str, float, int, tuple[float, float], dict[str, Any] | None
]

class Core:
    text: str
    name: str
    coordinates: list[str]
    family: bool
    axes: int
    parameters: dict[str, float]
    casimirs: list[str]
    inputs: list[str]
    noisy: bool
    quantities: list[tuple[str, bool]]
    events: list[str]
    def __init__(self, text: str) -> None: ...
    def sites(self, parameters: list[float]) -> tuple[int, int, int] | None: ...
    def names_of_sites(self, parameters: list[float]) -> list[str]: ...
    def initial(self, parameters: list[float]) -> Array | None: ...
    def complete(
        self, given: list[list[float]], parameters: list[list[float]]
    ) -> list[list[float]] | None: ...
    def shown(self) -> list[int]: ...
    def time(self) -> int | None: ...
    def run_options(self) -> dict[str, list[str]]: ...
    def methods(self) -> str: ...
    def check(self, deep: bool) -> str: ...
    def canonical(self) -> str: ...
    def bench(
        self,
        methods: list[str],
        asked: dict[str, Any],
        options: tuple[float, str, tuple[int, float] | None],
        progress: Callable[[int, int, str], object] | None,
    ) -> dict[str, Any]: ...
    def verify(
        self,
        methods: list[str],
        asked: dict[str, Any],
        seed: int,
        progress: Callable[[int, int, str], object] | None,
    ) -> dict[str, Any]: ...
    def stress(
        self,
        methods: list[str],
        asked: dict[str, Any],
        steps: int,
        progress: Callable[[int, int, str], object] | None,
    ) -> dict[str, Any]: ...
    def exponents(
        self,
        asked: dict[str, Any],
        own: tuple[float, int | None],
        progress: Callable[[int, int, str], object] | None,
    ) -> dict[str, Any]: ...
    def rust(self, methods: list[str]) -> str: ...
    def equations(self) -> list[str]: ...
    def latex(self, lines: list[str]) -> str: ...
    def parameter_names(self) -> list[str]: ...
    def run(
        self,
        asked: dict[str, Any],
        options: tuple[Any, ...],
        progress: Callable[[int, int, str], object] | None,
    ) -> Made: ...
    def again(self, options: tuple[Any, ...], x0: Any, named: dict[str, Any]) -> Made | None: ...
    def kept(self, asked: dict[str, Any]) -> list[str]: ...
    def at(self, asked: dict[str, Any], times: list[float]) -> Array: ...
    def evaluate(self, kernel: str, parameters: list[float], states: Array) -> Array: ...
    def ensemble(
        self,
        parameters: Array,
        starts: Array,
        asked: dict[str, Any],
        options: tuple[int, bool],
        progress: Callable[[int, int, str], object] | None,
    ) -> tuple[
        Array,
        Array,
        list[tuple[int, float, str]],
        str | None,
        npt.NDArray[np.int64],
        Array,
        tuple[npt.NDArray[np.int64], npt.NDArray[np.int64], Array, Array],
    ]: ...
    def drawn(
        self, parameters: Array, around: list[float], asked: tuple[int, int, float | None]
    ) -> Array: ...

def constant(text: str) -> float: ...
def is_word(name: str) -> bool: ...
def columns(rows: list[list[str]]) -> str: ...
def lines(
    times: Array, values: Array, count: int, window: int
) -> tuple[float, list[tuple[float, float, float, list[float]]], float] | None: ...
