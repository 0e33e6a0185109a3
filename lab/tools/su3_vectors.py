"""Writes the reference values of specs/su3_quadratic.json: tests/data/vectors/su3_quadratic.json and
steps_su3_quadratic.json, with 60 digits by mpmath, straight from the structure constants.

The Hamiltonian is quadratic, grad H(mu) = G mu, so that the field is quadratic too: the trajectory is a
Taylor series by its recurrence, twice with different orders and steps; every implicit step is a fixed-point
iteration, and a mean value along a segment is the value at its midpoint.

    python lab/tools/su3_vectors.py
"""

import json
from pathlib import Path

import sympy as sp
from mpmath import mp, mpf

import lie_spec

ROOT = Path(__file__).resolve().parents[2]
NAME = "su3_quadratic"
mp.dps = 60

SYSTEM = lie_spec.load(ROOT / "specs" / f"{NAME}.json")
N = SYSTEM.dimension
X = SYSTEM.coordinates
exact = lambda value: mpf(int(value.p)) / int(value.q)
HESSIAN = [[sp.diff(g, x) for x in X] for g in SYSTEM.gradient]
G = [[exact(v) for v in row] for row in HESSIAN]
C = [(i, j, k, exact(v)) for (i, j, k), v in sorted(SYSTEM.constants.items())]
RHO = [mp.matrix([[exact(v) for v in m.row(r)] for r in range(m.rows)]) for m in SYSTEM.matrices]
MU0 = [exact(v) for v in SYSTEM.initial]


def axpy(*terms):
    """Sum of factor * vector."""
    return [sum(factor * vector[i] for factor, vector in terms) for i in range(N)]


def gradient(mu):
    return [sum(a * b for a, b in zip(row, mu)) for row in G]


def ad(xi, eta):
    out = [mpf(0)] * N
    for i, j, k, value in C:
        out[k] += value * xi[i] * eta[j]
    return out


def ad_star(xi, mu):
    out = [mpf(0)] * N
    for i, j, k, value in C:
        out[j] += value * xi[i] * mu[k]
    return out


def field(mu):
    return ad_star(gradient(mu), mu)


def series(xi, mu, shift):
    """sum_k (ad*_xi)^k mu / (k + shift)! * shift!: the exponential for shift 0, phi_1 for shift 1."""
    term, total, k = mu, mu, 0
    while max(abs(t) for t in term) > mpf(10) ** -70:
        k += 1
        term = [t / (k + shift) for t in ad_star(xi, term)]
        total = axpy((1, total), (1, term))
    return total


def act(xi, mu):
    return series(xi, mu, 0)


def phi_inverse(xi, p):
    """Solves phi_1(ad*_xi) m = p."""
    unit = lambda j: [mpf(i == j) for i in range(N)]
    columns = [series(xi, unit(j), 1) for j in range(N)]
    matrix = mp.matrix(N, N)
    for j in range(N):
        for i in range(N):
            matrix[i, j] = columns[j][i]
    return list(mp.lu_solve(matrix, mp.matrix(p)))


def fixed_point(function, start):
    """The limit of x -> f(x); x is a list of numbers."""
    x = start
    for _ in range(500):
        new = function(x)
        change = max(abs(a - b) for a, b in zip(new, x))
        x = new
        if change < mpf(10) ** -56:
            return x
    raise ArithmeticError("no convergence")


def flat(vectors):
    return [v for vector in vectors for v in vector]


def split(values):
    return [values[i:i + N] for i in range(0, len(values), N)]


# ------------------------------------------------------------------ methods

def lie_euler(mu, h):
    return act([h * g for g in gradient(mu)], mu)


def rkmk4(mu, h):
    stages = []
    for row in ([], [(0, mpf(1) / 2)], [(1, mpf(1) / 2)], [(2, mpf(1))]):
        sigma = axpy((mpf(0), mu), *((h * a, stages[j]) for j, a in row))
        xi = gradient(act(sigma, mu))
        once = ad(sigma, xi)
        stages.append(axpy((1, xi), (mpf(1) / 2, once), (mpf(1) / 12, ad(sigma, once))))
    return act(axpy(*((h * b / 6, k) for b, k in zip((1, 2, 2, 1), stages))), mu)


def cf4(mu, h):
    third, twelfth = mpf(1) / 6, mpf(1) / 12
    k1 = gradient(mu)
    y2 = act(axpy((h / 2, k1)), mu)
    k2 = gradient(y2)
    k3 = gradient(act(axpy((h / 2, k2)), mu))
    k4 = gradient(act(axpy((h, k3), (-h / 2, k1)), y2))
    y = act(axpy((h / 4, k1), (h * third, k2), (h * third, k3), (-h * twelfth, k4)), mu)
    return act(axpy((-h * twelfth, k1), (h * third, k2), (h * third, k3), (h / 4, k4)), y)


def midpoint(mu, h):
    half = mpf(1) / 2
    return fixed_point(lambda u: axpy((1, mu), (h, field(axpy((half, mu), (half, u))))), mu)


