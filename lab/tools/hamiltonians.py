"""Random Hamiltonians as text: a quadratic part and terms with prescribed functions of random arguments.

Arguments are built so that every function stays inside its domain: `positive` is at least 1/2,
`bounded` at most 2 in absolute value.
"""

import sympy as sp


def rational(rng, numerator, denominator):
    """A random nonzero rational between -1 and 1."""
    while True:
        value = sp.Rational(rng.randint(-numerator, numerator), rng.randint(1, denominator))
        if value != 0 and abs(value) <= 1:
            return value


class Shape:
    """A source of random expressions over some names."""

    def __init__(self, rng, names):
        self.rng, self.names = rng, names
        self.parameters, self.lets = {}, []

    def name(self):
        return self.rng.choice(self.names)

    def coefficient(self, value, body):
        """`value * body` in one of several ways of writing it; `body` is a product or a call."""
        sign, size = ("-", -value) if value < 0 else ("", value)
        ways = []
        if size == 1:
            ways.append(f"{sign}{body}")
        elif size.p == 1:
            ways += [f"{sign}{body}/{size.q}"] * 2 + [f"{sign}1/{size.q}*{body}"]
        else:
            ways += [f"{sign}{size}*{body}", f"{sign}{size.p}*{body}/{size.q}"]
        if size.q in (2, 4, 5, 10):
            ways.append(f"{sign}{float(size):g}*{body}")
        return self.rng.choice(ways)

    def parameter(self, value):
        """A new parameter; its name is none of the state."""
        name = f"p{len(self.parameters) + 1}"
        self.parameters[name] = str(value) if self.rng.random() < 0.5 else {"default": str(value)}
        return name

    def linear(self):
        terms = [self.coefficient(rational(self.rng, 4, 4), n) for n in self.rng.sample(self.names, min(2, len(self.names)))]
        return join(terms[:self.rng.randint(1, 2)])

    def bounded(self):
        f = self.rng.choice(["sin", "cos", "tanh", "atan"])
        return f"{f}({self.linear()})"

    def positive(self):
        a, b = self.name(), self.name()
        return self.rng.choice([
            f"1 + ({self.linear()})^2", f"2 + sin({self.linear()})", f"5/2 - {self.bounded()}",
            f"1 + {a}^2/2 + {b}^2/4", f"3/2 + {a}^4/5", f"exp(tanh({self.linear()})/2)",
        ])

    def quadratic(self):
        """A positive quadratic form with some cross terms, and perhaps a linear term."""
        terms = []
        for n in self.names:
            weight = sp.Rational(self.rng.randint(1, 6), self.rng.choice([5, 6, 8]))
            if self.rng.random() < 0.2:
                terms.append(f"{n}^2/(2*{self.parameter(1 / weight)})")
            elif self.rng.random() < 0.2:
                terms.append(self.coefficient(weight / 2, f"{n}*{n}"))
            else:
                terms.append(self.coefficient(weight / 2, f"{n}^2"))
        for _ in range(len(self.names) // 3):
            a, b = self.rng.sample(self.names, 2)
            terms.append(self.coefficient(rational(self.rng, 1, 5), f"{a}*{b}"))
        if self.rng.random() < 0.5:
            terms.append(self.coefficient(rational(self.rng, 2, 3), self.name()))
        return terms

    def term(self, function):
        """A term with the function (or of the sort) asked for."""
        rng, a, b, c = self.rng, self.name(), self.name(), self.name()
        weight = rational(rng, 4, 5)
        if function in ("sqrt", "log"):
            return self.coefficient(weight, f"{function}({self.positive()})")
        if function == "exp":
            return self.coefficient(weight, rng.choice([f"exp(-({self.linear()})^2/4)", f"exp({self.bounded()}/2)"]))
        if function in ("sin", "cos"):
            inner = rng.choice([self.linear(), f"{a}*{b}", f"{self.linear()} + {self.bounded()}"])
            return self.coefficient(weight, f"{function}({inner})")
        if function in ("tanh", "atan"):
            return self.coefficient(weight, f"{function}({self.linear()})*{a}")
        if function in ("tan", "asin", "acos"):
            return self.coefficient(weight, f"{function}({self.bounded()}/3)")
        if function in ("sinh", "cosh"):
            return self.coefficient(weight, f"{function}({self.bounded()})")
        if function == "atan2":
            return self.coefficient(weight, f"atan2({self.linear()}, {self.positive()})")
        if function == "rational":
            return self.coefficient(weight, rng.choice([
                f"({self.linear()})/(1 + {a}^2)", f"(1 + {a}^2 + {b}^2/3)^-1", f"{c}*(2 + {a}^2)^-2"]))
        if function == "power":
            return self.coefficient(weight / 2, f"({self.positive()})^{rng.choice(['(2/3)', '1.5', '-(1/2)', '(-1/3)'])}")
        if function == "three_halves":
            return self.coefficient(weight / 2, f"({self.positive()})^(3/2)")
        if function == "cubic":
            return self.coefficient(weight / 2, rng.choice([f"{a}*{b}*{c}", f"{a}^2*{b}", f"{a}*-{b}*{c}"]))
        if function == "quartic":
            return self.coefficient(abs(weight) / 4, rng.choice([f"{a}^4", f"{a}^2*{b}^2", f"({a}^2 + {b}^2)^2"]))
        raise ValueError(function)

    def hamiltonian(self, functions, abbreviate):
        """The text of H; with `abbreviate` one subexpression moves into a `let`."""
        terms = self.quadratic() + [self.term(f) for f in functions]
        if abbreviate:
            self.lets = [f"g1 = {self.linear()}", f"g2 = {self.positive()} + g1^2"]
            terms.append(self.coefficient(rational(self.rng, 2, 5), self.rng.choice(["sin(g1)*g2", "g1/g2", "g1^2*g2^-1"])))
        self.rng.shuffle(terms)
        return join(terms)


def join(terms):
    """A sum; a negative term brings its own sign."""
    out = terms[0]
    for term in terms[1:]:
        out += f" - {term[1:]}" if term.startswith("-") else f" + {term}"
    return out
