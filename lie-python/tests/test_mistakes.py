"""Typical mistakes: each is refused by the right error, whose text names the remedy, and the remedy works.

Where a message has the correction itself, between backticks, that is put in the place of the mistake, and must give what was meant. The
others say in words what to do; there the correction is written by hand beside the mistake.
"""

from __future__ import annotations

import ast
import json
import pathlib
import re
from collections.abc import Callable, Iterator
from typing import Any

import liepoisson as lp
import numpy as np
import pytest

SO3: dict[str, Any] = {
    "algebra": "so(3)",
    "state": ["x", "y", "z"],
    "parameters": {"I1": 2, "I2": 1, "I3": "2/3"},
    "hamiltonian": "x^2/(2*I1) + y^2/(2*I2) + z^2/(2*I3)",
    "initial": ["4/5", "1/10", "3/5"],
}
CASIMIR = "C = x^2 + y^2 + z^2"
BRACKETS: dict[str, Any] = {
    "basis": ["e1", "e2", "e3"],
    "brackets": ["[e1, e2] = e3", "[e2, e3] = e1", "[e3, e1] = e2"],
}


def spec(**keys: Any) -> dict[str, Any]:
    return {**SO3, **keys}


def without(*names: str, **keys: Any) -> dict[str, Any]:
    return {name: value for name, value in {**SO3, **keys}.items() if name not in names}


KINDS = {
    "antisymmetry",
    "arity",
    "constant",
    "domain",
    "empty-hamiltonian",
    "state-length",
    "unknown-function",
    "duplicate-name",
    "jacobi",
    "casimir",
    "limit",
    "method",
    "number",
    "option",
    "reserved-name",
    "schema",
    "syntax",
    "unknown-symbol",
}