def orbit_energy(mu, h):
    return fixed_point(lambda u: act(axpy((h / 2, gradient(mu)), (h / 2, gradient(u))), mu), mu)


def generating(corrected):
    """S = h H, and h^3 H''(f, f)/24 if corrected, in exponential coordinates."""
    def step(mu, h):
        def xi(p):
            first, f = gradient(p), field(p)
            if not corrected:
                return axpy((h, first))
            # grad H''(f, f)/24 = Df^T G f / 12 with Df v = ad*_(G v) p + ad*_(G p) v
            gf = gradient(f)
            unit = lambda j: [mpf(i == j) for i in range(N)]
            third = [sum(a * b for a, b in zip(gf, axpy((1, ad_star(gradient(unit(j)), p)), (1, ad_star(first, unit(j))))))
                     for j in range(N)]
            return axpy((h, first), (h ** 3 / 12, third))
        p = fixed_point(lambda p: series(xi(p), mu, 1), mu)
        return phi_inverse(axpy((-1, xi(p))), p)
    return step


def tableau(stages):
    """Nodes, weights and matrix of the Gauss method."""
    r = mp.sqrt
    c = {1: [mpf(1) / 2], 2: [(3 - r(3)) / 6, (3 + r(3)) / 6], 3: [(5 - r(15)) / 10, mpf(1) / 2, (5 + r(15)) / 10]}[stages]
    vandermonde = mp.matrix([[node ** q for node in c] for q in range(stages)])
    integrals = lambda t: list(mp.lu_solve(vandermonde, mp.matrix([t ** (q + 1) / (q + 1) for q in range(stages)])))
    return c, integrals(mpf(1)), [integrals(node) for node in c]


def cohen_hairer(stages):
    c, b, a = tableau(stages)
    nodes, weights, _ = tableau(3)          # exact to degree 5 >= 2 stages
    vandermonde = mp.matrix([[node ** q for node in c] for q in range(stages)])
    basis = [list(mp.lu_solve(vandermonde, mp.matrix([t ** q for q in range(stages)]))) for t in nodes]
    integral = [list(mp.lu_solve(vandermonde, mp.matrix([t ** (q + 1) / (q + 1) for q in range(stages)]))) for t in nodes]

    def step(mu, h):
        def slopes(values):
            k = split(values)
            along = [gradient(axpy((1, mu), *((h * w, kj) for w, kj in zip(integral[q], k)))) for q in range(3)]
            new = []
            for i in range(stages):
                mean = axpy(*((weights[q] * basis[q][i] / b[i], along[q]) for q in range(3)))
                new.append(ad_star(mean, axpy((1, mu), *((h * a[i][j], k[j]) for j in range(stages)))))
            return flat(new)
        k = split(fixed_point(slopes, field(mu) * stages))
        return axpy((1, mu), *((h * b[i], k[i]) for i in range(stages)))
    return step


def clebsch_gauss(stages):
    """q' = -rho(xi) q, p' = rho(xi)^T p by the Gauss method, reduced to W = -q p^T: tr(W rho_i) = mu_i, W in
    the span of the transposed matrices."""
    _, b, a = tableau(stages)
    d = RHO[0].rows
    gram = mp.matrix(N, N)
    trace = lambda m: sum(m[i, i] for i in range(d))
    for i in range(N):
        for j in range(N):
            gram[i, j] = trace(RHO[i].T * RHO[j])
    one = mp.eye(d)

    def block(m, rows, columns):
        out = mp.matrix(d, d)
        for i in range(d):
            for j in range(d):
                out[i, j] = m[rows * d + i, columns * d + j]
        return out

    def products(sign, b_matrices, h):
        """Q_i = 1 + sign h sum a_ij B_j Q_j"""
        big, right = mp.eye(stages * d), mp.matrix(stages * d, d)
        for i in range(stages):
            for r in range(d):
                right[i * d + r, r] = mpf(1)
            for j in range(stages):
                for r in range(d):
                    for s in range(d):
                        big[i * d + r, j * d + s] -= sign * h * a[i][j] * b_matrices[j][r, s]
        solved = mp.inverse(big) * right
        return [block(solved, i, 0) for i in range(stages)]

    def step(mu, h):
        coefficients = mp.lu_solve(gram, mp.matrix(mu))
        w = mp.matrix(d, d)
        for i in range(N):
            w += coefficients[i] * RHO[i].T
        pair = lambda t, q: [trace(w * t * r * q) for r in RHO]

        def solve(values):
            b_matrices = []
            for x in split(values):
                m = mp.matrix(d, d)
                for xi, r in zip(x, RHO):
                    m -= xi * r
                b_matrices.append(m)
            q = products(1, b_matrices, h)
            t = [m.T for m in products(-1, [m.T for m in b_matrices], h)]
            return b_matrices, q, t

        def velocities(values):
            _, q, t = solve(values)
            return flat(gradient(pair(ti, qi)) for ti, qi in zip(t, q))
        x = fixed_point(velocities, gradient(mu) * stages)
        b_matrices, q, t = solve(x)
        q1, t1 = one.copy(), one.copy()
        for i in range(stages):
            q1 += h * b[i] * b_matrices[i] * q[i]
            t1 -= h * b[i] * t[i] * b_matrices[i]
        return pair(t1, q1)
    return step


