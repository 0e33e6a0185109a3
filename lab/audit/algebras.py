"""Lie algebras as spans of matrices; their structure constants come from products of these matrices alone."""

from fractions import Fraction


def unit(n, *entries):
    """An n x n matrix with the entries (row, column, value)."""
    matrix = [[Fraction(0)] * n for _ in range(n)]
    for i, j, value in entries:
        matrix[i][j] += Fraction(value)
    return matrix


def turn(n, i, j):
    """The generator of the rotation in the plane of two axes."""
    return unit(n, (i, j, -1), (j, i, 1))


def boost(n, i, j):
    return unit(n, (i, j, 1), (j, i, 1))


def turns(n, first=0):
    """so(3) on three of n axes, in the order that makes [e1, e2] = e3."""
    a, b, c = first, first + 1, first + 2
    return [turn(n, b, c), turn(n, c, a), turn(n, a, b)]


def moves(n, axes):
    """Translations along axes, as affine maps."""
    return [unit(n, (axis, n - 1, 1)) for axis in axes]


def heisenberg(pairs):
    n = pairs + 2
    q = [unit(n, (0, k + 1, 1)) for k in range(pairs)]
    p = [unit(n, (k + 1, n - 1, 1)) for k in range(pairs)]
    return q + p + [unit(n, (0, n - 1, 1))]


def doubled(real, imaginary):
    """A complex matrix as a real one of twice its size."""
    n = len(real)
    out = [[Fraction(0)] * (2 * n) for _ in range(2 * n)]
    for i in range(n):
        for j in range(n):
            out[i][j] = out[i + n][j + n] = Fraction(real[i][j])
            out[i + n][j] = Fraction(imaginary[i][j])
            out[i][j + n] = -Fraction(imaginary[i][j])
    return out


def special_unitary(n):
    zero = unit(n)
    basis = []
    for i in range(n):
        for j in range(i + 1, n):
            basis.append(doubled(turn(n, i, j), zero))
            basis.append(doubled(zero, boost(n, i, j)))
    return basis + [doubled(zero, unit(n, (k, k, 1), (k + 1, k + 1, -1))) for k in range(n - 1)]


def sum_of(first, second):
    """The direct sum, as blocks."""
    n, m = len(first[0]), len(second[0])

    def block(matrix, at):
        return unit(n + m, *((at + i, at + j, v) for i, row in enumerate(matrix) for j, v in enumerate(row)))

    return [block(a, 0) for a in first] + [block(b, n) for b in second]


SO3 = turns(3)
SL2 = [unit(2, (0, 0, 1), (1, 1, -1)), unit(2, (0, 1, 1)), unit(2, (1, 0, 1))]
AFFINE_LINE = [unit(2, (0, 0, 1)), unit(2, (0, 1, 1))]
SE2 = [turn(3, 0, 1), *moves(3, range(2))]
ALGEBRAS = {
    "so(3)": SO3,
    "sl(2)": SL2,
    "so(2,1)": [turn(3, 0, 1), boost(3, 0, 2), boost(3, 1, 2)],
    "se(2)": SE2,
    "se(1,1)": [boost(3, 0, 1), *moves(3, range(2))],
    "aff(1)": AFFINE_LINE,
    "heisenberg(1)": heisenberg(1),
    "heisenberg(2)": heisenberg(2),
    # the oscillator algebra: rotations of one pair
    "diamond": [
        unit(4, (1, 2, 1), (2, 1, -1)),
        unit(4, (0, 1, 1), (2, 3, 1)),
        unit(4, (0, 2, 1), (1, 3, -1)),
        unit(4, (0, 3, 2)),
    ],
    "gl(2)": [unit(2, (i, j, 1)) for i in range(2) for j in range(2)],
    "se(3)": [*turns(4), *moves(4, range(3))],
    "so(4)": [turn(4, i, j) for i in range(4) for j in range(i + 1, 4)],
    "so(3,1)": [*turns(4), *(boost(4, k, 3) for k in range(3))],
    "so(3) + so(3)": sum_of(SO3, SO3),
    "so(3) + heisenberg(1)": sum_of(SO3, heisenberg(1)),
    "sl(2) + aff(1)": sum_of(SL2, AFFINE_LINE),
    "so(3) + se(2)": sum_of(SO3, SE2),
    "filiform(5)": [
        unit(5, (0, 1, 1), (1, 2, 1), (2, 3, 1)),
        *(unit(5, (k, 4, 1)) for k in (3, 2, 1, 0)),
    ],
    "su(3)": special_unitary(3),
}


def times(a, b):
    columns = list(zip(*b))
    return [[sum((x * y for x, y in zip(row, column) if x and y), Fraction(0)) for column in columns] for row in a]


def commutator(a, b):
    return [[x - y for x, y in zip(r, s)] for r, s in zip(times(a, b), times(b, a))]


def coordinates(basis, matrix):
    """Of a matrix in a basis, by elimination over the rationals; None outside of the span."""
    rows = [[m[i][j] for m in basis] + [matrix[i][j]] for i in range(len(matrix)) for j in range(len(matrix))]
    n, rank = len(basis), 0
    for column in range(n):
        pivot = next((r for r in range(rank, len(rows)) if rows[r][column]), None)
        if pivot is None:
            raise ValueError("the matrices of a basis depend on each other")
        rows[rank], rows[pivot] = rows[pivot], rows[rank]
        head = rows[rank][column]
        rows[rank] = [x / head for x in rows[rank]]
        for r, row in enumerate(rows):
            if r != rank and row[column]:
                rows[r] = [x - row[column] * y for x, y in zip(row, rows[rank])]
        rank += 1
    return None if any(row[n] for row in rows[rank:]) else [rows[k][n] for k in range(n)]


def sheared(rng, basis, shears):
    """Another basis of the same span: some elements take others along, some are scaled."""
    basis = [[row[:] for row in m] for m in basis]
    rng.shuffle(basis)
    for _ in range(shears):
        a, b = rng.sample(range(len(basis)), 2)
        factor = rng.choice([Fraction(1), Fraction(-1), Fraction(1, 2), Fraction(2, 3)])
        basis[a] = [[x + factor * y for x, y in zip(r, s)] for r, s in zip(basis[a], basis[b])]
    return basis


def structure_constants(basis):
    """C with [e_i, e_j] = sum_k C[i][j][k] e_k."""
    n = len(basis)
    constants = [[[Fraction(0)] * n for _ in range(n)] for _ in range(n)]
    for i in range(n):
        for j in range(i + 1, n):
            entries = coordinates(basis, commutator(basis[i], basis[j]))
            if entries is None:
                raise ValueError("the matrices do not span an algebra")
            constants[i][j] = entries
            constants[j][i] = [-x for x in entries]
    return constants