#: A wrong declaration, what the message says, and the declaration after its hint.
DECLARATIONS: list[tuple[dict[str, Any], str, dict[str, Any]]] = [
    (spec(hamiltonian="x**2/2"), r"\^", spec(hamiltonian="x^2/2")),
    (spec(hamiltonian="np.sin(x)"), "sin", spec(hamiltonian="sin(x)")),
    (spec(hamiltonian="numpy.exp(x)"), "exp", spec(hamiltonian="exp(x)")),
    (spec(hamiltonian="math.sqrt(1 + x^2)"), "sqrt", spec(hamiltonian="sqrt(1 + x^2)")),
    (spec(hamiltonian="x[0]^2/2"), "x", spec(hamiltonian="x^2/2")),
    (spec(hamiltonian="Sin(x)"), "sin", spec(hamiltonian="sin(x)")),
    (spec(hamiltonian="ln(1 + x^2)"), "log", spec(hamiltonian="log(1 + x^2)")),
    (spec(hamiltonian="arctan(x)"), "atan", spec(hamiltonian="atan(x)")),
    (spec(hamiltonian="2x"), r"\*", spec(hamiltonian="2*x")),
    (spec(hamiltonian="x y"), r"\*", spec(hamiltonian="x*y")),
    (spec(hamiltonian="(x + y"), r"\)", spec(hamiltonian="(x + y)")),
    (spec(hamiltonian="x + y)"), r"\)", spec(hamiltonian="x + y")),
    (spec(hamiltonian="x +"), "expression|operand|number|ends", spec(hamiltonian="x")),
    (spec(hamiltonian=""), "empty|missing|expression|nothing", spec(hamiltonian="x")),
    (spec(hamiltonian="x^2/2 = 1"), "=", spec(hamiltonian="x^2/2")),
    (spec(hamiltonian="m1^2/2"), "x", spec(hamiltonian="x^2/2")),
    (spec(hamiltonian="x^2/(2*I4)"), "I1", spec(hamiltonian="x^2/(2*I1)")),
    (spec(hamiltonian="X^2/2"), "x", spec(hamiltonian="x^2/2")),
    (spec(hamiltonian="e1^2/2"), "state|coordinate", spec(hamiltonian="x^2/2")),
    (spec(hamiltonian="x^2/2 + PI"), "pi", spec(hamiltonian="x^2/2 + pi")),
    (spec(hamiltonian="pow(x, 2)"), r"\^|pow", spec(hamiltonian="x^2")),
    (spec(hamiltonian="abs x"), r"\(", spec(hamiltonian="abs(x)")),
    (spec(hamiltonian="atan2(x)"), "two|2", spec(hamiltonian="atan2(x, y)")),
    (spec(hamiltonian="sin(x, y)"), "one|1", spec(hamiltonian="sin(x)")),
    (spec(hamiltonian="x^2/0"), "zero|0", spec(hamiltonian="x^2/2")),
    (spec(hamiltonian="1,5*x"), ",|decimal", spec(hamiltonian="1.5*x")),
    (spec(hamiltonian="x·y"), r"\*", spec(hamiltonian="x*y")),
    (spec(hamiltonian="x²/2"), r"\^", spec(hamiltonian="x^2/2")),
    (
        spec(hamiltonian="sqrt(x)", initial=[-1, 1, 1]),
        "sqrt|negative|defined",
        spec(hamiltonian="sqrt(x)"),
    ),
    (without("hamiltonian"), "hamiltonian", spec()),
    (without("algebra"), "algebra", spec()),
    (spec(algebra="SO(3)"), "`so`", spec(algebra="so(3)")),
    (spec(algebra="so3"), r"so\(3\)|so\(n\)", spec(algebra="so(3)")),
    (spec(algebra="so(2.5)"), "whole|number|integer|so", spec(algebra="so(3)")),
    (spec(algebra="su(2) + "), "algebra|summand|ends|expected|behind", spec(algebra="su(2)")),
    (spec(algebra="sphere"), "algebra", spec(algebra="so(3)")),
    (spec(algebra=3), "algebra|string|text", spec(algebra="so(3)")),
    (spec(state=["x", "y"]), "3|three", spec()),
    (spec(state=["x", "y", "y"]), "y", spec()),
    (spec(state="x, y, z"), "list|array|sequence", spec()),
    (spec(state=["x", "y", "2z"]), "2z|name", spec()),
    (spec(state=["x", "y", "sin"]), "sin", spec()),
    (spec(state=["x", "y", "pi"]), "pi", spec()),
    (spec(initial=[1, 2]), "3|three", spec(initial=[1, 2, 3])),
    (spec(initial=["a", 2, 3]), "a", spec(initial=[1, 2, 3])),
    (spec(initial=[[1, 2, 3]]), "initial|number|list", spec(initial=[1, 2, 3])),
    (
        spec(initial="1, 2, 3"),
        "list|array|sequence|initial",
        spec(initial=["1", "2", "3"]),
    ),
    (spec(parameters=["I1"]), "parameters|map|object", spec()),
    (spec(parameters={"I1": "two", "I2": 1, "I3": 1}), "two", spec()),
    (spec(parameters={"x": 1, "I1": 2, "I2": 1, "I3": 1}), "x", spec()),
    (
        without("parameters", parameter={"I1": 1, "I2": 1, "I3": 1}),
        "parameters",
        spec(parameters={"I1": 1, "I2": 1, "I3": 1}),
    ),
    (
        without("hamiltonian", Hamiltonian="x^2/2"),
        "hamiltonian",
        spec(hamiltonian="x^2/2"),
    ),
    (without("hamiltonian", H="x^2/2"), "H", spec(hamiltonian="x^2/2")),
    (spec(casimir=[CASIMIR]), "casimirs", spec(casimirs=[CASIMIR])),
    (spec(casimirs=CASIMIR), "list", spec(casimirs=[CASIMIR])),
    (spec(casimirs={"C": "x^2"}), "list", spec(casimirs=[CASIMIR])),
    (
        spec(casimirs=["C = x^2"]),
        "Casimir|casimir",
        spec(casimirs=[CASIMIR]),
    ),
    (spec(run={"stepsize": 1}), "step", spec(run={"step": 1})),
    (spec(run={"method": "rk5"}), "rk4", spec(run={"method": "rk4"})),
    (spec(format=2), "format|1", spec(format=1)),
    (
        spec(algebra={**BRACKETS, "brackets": ["[e1, e2] = e4", "[e2, e3] = e1", "[e3, e1] = e2"]}),
        "e4",
        spec(algebra=BRACKETS),
    ),
    (
        spec(algebra={**BRACKETS, "brackets": ["[e1, e2] = e1", "[e2, e3] = e1", "[e3, e1] = e2"]}),
        "Jacobi|jacobi",
        spec(algebra=BRACKETS),
    ),
    (
        spec(algebra={**BRACKETS, "brackets": ["[e1, e1] = e3"]}),
        "e1",
        spec(algebra=BRACKETS),
    ),
    (
        spec(algebra={**BRACKETS, "brackets": [*BRACKETS["brackets"], "[e2, e1] = e3"]}),
        "e1|twice|antisymmetric|sign",
        spec(algebra=BRACKETS),
    ),
    (spec(algebra={"brackets": BRACKETS["brackets"]}), "basis", spec(algebra=BRACKETS)),
]

