"""Reads a spec file without any help from the compiler: an independent, deliberately plain second
implementation of the grammar and of the convention

    [e_i, e_j] = sum_k C_ij^k e_k,    mu'_j = sum_ik C_ij^k (dH/dmu_i) mu_k

(left-invariant; a right-invariant system has -C).  Numbers stay exact: sympy rationals throughout.
"""

import json
import re
from pathlib import Path

import sympy as sp

FUNCTIONS = {
    "sqrt": (1, sp.sqrt), "exp": (1, sp.exp), "log": (1, sp.log),
    "sin": (1, sp.sin), "cos": (1, sp.cos), "tan": (1, sp.tan),
    "asin": (1, sp.asin), "acos": (1, sp.acos), "atan": (1, sp.atan),
    "sinh": (1, sp.sinh), "cosh": (1, sp.cosh), "tanh": (1, sp.tanh),
    "asinh": (1, sp.asinh), "acosh": (1, sp.acosh), "atanh": (1, sp.atanh), "cbrt": (1, lambda x: sp.sign(x) * sp.Abs(x) ** sp.Rational(1, 3)),
    "log1p": (1, lambda x: sp.log(1 + x)), "expm1": (1, lambda x: sp.exp(x) - 1),
    "atan2": (2, sp.atan2), "hypot": (2, lambda x, y: sp.sqrt(x**2 + y**2)),
    "abs": (1, sp.Abs), "min": (2, sp.Min), "max": (2, sp.Max),
}
TOKEN = re.compile(r"\s*(?:(\d+(?:\.\d+)?(?:[eE][+-]?\d+)?)|([^\W\d]\w*)|(.))", re.DOTALL)


class SpecError(Exception):
    """A spec that this reader does not accept."""


class Parser:
    """Precedence parser: sum < product < unary minus < power (right-associative) < atom."""

    def __init__(self, text, names):
        self.names = names
        self.tokens = []
        position = 0
        text = text.rstrip()
        while position < len(text):
            match = TOKEN.match(text, position)
            if match is None:
                raise SpecError(f"cannot read {text[position:]!r}")
            number, name, other = match.groups()
            if number is not None and self.tokens and match.start() == position and self.tokens[-1][0] == "number":
                raise SpecError(f"two numbers without an operator in {text!r}")
            self.tokens.append(("number", number) if number else ("name", name) if name else ("op", other))
            position = match.end()
        self.text, self.at = text, 0

    def peek(self):
        return self.tokens[self.at] if self.at < len(self.tokens) else ("end", "")

    def take(self, wanted=None):
        token = self.peek()
        if wanted is not None and token != ("op", wanted):
            raise SpecError(f"{wanted!r} expected, {token[1]!r} found in {self.text!r}")
        self.at += 1
        return token

    def parse(self):
        value = self.sum()
        if self.peek()[0] != "end":
            raise SpecError(f"operator expected before {self.peek()[1]!r} in {self.text!r}")
        return value

    def sum(self):
        value = self.product()
        while self.peek() in (("op", "+"), ("op", "-")):
            sign = 1 if self.take()[1] == "+" else -1
            value = value + sign * self.product()
        return value

    def product(self):
        value = self.unary()
        while self.peek() in (("op", "*"), ("op", "/")):
            divide = self.take()[1] == "/"
            factor = self.unary()
            value = value / factor if divide else value * factor
        return value

    def unary(self):
        if self.peek() == ("op", "-"):
            self.take()
            return -self.unary()
        return self.power()

    def power(self):
        base = self.atom()
        if self.peek() == ("op", "^"):
            self.take()
            return base ** self.unary()
        return base

    def atom(self):
        kind, text = self.take()
        if kind == "number":
            return sp.Rational(text)
        if (kind, text) == ("op", "("):
            value = self.sum()
            self.take(")")
            return value
        if kind == "name":
            if self.peek() == ("op", "("):
                return self.call(text)
            if text == "pi":
                return sp.pi
            if text in self.names:
                return self.names[text]
            raise SpecError(f"unknown name {text!r} in {self.text!r}")
        raise SpecError(f"value expected, {text!r} found in {self.text!r}")

    def call(self, name):
        if name not in FUNCTIONS:
            raise SpecError(f"unknown function {name!r} in {self.text!r}")
        self.take("(")
        arguments = [self.sum()]
        while self.peek() == ("op", ","):
            self.take()
            arguments.append(self.sum())
        self.take(")")
        arity, function = FUNCTIONS[name]
        if len(arguments) != arity:
            raise SpecError(f"{name} takes {arity} arguments in {self.text!r}")
        return function(*arguments)


def number(value):
    """A JSON number, read from its text, as an exact rational."""
    return sp.Rational(str(value))


