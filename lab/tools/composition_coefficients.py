"""Coefficients of compositions and splittings, refined and printed as Rust constants.

    python lab/tools/composition_coefficients.py           print the tables of crates/lie-core/src/methods/coefficients.rs
    python lab/tools/composition_coefficients.py --check   compare with the file

Published digits (16 to 21) are the start of a Gauss-Newton iteration with 60 digits on the order conditions, which
moves them by the least amount that satisfies all conditions; where a scheme has free parameters, those stay as
published.  The conditions are the coefficients of words in a free algebra, so no list of them has to be trusted:

* a composition S(g_s h) ... S(g_1 h) of a symmetric method S(h) = exp(h X1 + h^3 X3 + h^5 X5 + ...) has order p if the
  product agrees with exp(h X1) in every word of degree at most p in X1, X3, X5, ...;
* a splitting exp(a_1 h A) exp(b_1 h B) exp(a_2 h A) ... has order p if it agrees with exp(h (A + B)) in every word of at
  most p letters.  As sweeps over the pieces of H, forwards and backwards in turn, it has the sizes
  s_1 = a_1, s_2 = b_1 - s_1, s_3 = a_2 - s_2, ... and the same order for any number of pieces.

Each number is printed as the nearest double and the double nearest to the rest.
"""

import sys
from pathlib import Path

import mpmath as mp

mp.mp.dps = 60
TARGET = Path(__file__).resolve().parents[2] / "crates/lie-core/src/methods/coefficients.rs"


def words(letters, degree):
    """Words of degree at most `degree`; `letters` gives the degree of each letter."""
    found, layer = [()], [((), 0)]
    while layer:
        layer = [(word + (k,), d + w) for word, d in layer for k, w in enumerate(letters) if d + w <= degree]
        found += [word for word, _ in layer]
    return found


def times(left, right, basis):
    return {w: mp.fsum(left[w[:k]] * right[w[k:]] for k in range(len(w) + 1)) for w in basis}


def exponential(element, basis):
    """exp of a linear combination of letters: the word w has the product of its letters over its length's factorial."""
    return {w: mp.fprod(element[k] for k in w) / mp.factorial(len(w)) for w in basis}


def composition_defect(order):
    letters = list(range(1, order + 1, 2))
    basis = words(letters, order)
    target = exponential([mp.mpf(1)] + [mp.mpf(0)] * (len(letters) - 1), basis)

    def defect(half):
        product = None
        for g in half + half[:-1][::-1]:
            factor = exponential([g**d for d in letters], basis)
            product = factor if product is None else times(product, factor, basis)
        return [product[w] - target[w] for w in basis]

    return defect


def splitting_sequence(values, count):
    """a_1, b_1, a_2, ... from the leading a and b: palindromic, each summing to 1."""
    a, b = list(values[:count]), list(values[count:])
    stages = len(a) + len(b) + 1
    # `stages` of B between stages + 1 of A; the missing entries are fixed by the sums
    a_half, b_half = (stages + 2) // 2, (stages + 1) // 2
    whole = stages + 1
    a.append((1 - 2 * mp.fsum(a)) / (1 if whole % 2 else 2))
    b.append((1 - 2 * mp.fsum(b)) / (1 if stages % 2 else 2))
    assert (len(a), len(b)) == (a_half, b_half)
    a += a[: whole - a_half][::-1]
    b += b[: stages - b_half][::-1]
    sequence = [a[0]]
    for x, y in zip(b, a[1:]):
        sequence += [x, y]
    return sequence


def near_integrable(first, second):
    """Words of at most `second` letters, and those of at most `first` with one B: errors e h^first + e^2 h^second."""
    single = [(0,) * i + (1,) + (0,) * j for i in range(first) for j in range(first - i)]
    none = [(0,) * i for i in range(first + 1)]
    return sorted(set(words([1, 1], second)) | set(single) | set(none), key=lambda w: (len(w), w))