Call = Callable[[lp.System], Any]

#: A wrong call, its error, what the message says, and the call after its hint.
CALLS: list[tuple[Call, type[Exception], str, Call]] = [
    (lambda s: s.run(dt=0.1), TypeError, "`h`", lambda s: s.run(h=0.1)),
    (lambda s: s.run(stepsize=0.1), TypeError, "`h`", lambda s: s.run(h=0.1)),
    (lambda s: s.run(max_step=0.1), TypeError, "`h`", lambda s: s.run(h=0.1)),
    (lambda s: s.run(y0=[1, 2, 3]), TypeError, "`x0`", lambda s: s.run(x0=[1, 2, 3])),
    (lambda s: s.run(mu0=[1, 2, 3]), TypeError, "`x0`", lambda s: s.run(x0=[1, 2, 3])),
    (lambda s: s.run(t_span=(0, 1)), TypeError, "`t`", lambda s: s.run(t=1)),
    (lambda s: s.run(t_eval=[0, 1]), TypeError, "`at`", lambda s: s.run(at=[0, 1])),
    (lambda s: s.run(tmax=1), TypeError, "`t`", lambda s: s.run(t=1)),
    (lambda s: s.run(tolerance=1e-6, t=1), TypeError, "`tol`", lambda s: s.run(tol=1e-6, t=1)),
    (lambda s: s.run(I4=1), TypeError, "I1", lambda s: s.run(I1=1)),
    (lambda s: s.run(i1=1), TypeError, "I1", lambda s: s.run(I1=1)),
    (lambda s: s.run(params={"I1": 1}), TypeError, "I1=", lambda s: s.run(I1=1)),
    (lambda s: s.run(args=(1,)), TypeError, "I1=", lambda s: s.run(I1=1)),
    (
        lambda s: s.run(retraction="cayley"),
        TypeError,
        "--retraction",
        lambda s: s.run("lie-midpoint --retraction cayley"),
    ),
    (lambda s: s.run("rk45"), lp.MethodError, "method", lambda s: s.run("dopri5")),
    (lambda s: s.run("RK4"), lp.MethodError, "rk4", lambda s: s.run("rk4")),
    (
        lambda s: s.run("lie_midpoint"),
        lp.MethodError,
        "lie-midpoint",
        lambda s: s.run("lie-midpoint"),
    ),
    (lambda s: s.run("midpoint", 0.1), TypeError, "positional", lambda s: s.run("midpoint", h=0.1)),
    (lambda s: s.run(""), lp.MethodError, "name one", lambda s: s.run("rk4")),
    (lambda s: s.run(0.1), TypeError, "id as text", lambda s: s.run(h=0.1)),
    (lambda s: s.run(h=0), ValueError, "step", lambda s: s.run(h=0.1)),
    (lambda s: s.run(h=-0.1), ValueError, "step|away|sign", lambda s: s.run(h=0.1)),
    (lambda s: s.run(h=float("nan")), ValueError, "step|NaN|finite", lambda s: s.run(h=0.1)),
    (lambda s: s.run(h="a"), ValueError, "a", lambda s: s.run(h="1/10")),
    (lambda s: s.run(tol=0, t=1), ValueError, "tolerance", lambda s: s.run(tol=1e-6, t=1)),
    (lambda s: s.run(h=0.1, tol=1e-6), TypeError, "both given", lambda s: s.run(tol=1e-6, t=1)),
    (lambda s: s.run(x0=[1, 2]), ValueError, "a state of 3", lambda s: s.run(x0=[1, 2, 3])),
    (
        lambda s: s.run(x0=[1, 2, float("nan")]),
        ValueError,
        "z: `nan` is not a finite number",
        lambda s: s.run(x0=[1, 2, 3]),
    ),
    (
        lambda s: s.run(x0={"x": 1, "y": 2}),
        ValueError,
        "lacks z",
        lambda s: s.run(x0={"x": 1, "y": 2, "z": 3}),
    ),
    (lambda s: s.run(x0={"x": 1, "y": 2, "w": 3}), ValueError, "w", lambda s: s.run(x0=[1, 2, 3])),
    (lambda s: s.run(every=0), ValueError, "1, 2, 3", lambda s: s.run(every=1)),
    (lambda s: s.run(at=[]), ValueError, "empty", lambda s: s.run(at=[0, 1, 2])),
    (lambda s: s.run(at=[0, 1], t=2), TypeError, "leave out", lambda s: s.run(at=[0, 1])),
    (
        lambda s: s.run("midpoint", rtol=1e-6),
        lp.MethodError,
        "dopri5",
        lambda s: s.run("dopri5", rtol=1e-6),
    ),
    (
        lambda s: s.run("dopri5", tol=1e-6),
        lp.MethodError,
        "rtol",
        lambda s: s.run("dopri5", rtol=1e-6),
    ),
    (
        lambda s: s.run("splitting2 --pieces coordinates"),
        lp.MethodError,
        "coordinate",
        lambda s: s.run("splitting2 --pieces coordinate"),
    ),
    (
        lambda s: lp.System(**spec(run={"step": 0})).run(),
        ValueError,
        "step",
        lambda s: lp.System(**spec(run={"step": 1})).run(),
    ),
    (lambda s: s.run(t="later"), ValueError, "later", lambda s: s.run(t="1/2")),
    (lambda s: s.run(t=1)["energi"], KeyError, "energy", lambda s: s.run(t=1)["energy"]),
    (lambda s: s.run(t=1)["w"], KeyError, "There are", lambda s: s.run(t=1)["x"]),
    (lambda s: s.function("rhs"), ValueError, "vector_field", lambda s: s.function("vector_field")),
    (
        lambda s: s.function("vector_field")([1.0, 2.0]),
        ValueError,
        "must have 3 entries",
        lambda s: s.function("vector_field")([1.0, 2.0, 3.0]),
    ),
    (
        lambda s: s.ensemble(np.ones((4, 2)), t=1),
        ValueError,
        "members, 3",
        lambda s: s.ensemble(np.ones((4, 3)), t=1),
    ),
    (
        lambda s: s.ensemble(np.ones((4, 3)), t=1, I1=np.ones(3)),
        ValueError,
        "4 members",
        lambda s: s.ensemble(np.ones((4, 3)), t=1, I1=np.ones(4)),
    ),
    (
        lambda s: s.ensemble(np.ones((4, 3)), t=1, threads=0),
        ValueError,
        "1, 2, 3",
        lambda s: s.ensemble(np.ones((4, 3)), t=1, threads=1),
    ),
    (
        lambda s: s.ensemble(np.ones((4, 3)), tol=1e-6, t=1, every=2),
        TypeError,
        "at=",
        lambda s: s.ensemble(np.ones((4, 3)), tol=1e-6, at=[0, 1]),
    ),
    (
        lambda s: s.ensemble(np.ones((4, 3)), tol=1e-6, h=0.1, t=1),
        TypeError,
        "both given",
        lambda s: s.ensemble(np.ones((4, 3)), tol=1e-6, t=1),
    ),
    (
        lambda s: s.ensemble(np.ones((4, 3)), tol=0, t=1),
        ValueError,
        "tolerance",
        lambda s: s.ensemble(np.ones((4, 3)), tol=1e-6, t=1),
    ),
    (
        lambda s: s.ensemble(np.ones((4, 3)), h=0.1, at=[-1, 2]),
        ValueError,
        "both sides of t = 0",
        lambda s: s.ensemble(np.ones((4, 3)), h=0.1, at=[1, 2]),
    ),
    (
        lambda s: s.ensemble(np.ones((4, 3)), t=1, every=0),
        ValueError,
        "1, 2, 3",
        lambda s: s.ensemble(np.ones((4, 3)), t=1, every=1),
    ),
    (
        lambda s: s.ensemble(np.ones((4, 3)), "rk4", t=1, iteration="newton"),
        lp.MethodError,
        "midpoint",
        lambda s: s.ensemble(np.ones((4, 3)), "midpoint", t=1, iteration="newton"),
    ),
    (
        lambda s: lp.System(**spec(hamiltonian="x*cos(t)", parameters={})).function("gradient")(
            np.ones((4, 3)), [0.0, 1.0]
        ),
        ValueError,
        "one for each state",
        lambda s: lp.System(**spec(hamiltonian="x*cos(t)", parameters={})).function("gradient")(
            np.ones((4, 3)), [0.0, 1.0, 2.0, 3.0]
        ),
    ),
    (
        lambda s: s.bench(["rk4", "gauss4"]),
        TypeError,
        r'bench\("rk4", "gauss4"\)',
        lambda s: s.bench("rk4", "gauss4"),
    ),
    (
        lambda s: s.bench("rk5", t=1, budget=1e-4),
        lp.MethodError,
        "rk4",
        lambda s: s.bench("rk4", t=1, budget=1e-4),
    ),
    (
        lambda s: s.bench("rk4", h=0.1),
        TypeError,
        "many steps",
        lambda s: s.bench("rk4", t=1, budget=1e-4),
    ),
    (
        lambda s: s.bench("rk4", t=0, budget=1e-4),
        ValueError,
        "t=10",
        lambda s: s.bench("rk4", t=10, budget=1e-4),
    ),
    (
        lambda s: s.bench("rk4", t=1, budget=1e-4, measure="enrgy"),
        ValueError,
        "`energy`",
        lambda s: s.bench("rk4", t=1, budget=1e-4, measure="energy"),
    ),
    (
        lambda s: s.bench("rk4", t=10, budget=1e-4, section=("y", 0)),
        TypeError,
        'measure="section"',
        lambda s: s.bench("rk4", t=10, budget=1e-4, section=("y", 0), measure="section"),
    ),
    (
        lambda s: s.bench(
            "rk4", t=10, budget=1e-4, section="x=0", measure="section", x0=[0.1, 0.1, 1]
        ),
        TypeError,
        r'section=\("x", 0\)',
        lambda s: s.bench(
            "rk4", t=10, budget=1e-4, section=("x", 0), measure="section", x0=[0.1, 0.1, 1]
        ),
    ),
    (
        lambda s: s.bench("rk4", t=1, budget=0),
        ValueError,
        "budget=0.2",
        lambda s: s.bench("rk4", t=1, budget=0.2),
    ),
    (
        lambda s: s.bench("rk4", t=1, budget=1e-4)["errors"],
        KeyError,
        "`error`",
        lambda s: s.bench("rk4", t=1, budget=1e-4)["error"],
    ),
    (
        lambda s: s.bench("rk4", t=1, budget=1e-4).of("rk5"),
        KeyError,
        "`rk4`",
        lambda s: s.bench("rk4", t=1, budget=1e-4).of("rk4"),
    ),
    (lambda s: s.check(deep="yes"), TypeError, "True or False", lambda s: s.check(deep=True)),
    (lambda s: s.methods()["rk5"], KeyError, "`rk4`", lambda s: s.methods()["rk4"]),
    (lambda s: lp.System("body.json"), TypeError, "load", lambda s: lp.System(s.text)),
]


