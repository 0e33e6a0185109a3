"""Random declarations: a spec, and the same Hamiltonian as a tree that the judge evaluates by itself."""

from dataclasses import dataclass
from fractions import Fraction

import algebras


class Node:
    """An expression: a number, a name, or an operation on others."""

    def __init__(self, kind, *parts):
        self.kind, self.parts = kind, parts

    def __add__(self, other):
        return Node("+", self, other)

    def __mul__(self, other):
        return Node("*", self, other)

    def __truediv__(self, other):
        return Node("/", self, other)

    def text(self):
        parts = self.parts
        match self.kind:
            case "number":
                return f"({parts[0]})" if parts[0].denominator != 1 or parts[0] < 0 else str(parts[0])
            case "name":
                return parts[0]
            case "^":
                return f"({parts[0].text()})^{parts[1]}"
            case "+" | "*" | "/":
                return f"({parts[0].text()} {self.kind} {parts[1].text()})"
            case function:
                return f"{function}({parts[0].text()})"

    def jet(self, values, calculus):
        """The value and the gradient. `values` has a jet for each name."""
        parts = self.parts
        match self.kind:
            case "number":
                return calculus.number(parts[0]), {}
            case "name":
                return values[parts[0]]
            case "^":
                value, slopes = parts[0].jet(values, calculus)
                factor = parts[1] * value ** (parts[1] - 1)
                return value ** parts[1], {k: factor * s for k, s in slopes.items()}
            case "+" | "*" | "/":
                (a, da), (b, db) = (part.jet(values, calculus) for part in parts)
                if self.kind == "+":
                    return a + b, join(da, 1, db, 1)
                if self.kind == "*":
                    return a * b, join(da, b, db, a)
                return a / b, join(da, 1 / b, db, -a / (b * b))
            case function:
                value, slopes = parts[0].jet(values, calculus)
                result, factor = calculus.function(function, value)
                return result, {k: factor * s for k, s in slopes.items()}


def join(first, a, second, b):
    out = {k: a * s for k, s in first.items()}
    for k, s in second.items():
        out[k] = out[k] + b * s if k in out else b * s
    return out


def number(value):
    return Node("number", Fraction(value))


@dataclass
class System:
    """A declaration that was drawn, and what a judge needs of it."""

    name: str
    algebra: str
    spec: dict
    constants: list
    hamiltonian: Node
    parameters: dict
    initial: list
    sign: int
    driven: bool


def rational(rng, low=1, high=8):
    return Fraction(rng.randint(low, high), rng.choice([2, 3, 4, 5])) * rng.choice([1, -1])


def bounded(rng, names):
    """A linear form with small coefficients, for the inside of a function."""
    picked = rng.sample(names, min(len(names), rng.choice([1, 2, 3])))
    terms = [number(rational(rng, 1, 4) / 2) * Node("name", name) for name in picked]
    total = terms[0]
    for term in terms[1:]:
        total = total + term
    return total


def term(rng, names):
    """A term that is no quadratic form."""
    inside, factor = bounded(rng, names), number(rational(rng, 1, 3) / 2)
    match rng.choice(["cubic", "quartic", "sin", "cos", "exp", "sqrt", "rational", "tanh", "atan", "log"]):
        case "cubic":
            return factor * Node("^", inside, 3)
        case "quartic":
            return number(Fraction(1, 8)) * Node("^", inside, 4)
        case "sqrt" | "log" as function:
            return factor * Node(function, number(1) + Node("^", inside, 2))
        case "rational":
            return factor / (number(2) + Node("^", inside, 2))
        case "exp":
            return number(Fraction(1, 4)) * Node("exp", Node("sin", inside))
        case function:
            return factor * Node(function, inside)


def draw(rng, index):
    algebra = rng.choice(sorted(algebras.ALGEBRAS))
    basis = algebras.ALGEBRAS[algebra]
    n = len(basis)
    if rng.random() < 0.5:
        basis = algebras.sheared(rng, basis, rng.randint(1, 3))
    constants = algebras.structure_constants(basis)
    state = [f"m{k + 1}" for k in range(n)]
    parameters, terms = {}, []
    for k, name in enumerate(state):
        if rng.random() < 0.8:
            square = Node("^", Node("name", name), 2)
            if rng.random() < 0.3:
                parameter = f"I{k + 1}"
                parameters[parameter] = Fraction(rng.randint(2, 9), 4)
                terms.append(square / (number(2) * Node("name", parameter)))
            else:
                terms.append(number(Fraction(rng.randint(1, 6), 8)) * square)
    for _ in range(rng.choice([0, 1, 1, 2])):
        a, b = rng.choice(state), rng.choice(state)
        terms.append(number(rational(rng, 1, 3) / 4) * Node("name", a) * Node("name", b))
    # a third has a Hamiltonian of degree two, for which many methods are exact in more
    for _ in range(rng.choice([0, 1, 2])):
        terms.append(term(rng, state))
    driven = rng.random() < 0.15
    if driven:
        clock = Node(rng.choice(["sin", "cos"]), number(Fraction(rng.randint(1, 5), 2)) * Node("name", "t"))
        terms.append(number(Fraction(1, 4)) * clock * Node("name", rng.choice(state)))
    terms.append(number(rational(rng)) * Node("name", rng.choice(state)))
    hamiltonian = terms[0]
    for more in terms[1:]:
        hamiltonian = hamiltonian + more
    initial = [Fraction(rng.randint(-9, 9), 10) for _ in state]
    sign = -1 if rng.random() < 0.25 else 1
    names = [f"e{k + 1}" for k in range(n)]
    brackets = []
    for i in range(n):
        for j in range(i + 1, n):
            parts = [f"({c})*{names[k]}" for k, c in enumerate(constants[i][j]) if c]
            if parts:
                brackets.append(f"[{names[i]}, {names[j]}] = {' + '.join(parts)}")
    spec = {
        "format": 1,
        "name": f"Audit{index}",
        "description": f"A random system on {algebra}.",
        "algebra": {"basis": names, "brackets": brackets},
        "state": state,
        "hamiltonian": hamiltonian.text(),
        "initial": [str(x) for x in initial],
    }
    if parameters:
        spec["parameters"] = {name: {"default": str(value)} for name, value in parameters.items()}
    if sign < 0:
        spec["invariance"] = "right"
    return System(spec["name"], algebra, spec, constants, hamiltonian, parameters, initial, sign, driven)
