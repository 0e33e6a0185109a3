"""Weighted operations of `linearize` by sympy's common subexpressions, for docs/operation_counts.md.

H is quadratic with a full matrix of parameters. Operations on parameters alone do not count: they are done once.
The least of four forms is taken: as derived or expanded, with and without sympy's own optimizations.
"""

import itertools

import sympy as sp


def weight(e, known):
    """Additions, multiplications and sign changes 1, divisions 5, functions 25."""
    if e.is_Atom or e.free_symbols <= known:
        return 0
    inner = sum(weight(a, known) for a in e.args)
    if e.is_Add:
        return inner + len(e.args) - 1
    if e.is_Mul:
        factors = [a for a in e.args if not a.free_symbols <= known]
        return inner + len(factors) - 1 + (len(factors) < len(e.args))
    if e.is_Pow and e.exp == 2:
        return inner + 1
    if e.is_Pow and e.exp == -1:
        return inner + 5
    return inner + 25


def linearize(constants, n):
    mu = sp.symbols(f"m0:{n}")
    form = [[sp.Symbol(f"a{min(i, j)}_{max(i, j)}") for j in range(n)] for i in range(n)]
    gradient = [sum(form[i][j] * mu[j] for j in range(n)) for i in range(n)]
    field = [sp.Integer(0)] * n
    for (i, j, k), c in constants.items():
        field[j] += c * gradient[i] * mu[k]
    slopes = [sp.diff(f, x) for f in field for x in mu]
    return field + slopes, {s for row in form for s in row}


def least(constants, n):
    outputs, parameters = linearize(constants, n)
    totals = []
    for form, optimizations in itertools.product((lambda e: e, sp.expand), (None, "basic")):
        replaced, reduced = sp.cse([form(e) for e in outputs], optimizations=optimizations)
        known, total = set(parameters), 0
        for symbol, e in replaced:
            if e.free_symbols <= known:
                known.add(symbol)
            else:
                total += weight(e, known)
        totals.append(total + sum(weight(e, known) for e in reduced))
    return min(totals)


def structure(matrices):
    """Structure constants of independent matrices."""
    rows = sp.Matrix([list(m) for m in matrices])
    inverse = (rows * rows.T).inv()
    constants = {}
    for (i, a), (j, b) in itertools.product(enumerate(matrices), repeat=2):
        components = sp.Matrix([list(a * b - b * a)]) * rows.T * inverse
        for k, c in enumerate(components):
            if c != 0:
                constants[i, j, k] = sp.nsimplify(c)
    return constants


def unit(n, i, j):
    m = sp.zeros(n)
    m[i, j] = 1
    return m


def se3():
    turns = [unit(4, j, i) - unit(4, i, j) for i, j in ((1, 2), (2, 0), (0, 1))]
    return turns + [unit(4, k, 3) for k in range(3)]


def so(n):
    return [unit(n, i, j) - unit(n, j, i) for i, j in itertools.combinations(range(n), 2)]


def su3():
    """-i/2 times Gell-Mann's matrices, as real blocks."""
    i, u = sp.I, lambda a, b: unit(3, a, b)
    pairs = ((0, 1), (0, 2), (1, 2))
    gell_mann = [m for a, b in pairs for m in (u(a, b) + u(b, a), -i * u(a, b) + i * u(b, a))]
    gell_mann += [u(0, 0) - u(1, 1), (u(0, 0) + u(1, 1) - 2 * u(2, 2)) / sp.sqrt(3)]
    parts = [(sp.re(m), sp.im(m)) for m in (-i * x / 2 for x in gell_mann)]
    return [sp.Matrix(sp.BlockMatrix([[re, -im], [im, re]])) for re, im in parts]


if __name__ == "__main__":
    for name, matrices in (("se(3)", se3()), ("su(3)", su3()), ("so(5)", so(5))):
        print(name, least(structure(matrices), len(matrices)), flush=True)