#: Words before a correction; what stands between the backticks behind them is meant literally.
SAYS = r"(?:write|did you mean|is written|here it is|point: write) `([^`]+)`"


def corrections(message: str) -> list[str]:
    return re.findall(SAYS, message)


def extents(line: str, place: int) -> Iterator[tuple[int, int]]:
    """Parts of a line that contain a place, the shortest first."""
    found = [(i, j) for i in range(place + 1) for j in range(place + 1, len(line) + 1)]
    return iter(sorted(found, key=lambda part: part[1] - part[0]))


def bare(declaration: dict[str, Any]) -> str:
    """A declaration as text, without blanks and without what has defaults."""
    return re.sub(r"\s", "", json.dumps({"format": 1, **declaration}, sort_keys=True))


def applied_to_text(
    wrong: dict[str, Any], error: lp.DeclarationError, right: dict[str, Any]
) -> bool:
    """Whether a correction of the message, at the place of the first mistake, gives what was meant."""
    written = {"format": 1, "name": "System", **wrong}
    lines = json.dumps(written, indent=2, ensure_ascii=False).splitlines()
    if error.line is None or error.column is None:
        return False
    line, place = lines[error.line - 1], error.column - 1
    meant = bare({"name": "System", **right})
    first = str(error).split("\n  help: ")[1].split("\n")[0]
    for correction in corrections(first):
        for start, end in extents(line, place):
            lines[error.line - 1] = line[:start] + correction + line[end:]
            try:
                declaration = json.loads("\n".join(lines))
            except ValueError:
                continue
            if bare(declaration) == meant:
                lp.System(declaration)
                return True
    return False


