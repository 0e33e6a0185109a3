"""What a declaration is, and what can be done with it."""

from __future__ import annotations

import json
from typing import Any, NamedTuple

from ._pictures import page, table

__all__ = ["Casimir", "Check", "Motion"]


class Casimir(NamedTuple):
    """A function that is constant for every Hamiltonian; ``kind``: "declared", "polynomial", "rational" or "function". Not ``kept`` where
    forces change it."""

    name: str
    expression: str
    kind: str
    degree: int | None
    kept: bool = True


class Motion(NamedTuple):
    """A polynomial that is constant along the motion."""

    expression: str
    degree: int


class Check:
    """What `lie check --json` says of a system.

    ``dimension``: of the Poisson space, in which a Hamiltonian that depends on the time has three coordinates more than the user
    gave. ``generic_rank``: of the Poisson matrix at a generic state. ``initial_rank``: at the initial state, ``None`` without
    one. ``casimirs``: a list of :class:`Casimir`, functionally independent. ``acting``: what acts beside the Hamiltonian, each with
    its formula. ``attitude``: the group element at the start, if it is declared. ``integrals``, ``observables``: those that are declared, by name. ``independent_casimirs``: how many there can be.
    ``algebra``: the name of the algebra, if it was recognised. ``algebra_class``: "abelian", "nilpotent", "solvable",
    "semisimple", "reductive", "unimodular", each true or false. ``series``: dimensions of the derived and of the lower central
    series, of centre and radical. ``killing``: the signature of the Killing form. The last four are ``None`` where there is
    no Lie algebra. ``constants_of_motion``: a list of :class:`Motion`, ``None`` where none were looked for. ``splitting``: the
    pieces of H with exact flows, each a list of terms, ``None`` where there are none. ``splitting_cost``: multiplications of a
    step. ``brackets``: the Poisson brackets of the state, as ``poisson`` takes them. ``canonical``: of each pair of position and
    momentum its bracket, where mechanics runs ``forwards`` by it, and which way it does at the initial state. ``operations``: additions, multiplications, divisions and calls of each kernel. ``methods``: by id, ``None`` or why
    it does not apply. ``joints``: where branches of H meet. ``orders``: of methods across them, ``None`` without joints.
    ``warnings``: what is legal and looks wrong. ``json``: all of it as plain data.
    """

    def __init__(self, found: dict[str, Any]) -> None:
        self.json = found
        self.name: str = found["name"]
        self.dimension: int = found["dimension"]
        self.generic_rank: int = found["generic_rank"]
        self.initial_rank: int | None = found["initial_rank"]
        self.casimirs = [Casimir(**row) for row in found["casimirs"]]
        self.acting: list[tuple[str, str]] = [
            (row["what"], row["formula"]) for row in found["acting"]
        ]
        self.attitude: str | None = found.get("attitude")
        integrals, observables = found.get("integrals", []), found.get("observables", [])
        self.integrals: dict[str, str] = {row["name"]: row["expression"] for row in integrals}
        self.observables: dict[str, str] = {row["name"]: row["expression"] for row in observables}
        self.independent_casimirs: int = found["independent_casimirs"]
        self.algebra: str | None = found["algebra_name"]
        self.algebra_class: dict[str, bool] | None = found["class"]
        self.series: dict[str, Any] | None = found["series"]
        self.killing: dict[str, int] | None = found["killing"]
        motions = found["constants_of_motion"]
        self.constants_of_motion: list[Motion] | None = (
            None if motions is None else [Motion(**row) for row in motions]
        )
        self.splitting: list[list[str]] | None = found["splitting"]
        self.splitting_cost: dict[str, Any] | None = found["splitting_cost"]
        self.brackets: list[str] = found["brackets"]
        self.canonical: list[dict[str, Any]] = found["canonical"]
        self.operations: dict[str, dict[str, int]] = found["operations"]
        self.methods: dict[str, str | None] = found["methods"]
        self.joints: list[dict[str, Any]] = found["joints"]
        self.orders: dict[str, int | None] | None = found["orders"]
        self.warnings: list[str] = found["warnings"]

    def _lines(self) -> list[tuple[str, str]]:
        rank = "no initial state" if self.initial_rank is None else f"{self.initial_rank}"
        lines = [
            ("dimension", str(self.dimension)),
            ("generic rank", str(self.generic_rank)),
            ("rank at the initial state", rank),
        ]
        if self.algebra_class is not None:
            kinds = ", ".join(name for name, holds in self.algebra_class.items() if holds)
            lines.append(("algebra", f"{self.algebra or 'not recognised'} ({kinds or 'general'})"))
        for casimir in self.casimirs:
            changed = "" if casimir.kept else ", changed by what acts"
            text = f"{casimir.expression} ({casimir.kind}{changed})"
            lines.append((f"Casimir {casimir.name}", text))
        lines.extend(self.acting)
        if self.attitude is not None:
            lines.append(("attitude at the start", self.attitude))
        lines.extend((f"integral {name}", text) for name, text in self.integrals.items())
        if len(self.casimirs) < self.independent_casimirs:
            lines.append(("Casimirs", f"{len(self.casimirs)} of {self.independent_casimirs} known"))
        for pair in self.canonical:
            bracket = f"{{{pair['position']}, {pair['momentum']}}} = {pair['bracket']}"
            lines.append((bracket, f"mechanics runs forwards: {pair['forwards']}"))
        for motion in self.constants_of_motion or []:
            lines.append(("constant of the motion", motion.expression))
        if self.splitting is not None:
            pieces = "; ".join(", ".join(terms) for terms in self.splitting)
            lines.append(("pieces with exact flows", pieces))
        apply = [name for name, reason in self.methods.items() if reason is None]
        lines.append(("methods that apply", f"{len(apply)} of {len(self.methods)}"))
        return lines + [("warning", warning) for warning in self.warnings]

    def __repr__(self) -> str:
        """A line for each fact."""
        return "\n".join([self.name, *(f"  {name}: {value}" for name, value in self._lines())])

    def _repr_html_(self) -> str:
        kernels = [
            (kernel, *(str(count[key]) for key in ("add", "mul", "div", "call")))
            for kernel, count in self.operations.items()
        ]
        return page(
            self.name,
            table(["fact", ""], self._lines()),
            table(["operations of", "add", "mul", "div", "call"], kernels),
        )


def read(text: str) -> Check:
    """The report as the core gives it."""
    return Check(json.loads(text))
