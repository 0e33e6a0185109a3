import numpy as np
import numpy.typing as npt
from typing_extensions import TypeAlias

Array: TypeAlias = npt.NDArray[np.float64]

class Core:
    text: str
    name: str
    coordinates: list[str]
    parameters: dict[str, float]
    casimirs: list[str]
    def __init__(self, text: str) -> None: ...
    def initial(self, parameters: list[float]) -> Array | None: ...
    def complete(self, given: list[float]) -> list[float] | None: ...
    def shown(self) -> list[str]: ...
    def run_options(self) -> dict[str, list[str]]: ...
    def usual_method(self) -> str: ...
    def methods(self) -> list[tuple[str, str | None]]: ...
    def verify(
        self,
        methods: list[str],
        parameters: list[float],
        start: list[float],
        options: tuple[float | None, int],
    ) -> tuple[list[tuple[str, str, float, float, float, str, str, float]], list[str]]: ...
    def rust(self, methods: list[str]) -> str: ...
    def equations(self) -> list[str]: ...
    def parameter_names(self) -> list[str]: ...
    def run(
        self,
        label: str,
        parameters: list[float],
        start: list[float],
        pace: tuple[float | None, float | None],
        end: float,
        every: int,
        at: list[float] | None,
        tolerances: tuple[float | None, float | None],
        solver: dict[str, object],
        group: str | None,
    ) -> tuple[tuple[Array, Array, Array, Array], dict[str, object]]: ...
    def evaluate(self, kernel: str, parameters: list[float], states: Array) -> Array: ...
    def ensemble(
        self,
        label: str,
        parameters: Array,
        starts: Array,
        step: float,
        end: float,
        threads: int,
        tolerances: tuple[float | None, float | None],
        solver: dict[str, object],
    ) -> tuple[Array, list[tuple[int, float, str]]]: ...

def constant(text: str) -> float: ...
def catalogue() -> list[tuple[str, int]]: ...