def sources() -> list[tuple[str, str]]:
    """The wrong and the right calls as they are written in this file."""
    text = pathlib.Path(__file__).read_text("utf-8")
    lists = [
        node.value
        for node in ast.parse(text).body
        if isinstance(node, ast.AnnAssign) and getattr(node.target, "id", "") == "CALLS"
    ]
    assert len(lists) == 1 and isinstance(lists[0], ast.List)
    found = []
    for row in lists[0].elts:
        assert isinstance(row, ast.Tuple)
        calls = [call.body for call in row.elts if isinstance(call, ast.Lambda)]
        wrong, right = (ast.unparse(call) for call in calls)
        found.append((wrong, right))
    return found


def same(one: ast.expr, other: ast.expr) -> bool:
    """Whether two calls are the same but for the order of keywords."""
    for call in (one, other):
        for node in ast.walk(call):
            if isinstance(node, ast.Call):
                node.keywords.sort(key=lambda keyword: keyword.arg or "")
    return ast.dump(one) == ast.dump(other)


def parsed(text: str) -> ast.expr | None:
    try:
        return ast.parse(text, mode="eval").body
    except SyntaxError:
        return None


#: An argument, and a call of a method, as a message shows them.
ARGUMENT = r"\b(\w+)=(\([^()]*\)|\[[^\[\]]*\]|\"[^\"]*\"|[-\d.e]+\b)"
CALL = r"\b(\w+)(\((?:\"[^\"]*\"(?:, )?)+\))"


