"""A small library of Lie algebras for test data: direct sums, semidirect products, changes of basis.

An algebra is its dimension, its structure constants {(i, j): {k: value}} for i < j, and the Casimirs that
are known, as functions of a list of coordinates.
"""

import sympy as sp


class Algebra:
    def __init__(self, dimension, brackets, casimirs=()):
        self.dimension = dimension
        self.brackets = {}
        for (i, j), value in brackets.items():
            sign = 1 if i < j else -1
            entry = {k: sp.sympify(sign * v) for k, v in value.items() if v != 0}
            if entry:
                self.brackets[min(i, j), max(i, j)] = entry
        self.casimirs = list(casimirs)

    def constant(self, i, j, k):
        """C_ij^k."""
        if i > j:
            return -self.constant(j, i, k)
        return self.brackets.get((i, j), {}).get(k, sp.Integer(0))

    def __add__(self, other):
        """The direct sum."""
        n = self.dimension
        brackets = dict(self.brackets)
        brackets.update({(i + n, j + n): {k + n: v for k, v in value.items()} for (i, j), value in other.brackets.items()})
        casimirs = [lambda x, c=c: c(x[:n]) for c in self.casimirs]
        casimirs += [lambda x, c=c: c(x[n:]) for c in other.casimirs]
        return Algebra(n + other.dimension, brackets, casimirs)

    def semidirect(self, *representations, casimirs=()):
        """The semidirect product with the sum of representations: [e_a, v_j] = sum_i (rho_a)_ij v_i.

        A representation is its list of matrices; the Casimirs must be given anew.
        """
        brackets, first = dict(self.brackets), self.dimension
        for matrices in representations:
            size = matrices[0].rows
            for a, matrix in enumerate(matrices):
                for j in range(size):
                    brackets[a, first + j] = {first + i: matrix[i, j] for i in range(size) if matrix[i, j] != 0}
            first += size
        return Algebra(first, brackets, casimirs)

    def change_basis(self, p):
        """The same algebra in the basis f_a = sum_i p[a, i] e_i; the coordinates become p x."""
        n, inverse, brackets = self.dimension, p.inv(), {}
        for a in range(n):
            for b in range(a + 1, n):
                old = sp.zeros(1, n)
                for (i, j), value in self.brackets.items():
                    weight = p[a, i] * p[b, j] - p[a, j] * p[b, i]
                    for k, v in value.items():
                        old[k] += weight * v
                new = old * inverse
                brackets[a, b] = {c: new[c] for c in range(n) if new[c] != 0}

        def pulled_back(casimir):
            return lambda x: sp.expand(casimir(list(inverse * sp.Matrix(x))))

        return Algebra(n, brackets, [pulled_back(c) for c in self.casimirs])


def dot(x, y):
    return sum(a * b for a, b in zip(x, y))


def _matrix(size, *entries):
    m = sp.zeros(size)
    for i, j, v in entries:
        m[i, j] = v
    return m


VECTOR = [_matrix(3, (1, 2, -1), (2, 1, 1)), _matrix(3, (0, 2, 1), (2, 0, -1)), _matrix(3, (0, 1, -1), (1, 0, 1))]
PAIRS = [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)]
VECTOR4 = [_matrix(4, (j, i, 1), (i, j, -1)) for i, j in PAIRS]
SL2_STANDARD = [_matrix(2, (0, 0, 1), (1, 1, -1)), _matrix(2, (0, 1, 1)), _matrix(2, (1, 0, 1))]
GL2_STANDARD = [_matrix(2, (i, j, 1)) for i in range(2) for j in range(2)]


def from_matrices(matrices, casimirs=()):
    """The span of linearly independent matrices."""
    n = len(matrices)
    columns = sp.Matrix.hstack(*(m.reshape(m.rows * m.cols, 1) for m in matrices))
    left_inverse = (columns.T * columns).inv() * columns.T
    brackets = {}
    for i in range(n):
        for j in range(i + 1, n):
            bracket = matrices[i] * matrices[j] - matrices[j] * matrices[i]
            value = left_inverse * bracket.reshape(bracket.rows * bracket.cols, 1)
            brackets[i, j] = {k: value[k] for k in range(n) if value[k] != 0}
    return Algebra(n, brackets, casimirs)


def line():
    return Algebra(1, {}, [lambda x: x[0]])


def aff1():
    return Algebra(2, {(0, 1): {1: 1}})


def so3():
    return from_matrices(VECTOR, [lambda x: dot(x, x)])


def so3_deformed(k):
    """so(3) with [e_1, e_2] = k e_3: isomorphic to so(3) for k > 0, to sl(2) for k < 0."""
    return Algebra(3, {(0, 1): {2: k}, (1, 2): {0: 1}, (2, 0): {1: 1}}, [lambda x: x[0]**2 + x[1]**2 + k * x[2]**2])


def sl2():
    return from_matrices(SL2_STANDARD, [lambda x: x[0]**2 + 4 * x[1] * x[2]])


def gl2():
    return from_matrices(GL2_STANDARD, [lambda x: x[0] + x[3], lambda x: x[0] * x[3] - x[1] * x[2]])


def heisenberg():
    return Algebra(3, {(0, 1): {2: 1}}, [lambda x: x[2]])


def e2():
    return Algebra(3, {(0, 1): {2: 1}, (0, 2): {1: -1}}, [lambda x: x[1]**2 + x[2]**2])


def se3():
    return so3().semidirect(VECTOR, casimirs=[lambda x: dot(x[3:], x[3:]), lambda x: dot(x[:3], x[3:])])


def so3_two_vectors():
    return so3().semidirect(VECTOR, VECTOR, casimirs=[
        lambda x: dot(x[3:6], x[3:6]), lambda x: dot(x[6:], x[6:]), lambda x: dot(x[3:6], x[6:])])


def sl2_plane():
    """sl(2) acting on the plane; the Casimir is mu evaluated at the square of the vector."""
    return sl2().semidirect(SL2_STANDARD, casimirs=[lambda x: x[0] * x[3] * x[4] + x[1] * x[4]**2 - x[2] * x[3]**2])


def gl2_plane():
    """The affine algebra of the plane; generic rank 6, so there is no Casimir."""
    return gl2().semidirect(GL2_STANDARD)


def so4_space():
    """so(4) acting on R^4: |p|^2 and the square of l_ij p_k + l_jk p_i + l_ki p_j."""
    def pauli_lubanski(x):
        l, p = {}, x[6:]
        for index, (i, j) in enumerate(PAIRS):
            l[i, j], l[j, i] = x[index], -x[index]
        triples = [(0, 1, 2), (0, 1, 3), (0, 2, 3), (1, 2, 3)]
        return sum((l[i, j] * p[k] + l[j, k] * p[i] + l[k, i] * p[j])**2 for i, j, k in triples)

    return from_matrices(VECTOR4).semidirect(VECTOR4, casimirs=[lambda x: dot(x[6:], x[6:]), pauli_lubanski])