def splitting_defect(basis, count):
    target = exponential([mp.mpf(1), mp.mpf(1)], basis)

    def defect(values):
        product = None
        for position, x in enumerate(splitting_sequence(values, count)):
            factor = exponential([x, mp.mpf(0)] if position % 2 == 0 else [mp.mpf(0), x], basis)
            product = factor if product is None else times(product, factor, basis)
        return [product[w] - target[w] for w in basis]

    return defect


def refine(name, start, defect):
    """The nearest point at which the defect vanishes."""
    point = [mp.mpf(x) for x in start]
    for _ in range(8):
        here = mp.matrix(defect(point))
        size = mp.norm(here, mp.inf)
        if size < mp.mpf(10) ** -50:
            moved = max(abs(x - mp.mpf(y)) for x, y in zip(point, start))
            print(f"{name}: moved by {mp.nstr(moved, 3)}", file=sys.stderr)
            assert moved < mp.mpf(10) ** -14
            return point
        step = mp.mpf(10) ** -25
        columns = []
        for k in range(len(point)):
            there = list(point)
            there[k] += step
            columns.append((mp.matrix(defect(there)) - here) / step)
        jacobian = mp.matrix(len(here), len(point))
        for k, column in enumerate(columns):
            jacobian[:, k] = column
        u, s, v = mp.svd_r(jacobian, full_matrices=False)
        rank = sum(1 for x in s if x > mp.mpf(10) ** -12 * s[0])
        rest = u.T * here
        for k in range(len(point)):
            point[k] -= mp.fsum(v[j, k] * rest[j] / s[j] for j in range(rank))
    raise SystemExit(f"{name}: no solution near the published digits, defect {mp.nstr(size, 3)}")