class System:
    """A spec with parameters replaced by their defaults."""

    def __init__(self, document):
        if document.get("format") != 1:
            raise SpecError("format 1 expected")
        self.name = document["name"]
        algebra = document["algebra"]
        self.parameters = {}
        for name, value in document.get("parameters", {}).items():
            value = value.get("default", value.get("value")) if isinstance(value, dict) else value
            self.parameters[name] = self.constant(value)
        self.basis = algebra.get("basis") or list(algebra["matrices"])
        self.dimension = len(self.basis)
        self.coordinates = [sp.Symbol(name, real=True) for name in document["state"]]
        if len(self.coordinates) != self.dimension:
            raise SpecError("state and basis differ in length")
        self.matrices = None
        if "matrices" in algebra:
            self.matrices = [sp.Matrix([[self.constant(v) for v in row] for row in algebra["matrices"][name]])
                             for name in self.basis]
        if "brackets" in algebra:
            self.constants = self.read_brackets(algebra["brackets"])
        else:
            self.constants = commutators(self.matrices)
        if document.get("invariance", "left") == "right":
            self.constants = {key: -value for key, value in self.constants.items()}
            self.matrices = self.matrices and [-m for m in self.matrices]
        names = dict(self.parameters)
        names.update({str(x): x for x in self.coordinates})
        for text in document.get("let", []):
            name, value = (part.strip() for part in text.split("=", 1))
            names[name] = Parser(value, names).parse()
        self.hamiltonian = Parser(document["hamiltonian"], names).parse()
        self.gradient = [sp.diff(self.hamiltonian, x) for x in self.coordinates]
        self.casimirs = []
        for text in document.get("casimirs", []):
            name, value = (part.strip() for part in text.split("=", 1)) if "=" in text else (None, text)
            self.casimirs.append((name, Parser(value, names).parse()))
        self.initial = None
        if "initial" in document:
            self.initial = [self.constant(v) for v in document["initial"]]
            if len(self.initial) != self.dimension:
                raise SpecError("initial and basis differ in length")

    def constant(self, value):
        """A number or an exact expression in constants and parameters."""
        return Parser(value, self.parameters).parse() if isinstance(value, str) else number(value)

    def read_brackets(self, brackets):
        symbols = {name: sp.Symbol("basis_" + name) for name in self.basis}
        names = {**self.parameters, **symbols}
        constants = {}
        for text in brackets:
            match = re.fullmatch(r"\s*\[\s*(\w+)\s*,\s*(\w+)\s*\]\s*=\s*(.*)", text)
            if not match:
                raise SpecError(f"not a bracket: {text!r}")
            i, j = self.basis.index(match[1]), self.basis.index(match[2])
            value = sp.expand(Parser(match[3], names).parse())
            linear = sum(sp.diff(value, s) * s for s in symbols.values())
            if sp.simplify(value - linear) != 0:
                raise SpecError(f"not linear in the basis: {text!r}")
            for k, name in enumerate(self.basis):
                coefficient = sp.diff(value, symbols[name])
                for key, entry in (((i, j, k), coefficient), ((j, i, k), -coefficient)):
                    if constants.get(key, entry) != entry:
                        raise SpecError(f"contradicts an earlier bracket: {text!r}")
                    if entry != 0:
                        constants[key] = entry
        return constants

    def jacobi(self):
        """Whether C_ij^l C_lk^m + cyclic vanishes."""
        n, c = self.dimension, self.constants
        rows = [[{} for _ in range(n)] for _ in range(n)]
        for (i, j, k), value in c.items():
            rows[i][j][k] = value
        for i in range(n):
            for j in range(i + 1, n):
                for k in range(j + 1, n):
                    total = {}
                    for a, b, d in ((i, j, k), (j, k, i), (k, i, j)):
                        for l, left in rows[a][b].items():
                            for m, right in rows[l][d].items():
                                total[m] = total.get(m, 0) + left * right
                    if not all(vanishes(v) for v in total.values()):
                        return False
        return True

    def represents(self):
        """Whether the matrices, if there are any, satisfy the brackets."""
        if self.matrices is None:
            return True
        m, n = self.matrices, self.dimension
        return all(
            m[i] * m[j] - m[j] * m[i]
            == sum((self.constants.get((i, j, k), 0) * m[k] for k in range(n)), sp.zeros(*m[0].shape))
            for i in range(n) for j in range(n))

    def poisson(self):
        """Pi_ab = -C_ab^k mu_k."""
        pi = sp.zeros(self.dimension)
        for (a, b, k), value in self.constants.items():
            pi[a, b] -= value * self.coordinates[k]
        return pi

    def field(self):
        """mu'_j = C_ij^k (dH/dmu_i) mu_k."""
        out = [sp.Integer(0)] * self.dimension
        for (i, j, k), value in self.constants.items():
            out[j] += value * self.gradient[i] * self.coordinates[k]
        return out

    def is_casimir(self, function):
        """Whether {C, x_i} = 0 for every coordinate."""
        gradient = sp.Matrix([sp.diff(function, x) for x in self.coordinates])
        return all(vanishes(v) for v in self.poisson() * gradient)


def vanishes(expression):
    return sp.expand(expression) == 0 or sp.simplify(expression) == 0


def commutators(matrices):
    """Structure constants of the span of linearly independent matrices, exactly."""
    n = len(matrices)
    columns = sp.Matrix.hstack(*(m.reshape(m.rows * m.cols, 1) for m in matrices))
    inverse = (columns.T * columns).inv() * columns.T
    constants = {}
    for i in range(n):
        for j in range(n):
            bracket = matrices[i] * matrices[j] - matrices[j] * matrices[i]
            vector = bracket.reshape(bracket.rows * bracket.cols, 1)
            coefficients = inverse * vector
            if columns * coefficients != vector:
                raise SpecError("the matrices are not closed under commutators")
            constants.update({(i, j, k): coefficients[k] for k in range(n) if coefficients[k] != 0})
    return constants


def load(path):
    """The system of a spec file; repeated keys are refused and numbers keep their text."""
    def unique(pairs):
        if len({key for key, _ in pairs}) != len(pairs):
            raise SpecError(f"repeated key in {path}")
        return dict(pairs)
    text = Path(path).read_text(encoding="utf-8")
    return System(json.loads(text, parse_float=sp.Rational, parse_int=sp.Integer, object_pairs_hook=unique))
