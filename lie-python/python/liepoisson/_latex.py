"""Formulas of declarations as LaTeX."""

from __future__ import annotations

import re
from collections.abc import Callable

_TOKENS = re.compile(
    r"\s*(\d+(?:\.(?!\.)\d*)?(?:[eE][+-]?\d+)?|[^\W\d]\w*'?|\.\.|<=|>=|.)", re.UNICODE
)
_GREEK = [
    "alpha",
    "beta",
    "gamma",
    "delta",
    "epsilon",
    "zeta",
    "eta",
    "theta",
    "iota",
    "kappa",
    "lambda",
    "mu",
    "nu",
    "xi",
    "pi",
    "rho",
    "sigma",
    "tau",
    "phi",
    "chi",
    "psi",
    "omega",
    "Gamma",
    "Delta",
    "Theta",
    "Lambda",
    "Xi",
    "Pi",
    "Sigma",
    "Phi",
    "Psi",
    "Omega",
]
_KNOWN = ["exp", "log", "sin", "cos", "tan", "sinh", "cosh", "tanh", "min", "max"]
_RELATIONS = {"<": "<", ">": ">", "<=": r"\le", ">=": r"\ge"}
# how closely the outermost operation holds together
_SUM, _PRODUCT, _POWER, _ATOM = range(4)
_Part = tuple[str, int]


def as_latex(text: str) -> str:
    """An equation or an expression; one that is none stands as it is."""
    sides = text.split(" = ")
    try:
        return " = ".join(_Reader(side).whole() for side in sides)
    except (SyntaxError, IndexError):
        return r"\mathtt{" + re.sub(r"([#$%&_{}])", r"\\\1", text) + "}"


def _name(name: str) -> str:
    rate = name.endswith("'")
    stem, *indices = name.rstrip("'").split("_")
    found = re.fullmatch(r"(.*?\D)(\d+)", stem)
    if found:
        stem, indices = found[1], [found[2], *indices]
    base = "\\" + stem if stem in _GREEK else stem if len(stem) == 1 else rf"\mathit{{{stem}}}"
    prime = "'" if rate else ""
    if not any(indices):
        return base + prime
    said = (word if len(word) == 1 or word.isdigit() else rf"\mathrm{{{word}}}" for word in indices)
    return base + prime + "_{" + ",".join(said) + "}"


class _Reader:
    def __init__(self, text: str) -> None:
        self.tokens: list[str] = [token for token in _TOKENS.findall(text) if token.strip()] + [""]
        self.at = 0

    def next(self) -> str:
        token: str = self.tokens[self.at]
        self.at += 1
        return token

    def takes(self, *tokens: str) -> str:
        return self.next() if self.tokens[self.at] in tokens and self.tokens[self.at] else ""

    def needs(self, token: str) -> None:
        if self.next() != token:
            raise SyntaxError(token)

    def whole(self) -> str:
        found = self.sum()[0]
        self.needs("")
        return found

    def sum(self) -> _Part:
        sign = self.takes("-", "+")
        text, binds = self.product()
        if sign == "-":
            text, binds = "-" + _within(text, binds, _PRODUCT), _SUM
        while sign := self.takes("+", "-"):
            part, how = self.product()
            text += f" {sign} " + _within(part, how, _PRODUCT if sign == "-" else _SUM)
            binds = _SUM
        return text, binds

    def product(self) -> _Part:
        over = [self.power()]
        under: list[_Part] = []
        while sign := self.takes("*", "/"):
            (over if sign == "*" else under).append(self.power())
        text, binds = _times(over)
        if under:
            return rf"\frac{{{text}}}{{{_times(under)[0]}}}", _POWER
        return text, binds

    def power(self) -> _Part:
        if self.takes("-"):
            text, binds = self.power()
            return "-" + _within(text, binds, _PRODUCT), _SUM
        base, binds = self.atom()
        if not self.takes("^"):
            return base, binds
        sign = "-" if self.takes("-") else ""
        exponent = sign + self.power()[0]
        return f"{_within(base, binds, _ATOM)}^{{{exponent}}}", _POWER

    def atom(self) -> _Part:
        token = self.next()
        if token == "(":
            found = self.sum()
            self.needs(")")
            return found
        if token[:1].isdigit():
            digits, _, exponent = token.lower().partition("e")
            return (
                (rf"{digits} \cdot 10^{{{int(exponent)}}}", _PRODUCT)
                if exponent
                else (digits, _ATOM)
            )
        if not re.match(r"[^\W\d]", token):
            raise SyntaxError(token)
        if self.takes("("):
            return self.call(token)
        text = _name(token)
        if self.takes("["):
            places = self.several("]", lambda: self.sum()[0])
            text = (f"{{{text}}}" if "_" in text else text) + "_{" + ", ".join(places) + "}"
        return text, _ATOM

    def several(self, end: str, part: Callable[[], str]) -> list[str]:
        parts = [part()]
        while self.takes(","):
            parts.append(part())
        self.needs(end)
        return parts

    def call(self, name: str) -> _Part:
        if name == "sum":
            return self.sites()
        if name == "piecewise":
            cases = self.several(")", self.case)
            return r"\begin{cases}" + r" \\ ".join(cases) + r"\end{cases}", _ATOM
        arguments = self.several(")", lambda: self.sum()[0])
        [first, *_] = arguments
        if name == "sqrt":
            return rf"\sqrt{{{first}}}", _ATOM
        if name == "cbrt":
            return rf"\sqrt[3]{{{first}}}", _ATOM
        if name == "abs":
            return rf"\left|{first}\right|", _ATOM
        head = "\\" + name if name in _KNOWN else rf"\operatorname{{{name}}}"
        # a power of it needs parentheses around both
        return head + _parentheses(", ".join(arguments)), _POWER

    def case(self) -> str:
        left = self.sum()[0]
        relation = self.takes(*_RELATIONS)
        if not relation:
            return rf"{left} & \text{{otherwise}}"
        right = self.sum()[0]
        self.needs(":")
        return rf"{self.sum()[0]} & {left} {_RELATIONS[relation]} {right}"

    def sites(self) -> _Part:
        heads = []
        while True:
            index = self.next()
            self.needs("in")
            first = self.sum()[0]
            self.needs("..")
            end = self.sum()[0]
            heads.append(rf"\sum_{{{first} \le {_name(index)} < {end}}}")
            if not self.takes(","):
                break
        self.needs(":")
        text, binds = self.sum()
        self.needs(")")
        return " ".join([*heads, _within(text, binds, _PRODUCT)]), _SUM


def _within(text: str, binds: int, needed: int) -> str:
    return text if binds >= needed else _parentheses(text)


def _parentheses(text: str) -> str:
    high = any(part in text for part in (r"\frac", r"\sum", r"\begin", "^"))
    return rf"\left({text}\right)" if high else f"({text})"


def _times(factors: list[_Part]) -> _Part:
    if len(factors) == 1:
        return factors[0]
    shown = [_within(text, binds, _PRODUCT) for text, binds in factors]
    text = shown[0]
    for before, factor in zip(shown, shown[1:]):
        # two numbers side by side would be one
        text += (r" \cdot " if before[-1].isdigit() and factor[:1].isdigit() else r"\,") + factor
    return text, _PRODUCT