METHODS = {
    "lie_euler": lie_euler, "rkmk4": rkmk4, "cf4": cf4, "poisson_midpoint": midpoint,
    "discrete_gradient_gonzalez": midpoint, "discrete_gradient_mean_value": midpoint,
    "orbit_energy_gonzalez": orbit_energy, "orbit_energy_mean_value": orbit_energy,
    "retraction_exp": generating(False), "genfun_exp_4": generating(True), "cohen_hairer_2": cohen_hairer(2),
    "clebsch_gauss_1": clebsch_gauss(1), "clebsch_gauss_2": clebsch_gauss(2), "clebsch_gauss_3": clebsch_gauss(3),
}


# ------------------------------------------------------------------ trajectory

def taylor(times, order, step):
    """States at the times, by mu_(k+1) = sum_i ad*_(G mu_i) mu_(k-i) / (k+1)."""
    now, mu, out = mpf(0), MU0, []
    for target in times:
        while now < target:
            h = min(step, target - now)
            coefficients = [mu]
            for k in range(order):
                total = [mpf(0)] * N
                for i in range(k + 1):
                    total = axpy((1, total), (1, ad_star(gradient(coefficients[i]), coefficients[k - i])))
                coefficients.append([t / (k + 1) for t in total])
            mu = [sum(c[i] * h ** k for k, c in enumerate(coefficients)) for i in range(N)]
            now = target if h == target - now else now + h
        out.append(mu)
    return out


def main():
    text = lambda value, digits=34: mp.nstr(mpf(value), digits, strip_zeros=False, min_fixed=-5, max_fixed=5)
    texts = lambda values, digits=34: [text(v, digits) for v in values]
    times = ["0", "1/10", "1/2", "1", "2", "5", "10"]
    goals = [exact(sp.Rational(t)) for t in times[1:]]
    states = taylor(goals, 40, mpf(1) / 10)
    other = taylor(goals, 34, mpf(1) / 16)
    agreement = max(abs(a - b) for a, b in zip(flat(states), flat(other)))
    assert agreement < mpf(10) ** -38, agreement
    point = dict(zip(X, SYSTEM.initial))
    at = lambda expression: exact(sp.Rational(expression.subs(point)))
    xi = [sp.Rational(v) for v in ("-1/12", "1", "1/2", "-8/9", "-1/2", "3/5", "1/3", "-1/4")]
    pi = SYSTEM.poisson()
    vector = {
        "format": "lie-poisson-vector/1", "name": NAME, "note": "su(3) in the basis E_ij-E_ji, i(E_ij+E_ji), i(E_11-E_22), i(E_22-E_33)",
        "dim": N, "index_base": 0,
        "structure_constants": [[i, j, k, str(v)] for (i, j, k), v in sorted(SYSTEM.constants.items()) if i < j],
        "variables": [str(x) for x in X], "parameters": {}, "hamiltonian": str(SYSTEM.hamiltonian).replace("**", "^"),
        "initial_state_expr": [str(v) for v in SYSTEM.initial], "initial_state": texts(MU0),
        "convention": "mu'_j = C_ij^k dH/dmu_i mu_k", "times": times, "states": [texts(MU0)] + [texts(s) for s in states],
        "energy": text(at(SYSTEM.hamiltonian)),
        "casimirs": [{"expr": str(sp.expand(c)).replace("**", "^"), "value": text(at(c))} for _, c in SYSTEM.casimirs],
        "generic_rank": 6, "independent_casimirs": 2, "polynomial_casimir_dimensions": {"1": 0, "2": 1, "3": 1},
        "pointwise_at_initial_state": {
            "gradient": texts(gradient(MU0)), "hessian": [texts(row) for row in G],
            "poisson_matrix": [texts(at(pi[i, j]) for j in range(N)) for i in range(N)], "rhs": texts(field(MU0)),
        },
        "coadjoint": {"xi": [str(v) for v in xi], "Ad_star_exp_xi_mu0": texts(act([exact(v) for v in xi], MU0))},
        "digits_agreement": mp.nstr(agreement, 2),
        "matrix_representation": [[[str(v) for v in m.row(r)] for r in range(m.rows)] for m in SYSTEM.matrices],
    }
    steps = [{"method": name, "h": h, "state": texts(method(MU0, exact(sp.Rational(h))), 32)}
             for name, method in METHODS.items() for h in ("1/10", "-1/5")]
    folder = ROOT / "tests/data/vectors"
    write = lambda name, value: (folder / name).write_text(json.dumps(value, indent=1) + "\n", encoding="utf-8")
    write(f"{NAME}.json", vector)
    write(f"steps_{NAME}.json", {"format": "lie-poisson-steps/1", "system": NAME, "initial_state": f"as in {NAME}.json", "steps": steps})


if __name__ == "__main__":
    main()