def variants(wrong: str, message: str) -> Iterator[ast.expr | None]:
    """The wrong call with what the message says in the place of what it quotes."""
    for correction in re.findall(SAYS, message):
        for word in re.findall(r"[`']([^`']+)[`']", message):
            for part in re.finditer(rf"(?<!\w){re.escape(word)}(?!\w)", wrong):
                yield parsed(wrong[: part.start()] + correction + wrong[part.end() :])
    for name, value in re.findall(ARGUMENT, message):
        call, given = parsed(wrong), parsed(value)
        if isinstance(call, ast.Call) and given is not None:
            others = [keyword for keyword in call.keywords if keyword.arg != name]
            call.keywords = [*others, ast.keyword(arg=name, value=given)]
            yield call
    for name, arguments in re.findall(CALL, message):
        call, given = parsed(wrong), parsed(name + arguments)
        named = isinstance(call, ast.Call) and isinstance(call.func, ast.Attribute)
        if named and call.func.attr == name:  # type: ignore[union-attr]
            call.args = given.args  # type: ignore[union-attr]
            yield call


def applied_to_call(wrong: str, message: str, right: str) -> bool:
    """Whether what the message says gives the call that was meant: a word in the place of the one that it quotes, an argument in that
    of the same name, or the whole call."""
    meant = parsed(right)
    assert meant is not None
    found = (variant for variant in variants(wrong, message) if variant is not None)
    return any(same(variant, meant) for variant in found)