def jump(order, levels, stages):
    """Triple jump (3 stages) or Suzuki's (5), by repeated raising of the order by 2."""
    factors = [mp.mpf(1)]
    for level in range(levels):
        root = mp.mpf(stages - 1) ** (mp.mpf(1) / (order + 1 + 2 * level))
        outer = 1 / (stages - 1 - root)
        row = [outer] * (stages // 2) + [-root * outer] + [outer] * (stages // 2)
        factors = [x * y for y in row for x in factors]
    return factors


def mirrored(half):
    return half + half[:-1][::-1]


YOSHIDA_6 = ["1.31518632068391121889", "-1.17767998417887100695", "0.23557321335935813368", "0.78451361047755726382"]
KAHAN_LI_6 = ["0.39216144400731413928", "0.33259913678935943860", "-0.70624617255763935981", "0.082213596293550800230",
              "0.79854399093482996340"]
SUZUKI_UMENO_8 = ["0.74167036435061295345", "-0.40910082580003159400", "0.19075471029623837995", "-0.57386247111608226666",
                  "0.29906418130365592384", "0.33462491824529818378", "0.31529309239676659663", "-0.79688793935291635402"]
KAHAN_LI_8 = ["0.13020248308889008088", "0.56116298177510838456", "-0.38947496264484728641", "0.15884190655515560090",
              "-0.39590389413323757734", "0.18453964097831570709", "0.25837438768632204729", "0.29501172360931029887",
              "-0.60550853383003451170"]
BLANES_MOAN_4 = (["0.0792036964311957", "0.353172906049774", "-0.0420650803577195"],
                 ["0.209515106613362", "-0.143851773179818"])
BLANES_MOAN_6 = (["0.0502627644003922", "0.413514300428344", "0.0450798897943977", "-0.188054853819569", "0.541960678450780"],
                 ["0.148816447901042", "-0.132385865767784", "0.067307604692185", "0.432666402578175"])
# A and B of the scheme (8, 4) with 5 stages
MCLACHLAN_84 = (["0.07534696026989288842", "0.51791685468825678230"], ["0.19022593937367661925", "0.84652407044352625706"])


def sweeps(name, leading, order):
    a, b = leading
    basis = near_integrable(*order) if isinstance(order, tuple) else words([1, 1], order)
    values = refine(name, a + b, splitting_defect(basis, len(a)))
    return sizes_of(splitting_sequence(values, len(a)))


def sizes_of(sequence):
    sizes = []
    for x in sequence[:-1]:
        sizes.append(x - (sizes[-1] if sizes else 0))
    return sizes


def quadrature(nodes):
    """The scheme whose B, at these nodes, is the interpolatory quadrature: sizes of sweeps, B first where 0 is a node."""
    count = len(nodes)
    matrix = mp.matrix(count, count)
    for power in range(count):
        for k, node in enumerate(nodes):
            matrix[power, k] = node**power if power else mp.mpf(1)
    weights = list(mp.lu_solve(matrix, mp.matrix([mp.mpf(1) / (p + 1) for p in range(count)])))
    ends = nodes if abs(nodes[0]) < mp.mpf(10) ** -50 else [mp.mpf(0)] + nodes + [mp.mpf(1)]
    gaps = [y - x for x, y in zip(ends, ends[1:])]
    outer, inner = (weights, gaps) if len(weights) > len(gaps) else (gaps, weights)
    sequence = [outer[0]]
    for x, y in zip(inner, outer[1:]):
        sequence += [x, y]
    return sizes_of(sequence)


def gauss(count):
    roots = mp.polyroots(mp.taylor(lambda x: mp.legendre(count, x), 0, count)[::-1], maxsteps=200, extraprec=200)
    return sorted((1 + mp.re(x)) / 2 for x in roots)


def lobatto(count):
    slopes = [k * c for k, c in enumerate(mp.taylor(lambda x: mp.legendre(count - 1, x), 0, count - 1))][1:]
    roots = mp.polyroots(slopes[::-1], maxsteps=200, extraprec=200)
    return [mp.mpf(0)] + sorted((1 + mp.re(x)) / 2 for x in roots) + [mp.mpf(1)]


def tables():
    yield "TRIPLE_JUMP_4", jump(2, 1, 3)
    yield "SUZUKI_4", jump(2, 1, 5)
    yield "TRIPLE_JUMP_6", jump(2, 2, 3)
    yield "SUZUKI_6", jump(2, 2, 5)
    yield "YOSHIDA_6", mirrored(refine("Yoshida 6 A", YOSHIDA_6[::-1], composition_defect(6)))
    yield "KAHAN_LI_6", mirrored(refine("Kahan-Li 6", KAHAN_LI_6, composition_defect(6)))
    yield "SUZUKI_UMENO_8", mirrored(refine("Suzuki-Umeno 8", SUZUKI_UMENO_8, composition_defect(8)))
    yield "KAHAN_LI_8", mirrored(refine("Kahan-Li 8", KAHAN_LI_8, composition_defect(8)))
    yield "BLANES_MOAN_4", sweeps("Blanes-Moan S6", BLANES_MOAN_4, 4)
    yield "BLANES_MOAN_6", sweeps("Blanes-Moan S10", BLANES_MOAN_6, 6)
    yield "STRANG", [mp.mpf(1) / 2, mp.mpf(1) / 2]
    yield "SABA_2", quadrature(gauss(2))
    yield "SABA_4", quadrature(gauss(4))
    yield "SBAB_2", quadrature(lobatto(3))
    yield "SBAB_4", quadrature(lobatto(5))
    yield "MCLACHLAN_84", sweeps("McLachlan (8, 4)", MCLACHLAN_84, (8, 4))


def rust():
    lines = []
    for name, values in tables():
        half = (len(values) + 1) // 2
        assert all(abs(x - y) < mp.mpf(10) ** -45 for x, y in zip(values, values[::-1]))
        assert abs(mp.fsum(values) - 1) < mp.mpf(10) ** -45
        lines.append(f"const {name}: [Parts; {half}] = [")
        for x in values[:half]:
            high = float(x)
            lines.append(f"    Parts({high!r}, {float(x - mp.mpf(high))!r}),")
        lines.append("];")
    return "\n".join(lines) + "\n"


def main():
    text = rust()
    if sys.argv[1:] == ["--check"]:
        found = TARGET.read_text(encoding="utf-8")
        if "".join(text.split()) not in "".join(found.split()):
            raise SystemExit(f"{TARGET} has other numbers")
        return
    print(text, end="")


if __name__ == "__main__":
    main()
