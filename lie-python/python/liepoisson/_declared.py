"""What was declared: names, parameters, states, the mathematics."""

from __future__ import annotations

import json
import os
import re
from collections.abc import Mapping
from numbers import Rational
from typing import Any

import numpy as np

from . import _core, _methods
from ._arguments import SLIPS, VARIANTS, Array, among, asked, hint, merged, number, spelled
from ._check import Check
from ._check import read as read_check
from ._errors import DeclarationError
from ._methods import Methods, labels_of
from ._sites import Sites


class Declared:
    """A declaration that passed every check."""

    def __init__(self, spec: str | Mapping[str, Any] | None = None, /, **keys: Any) -> None:
        if isinstance(spec, (str, os.PathLike)):
            if keys:
                raise TypeError("give the text of a spec or its keys, not both")
            if not isinstance(spec, str) or (spec.endswith(".json") and "{" not in spec):
                raise TypeError(f"this is the name of a file: liepoisson.load({os.fspath(spec)!r})")
            text = spec
        elif spec is not None and not isinstance(spec, Mapping):
            raise TypeError(
                f"a system is the text of a spec, a dictionary of its keys, or the keys by name, not {spec!r}"
            )
        else:
            declaration = {"format": 1, "name": "System", **dict(spec or {}), **keys}
            algebra = declaration.get("algebra")
            if algebra is None and "poisson" not in declaration:
                raise DeclarationError(
                    'schema: the algebra is missing\n  help: algebra="so(3)", or '
                    'algebra={"basis": ["e1", "e2", "e3"], "brackets": ["[e1, e2] = e3", …]}',
                    "schema",
                )
            text = json.dumps(declaration, indent=2, ensure_ascii=False, default=plain)
        self._core = _core.Core(text)
        values = self._core.parameters
        self._defaults = {name: values[name] for name in self._core.parameter_names()}
        #: The places of the coordinates that users see, where these are not all.
        self._seen: list[int] | None = None
        if not self._core.family and len(self._core.shown()) < len(self._core.coordinates):
            self._seen = self._core.shown()

    # a system is its text: other processes compile it again
    def __reduce__(self) -> tuple[object, ...]:
        return type(self), (self._core.text,)

    @property
    def name(self) -> str:
        """The name of the system."""
        return self._core.name

    @property
    def text(self) -> str:
        """The declaration as JSON."""
        return self._core.text

    @property
    def dimension(self) -> int:
        """The number of coordinates; of a family at the default parameters."""
        return self._dimension(list(self.parameters.values()))

    @property
    def coordinates(self) -> list[str]:
        """The names of the coordinates; what carries the time of a Hamiltonian that depends on it is none.

        Of a family those of all sites at the default parameters.
        """
        if self._core.family:
            return self._core.names_of_sites(list(self.parameters.values()))
        names = self._core.coordinates
        return [names[place] for place in self._core.shown()]

    @property
    def parameters(self) -> dict[str, float]:
        """The parameters with their defaults."""
        return dict(self._defaults)

    @property
    def casimirs(self) -> list[str]:
        """The names of the Casimirs, declared and found."""
        return self._core.casimirs

    @property
    def quantities(self) -> list[str]:
        """The names of what is recorded beside the state: first integrals and observables."""
        return [name for name, _ in self._core.quantities]

    @property
    def initial(self) -> Array | None:
        """The declared initial state at the default parameters."""
        found = self._core.initial(list(self.parameters.values()))
        return None if found is None else self._visible(found)

    def _dimension(self, values: list[float]) -> int:
        return Sites(self, values).dimension if self._core.family else len(self._core.shown())

    def _visible(self, mu: Array) -> Array:
        """States without what carries the time."""
        seen = self._seen
        return mu if seen is None or len(seen) == mu.shape[-1] else mu[..., seen]

    def __repr__(self) -> str:
        if self._core.family:
            shape = " x ".join(str(n) for n in Sites(self, list(self.parameters.values())).shape)
            return f"<System {self.name}: {shape} sites with {', '.join(self._core.coordinates)}>"
        return f"<System {self.name}: {', '.join(self.coordinates)}>"

    def _values(self, given: Mapping[str, Any]) -> list[float]:
        values = self.parameters
        for name, value in given.items():
            if name not in values:
                if name in ("params", "args"):
                    example = next(iter(values), "k")
                    raise TypeError(f"parameters are given by their names: {example}=…")
                if name in VARIANTS:
                    raise TypeError(
                        f'`{name}` stands with the method: run("METHOD --{name} {value}")'
                    )
                if name in SLIPS:
                    raise TypeError(f"no argument `{name}`; here it is `{SLIPS[name]}`")
                known = ", ".join(values) or "none"
                raise TypeError(
                    f"{self.name} has no parameter `{name}`{hint(name, list(values))} (parameters: {known})"
                )
            values[name] = number(value, f"the parameter {name}")
        return list(values.values())

    def _state(self, x0: Any, values: list[float]) -> Any:
        """An initial state in the order of the core."""
        if x0 is None:
            return None
        if self._core.family:
            if isinstance(x0, Mapping):
                raise TypeError(
                    "x0 of a family is an array: with a row of coordinates for each site"
                )
            return Sites(self, values).state(x0)
        names = self.coordinates
        if isinstance(x0, Mapping):
            if any(name not in names for name in x0):
                names = self._core.coordinates
            unknown = [name for name in x0 if name not in names]
            if unknown:
                raise ValueError(f"no coordinate `{unknown[0]}`{among(unknown[0], names)}")
            missing = [name for name in names if name not in x0]
            if missing:
                raise ValueError(f"x0 lacks {', '.join(missing)}")
            return [x0[name] for name in names]
        if isinstance(x0, (list, tuple, np.ndarray)) and np.ndim(np.asarray(x0, dtype=object)) > 1:
            raise ValueError(
                f"x0 has the shape {np.shape(np.asarray(x0, dtype=object))}, and is one state of {len(names)} numbers; "
                "ensemble takes many"
            )
        return x0

    def _asked(
        self,
        options: dict[str, Any],
        parameters: Mapping[str, Any] | None,
        named: Mapping[str, Any],
    ) -> dict[str, Any]:
        """What a call asks for; what it leaves out, the declaration says."""
        others = dict(named)
        spelled(options, others, self._defaults)
        method = options.pop("method", None)
        if method is not None and not isinstance(method, str):
            raise TypeError(f"the method is its id as text, such as 'lie-midpoint', not {method!r}")
        values = self._values(merged(parameters, others))
        if "x0" in options:
            options["x0"] = self._state(options["x0"], values)
        found = {"parameters": values, **asked(options)}
        return found if method is None else {"method": method, **found}

    def methods(self) -> Methods:
        """Every :class:`Method` by its id: order, symmetry, what it keeps, and why it does not apply.

        >>> from liepoisson import System
        >>> body = System(algebra="so(3)", state=["x", "y", "z"], hamiltonian="x^2/2 + y^2/4 + z^2/6")
        >>> midpoint = body.methods()["midpoint"]
        >>> midpoint.order, midpoint.symmetric, midpoint.explicit, midpoint.applies
        (2, True, False, True)
        >>> body.methods()["euler-arnold2"].applies
        False
        """
        return _methods.read(self._core.methods())

    def check(self, *, deep: bool = False) -> Check:
        """What the declaration is, as `lie check` says it: ranks, Casimirs, the algebra, constants of the motion, splitting.

        ``deep`` searches longer for Casimirs and constants of the motion.

        >>> from liepoisson import System
        >>> body = System(algebra="so(3)", state=["x", "y", "z"], hamiltonian="x^2/2 + y^2/4 + z^2/6")
        >>> found = body.check()
        >>> found.generic_rank, found.algebra, found.algebra_class["semisimple"]
        (2, 'so(3)', True)
        >>> [(casimir.name, casimir.expression) for casimir in found.casimirs]
        [('C1', 'x^2 + y^2 + z^2')]
        """
        if not isinstance(deep, bool):
            raise TypeError(f"deep is True or False, not {deep!r}")
        return read_check(self._core.check(deep))

    def rust(self, *methods: str) -> str:
        """The generated Rust, with fused code of these methods."""
        return self._core.rust(labels_of("rust", methods))

    def latex(self) -> str:
        """The Hamiltonian and, where they are not too long, the equations of motion for LaTeX."""
        hidden = [name for name in self._core.coordinates if name not in self.coordinates]
        lines = self._core.equations()
        if hidden:  # the momentum of the time is a summand of the larger space's H
            lines = [
                re.sub(rf" \+ {re.escape(hidden[0])}\b", "", line)
                for line in lines
                if not line.startswith(tuple(f"{name}'" for name in hidden))
            ]
        body = self._core.latex(lines) or r"\text{the Hamiltonian is not known as a formula}"
        return r"\begin{aligned}" + body + r"\end{aligned}"


def plain(value: Any) -> Any:
    """numpy's numbers and arrays as JSON."""
    if isinstance(value, np.ndarray):
        return value.tolist()
    if isinstance(value, np.generic):
        return value.item()
    if isinstance(value, Rational):
        return str(value)
    raise TypeError(f"{value!r} cannot stand in a declaration: give numbers and text")