#: Declarations and calls whose message has the correction itself; the others are corrected by hand. Fewer are a loss.
LITERAL = (28, 31)


def of_declaration(number: int) -> tuple[str, lp.DeclarationError]:
    with pytest.raises(lp.DeclarationError) as caught:
        lp.System(**DECLARATIONS[number][0])
    # what is said, without the line of the declaration that is shown
    lines = [line for line in str(caught.value).splitlines() if not line.startswith("    ")]
    return "\n".join(lines), caught.value


@pytest.mark.parametrize("number", range(len(DECLARATIONS)))
def test_a_wrong_declaration_is_refused(number: int) -> None:
    _, says, right = DECLARATIONS[number]
    lp.System(**right)
    message, error = of_declaration(number)
    assert re.search(says, message), message
    assert "help: " in message, message
    assert error.kind in KINDS, message
    # commands are for the command
    assert "`lie " not in message, message


@pytest.mark.parametrize("number", range(len(CALLS)))
def test_a_wrong_call_is_refused(number: int) -> None:
    wrong, error, says, right = CALLS[number]
    system = lp.System(**SO3)
    right(system)
    with pytest.raises(error, match=says):
        wrong(system)


def test_corrections_in_messages_are_meant_literally() -> None:
    literal: tuple[list[int], list[int]] = ([], [])
    for number, (wrong, _, right) in enumerate(DECLARATIONS):
        if applied_to_text(wrong, of_declaration(number)[1], right):
            literal[0].append(number)
    system = lp.System(**SO3)
    for number, ((wrong_text, right_text), (call, error, _, _)) in enumerate(zip(sources(), CALLS)):
        with pytest.raises(error) as caught:
            call(system)
        if applied_to_call(wrong_text, str(caught.value), right_text):
            literal[1].append(number)
    found = tuple(len(numbers) for numbers in literal)
    assert found == LITERAL, (found, literal)
    # the control: a correction elsewhere is not what was meant
    assert not applied_to_call("s.run(dt=0.1)", "no argument `dt`; here it is `h`", "s.run(t=0.1)")
    assert not applied_to_text(
        spec(hamiltonian="2x"), of_declaration(8)[1], spec(hamiltonian="3*x")
    )
    assert len(DECLARATIONS) + len(CALLS) >= 100
