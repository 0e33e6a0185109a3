//! Free rigid bodies: so(3) with a quadratic H, and so(n) with
//! `H = sum_(i<j) M_ij^2/(2 (J_i + J_j))`, or the same in other axes.
//!
//! so(n), n >= 4, is recognised from its structure constants in any order of the basis
//! `+-(E_ij - E_ji)`. The moments `J_i = (1/a_ij + 1/a_ik - 1/a_jk)/2` for `H = sum a_ij M_ij^2/2` must give all
//! `1/a_ij = J_i + J_j`, identically in the parameters; it is proven by the normal form that verifies
//! Casimirs. Of another quadratic form the matrix J is looked for as the solution of linear equations.

mod tilted;

use super::Structure;
use super::spins::Spin;
use crate::model::Model;
use lie_symbolic::exact::{Budget, Rational};
use lie_symbolic::prove::normal::{NormalForm, Verdict};
use lie_symbolic::symbolic::{ExprId, Graph, Symbol};

/// Work allowed for the identities of one Hamiltonian.
const WORK: u64 = 500_000;

/// A free rigid body.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Body {
    /// so(3); nothing else is needed.
    Three,
    /// so(n), n >= 4.
    Many {
        /// From and to of each basis element `E_(to, from) - E_(from, to)`.
        planes: Vec<(usize, usize)>,
        /// The moments `J_ii`, in the arena that was given.
        moments: Vec<ExprId>,
        /// The products of inertia `J_ij`, i < j, that are not zero.
        products: Vec<((usize, usize), ExprId)>,
    },
}

/// Why a system is no free rigid body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Other {
    /// It is neither so(3) nor so(n) in a basis of planes of rotation.
    Algebra,
    /// H is no quadratic form with constant coefficients.
    NotQuadratic,
    /// It is one of so(n), and that of no matrix J.
    NoMoments,
}

/// The body of a system; `graph` is a copy of the arena of the model, to which the moments are added.
///
/// # Errors
/// Why it is none.
pub fn body(model: &Model, spins: Option<&[Spin]>, graph: &mut Graph) -> Result<Body, Other> {
    let planes = match spins {
        Some(spins) if spins.len() == 1 => None,
        _ => Some(planes(model).ok_or(Other::Algebra)?),
    };
    let form = form(model, graph).ok_or(Other::NotQuadratic)?;
    let Some(planes) = planes else {
        return Ok(Body::Three);
    };
    let moments = squares(&form, graph).map(|squares| moments(graph, &planes, &squares));
    let body = match moments {
        Some(moments) => moments.map(|moments| Body::Many {
            planes,
            moments,
            products: Vec::new(),
        }),
        None => tilted::body(graph, &planes, &form),
    };
    body.ok_or(Other::NoMoments)
}

/// The rows of H'', if H is a quadratic form of the coordinates and a constant.
fn form(model: &Model, graph: &mut Graph) -> Option<Vec<Vec<ExprId>>> {
    let hamiltonian = model.energy.expression()?;
    if hamiltonian.degree != Some(2) {
        return None;
    }
    let n = model.dimension();
    let coordinates: Vec<ExprId> = (0..n)
        .map(|i| graph.symbol(Symbol::Coordinate(i)))
        .collect();
    let (mut rows, mut vanishing) = (Vec::new(), Vec::new());
    for i in 0..n {
        let slope = graph.derivative(hamiltonian.value, Symbol::Coordinate(i));
        let row: Vec<ExprId> = (0..n)
            .map(|j| graph.derivative(slope, Symbol::Coordinate(j)))
            .collect();
        let constant = |symbol: &Symbol| !matches!(symbol, Symbol::Coordinate(_));
        let constants = |entry: &ExprId| graph.symbols(*entry).iter().all(constant);
        if !row.iter().all(constants) {
            return None;
        }
        let products = row.iter().zip(&coordinates);
        let products: Vec<ExprId> = products.map(|(a, x)| graph.mul(*a, *x)).collect();
        let linear = graph.sum(&products);
        vanishing.push(graph.sub(slope, linear));
        rows.push(row);
    }
    let budget = Budget::new(WORK);
    let mut normal = NormalForm::new(graph, &budget);
    let mut zero = |id: &ExprId| matches!(normal.verdict(*id), Verdict::Zero);
    vanishing.iter().all(&mut zero).then_some(rows)
}

/// The coefficients `a_k` of `H = sum a_k x_k^2/2`, none of which vanishes.
fn squares(form: &[Vec<ExprId>], graph: &Graph) -> Option<Vec<ExprId>> {
    let budget = Budget::new(WORK);
    let mut normal = NormalForm::new(graph, &budget);
    let mut zero = |id: ExprId| matches!(normal.verdict(id), Verdict::Zero);
    for (i, row) in form.iter().enumerate() {
        let mut entries = row.iter().enumerate();
        if !entries.all(|(j, entry)| zero(*entry) == (i != j)) {
            return None;
        }
    }
    Some((0..form.len()).map(|k| form[k][k]).collect())
}

/// The moments, if there are any.
fn moments(
    graph: &mut Graph,
    planes: &[(usize, usize)],
    squares: &[ExprId],
) -> Option<Vec<ExprId>> {
    let size = planes.iter().map(|(i, j)| 1 + i.max(j)).max()?;
    let mut sums = vec![vec![None; size]; size];
    for (&(i, j), &square) in planes.iter().zip(squares) {
        let sum = graph.power_product(&[(square, Rational::MINUS_ONE)]);
        sums[i][j] = Some(sum);
        sums[j][i] = Some(sum);
    }
    let half = Rational::new(1, 2)?;
    let mut moments = Vec::new();
    for i in 0..size {
        let (j, k) = ((i + 1) % size, (i + 2) % size);
        moments.push(graph.linear(&[
            (sums[i][j]?, half.clone()),
            (sums[i][k]?, half.clone()),
            (sums[j][k]?, -&half),
        ]));
    }
    let mut rests = Vec::new();
    for &(i, j) in planes {
        rests.push(graph.linear(&[
            (moments[i], Rational::ONE),
            (moments[j], Rational::ONE),
            (sums[i][j]?, Rational::MINUS_ONE),
        ]));
    }
    let budget = Budget::new(WORK);
    let mut normal = NormalForm::new(graph, &budget);
    let all = rests
        .iter()
        .all(|id| matches!(normal.verdict(*id), Verdict::Zero));
    all.then_some(moments)
}

/// From and to of each basis element, if the algebra is so(n), n >= 4, in such a basis.
fn planes(model: &Model) -> Option<Vec<(usize, usize)>> {
    let n = model.dimension();
    let size = (4..=n).find(|size| size * (size - 1) / 2 >= n)?;
    if size * (size - 1) / 2 != n {
        return None;
    }
    // table[a][b] = (c, +-1) for [e_a, e_b] = +-e_c
    let mut table = vec![vec![None; n]; n];
    for (a, b, c, value) in model.bracket.algebra()?.exact.entries() {
        let sign = match value.as_constant()? {
            one if one.is_one() => 1,
            minus if (-&minus).is_one() => -1,
            _ => return None,
        };
        if table[*a][*b].replace((*c, sign)).is_some() {
            return None;
        }
        table[*b][*a] = Some((*c, -sign));
    }
    // axis 0 is shared by e_0 and the first element that does not commute with it; the others that
    // turn it commute with neither, and are not the commutator of the two
    let partner = (1..n).find(|&b| table[0][b].is_some())?;
    let (third, _) = table[0][partner]?;
    let mut star = vec![0, partner];
    star.extend((1..n).filter(|&b| {
        b != partner && b != third && table[0][b].is_some() && table[partner][b].is_some()
    }));
    if star.len() != size - 1 {
        return None;
    }
    // [E_0j, E_0k] = E_jk with E_ij = E_(j, i) - E_(i, j)
    let mut planes = vec![None; n];
    for (index, &element) in star.iter().enumerate() {
        planes[element] = Some((0, index + 1));
    }
    for (j, &first) in star.iter().enumerate() {
        for (k, &second) in star.iter().enumerate().skip(j + 1) {
            let (element, sign) = table[first][second]?;
            let plane = if sign > 0 {
                (j + 1, k + 1)
            } else {
                (k + 1, j + 1)
            };
            if planes[element].replace(plane).is_some() {
                return None;
            }
        }
    }
    let planes: Vec<(usize, usize)> = planes.into_iter().collect::<Option<_>>()?;
    verified(&planes, &table).then_some(planes)
}

/// Whether the planes have the brackets of the table.
fn verified(planes: &[(usize, usize)], table: &[Vec<Option<(usize, i32)>>]) -> bool {
    let find = |from: usize, to: usize| {
        let forward = planes.iter().position(|p| *p == (from, to));
        let backward = planes.iter().position(|p| *p == (to, from));
        forward.map(|c| (c, 1)).or(backward.map(|c| (c, -1)))
    };
    planes.iter().enumerate().all(|(a, &(i, j))| {
        planes.iter().enumerate().all(|(b, &(k, l))| {
            // R_ij = E_ji - E_ij: [R_ij, R_ik] = R_jk, and signs by R_ij = -R_ji
            let expected = if a == b {
                None
            } else if i == k {
                find(j, l)
            } else if i == l {
                find(j, k).map(|(c, sign)| (c, -sign))
            } else if j == k {
                find(i, l).map(|(c, sign)| (c, -sign))
            } else if j == l {
                find(i, k)
            } else {
                None
            };
            expected == table[a][b]
        })
    })
}

/// Why the discrete rigid body does not apply, with the nearest method that does.
pub fn refusal(structure: &Structure) -> Option<(String, String)> {
    let other = structure.body.as_ref().err()?;
    let remedy = "use `orbit-energy`, which keeps the orbit and the energy of every system, or \
                  `lie-midpoint`, which is a Poisson map";
    let reason = match (other, structure.why_not_declared_algebra()) {
        (Other::Algebra, Some(larger)) => return Some((larger, remedy.into())),
        (Other::Algebra, None) => {
            "it needs so(3) in a basis with [e1, e2] = c e3 and cyclic, or so(n) in a basis of \
             matrices E_ij - E_ji"
        }
        (Other::NotQuadratic, _) => {
            "it needs a free rigid body: H must be a quadratic form with constant coefficients"
        }
        (Other::NoMoments, _) => {
            "it needs a free rigid body, M = J W + W J with a symmetric matrix J and W = grad H(M), and there is no such J for the \
             declared H"
        }
    };
    Some((reason.into(), remedy.into()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compile::compile_spec;

    fn spec(name: &str) -> Structure {
        let path = format!("{}/../../specs/{name}.json", env!("CARGO_MANIFEST_DIR"));
        let text = std::fs::read_to_string(path).expect("the spec");
        compile_spec(&text).expect("a sound spec")
    }

    #[test]
    fn moments_of_the_manakov_top_are_its_parameters() {
        let model = spec("so4_manakov");
        let Ok(Body::Many {
            planes, moments, ..
        }) = &model.body
        else {
            panic!("{:?}", model.body);
        };
        let mut graph = model.graph.clone();
        let basis = ["E12", "E13", "E14", "E23", "E24", "E34"];
        for (name, (from, to)) in basis.iter().zip(planes) {
            assert_eq!(*name, format!("E{}{}", from + 1, to + 1));
        }
        for (axis, moment) in moments.iter().enumerate() {
            let parameter = graph.symbol(Symbol::Parameter(axis));
            let rest = graph.sub(*moment, parameter);
            let budget = Budget::new(WORK);
            let verdict = NormalForm::new(&graph, &budget).verdict(rest);
            assert!(matches!(verdict, Verdict::Zero));
        }
    }

    #[test]
    fn other_systems_are_refused_for_their_reason() {
        assert_eq!(spec("so3_free_rigid_body").body, Ok(Body::Three));
        assert_eq!(spec("so3_nonpolynomial").body, Err(Other::NotQuadratic));
        assert_eq!(spec("se3_heavy_top").body, Err(Other::Algebra));
        assert_eq!(spec("su3_quadratic").body, Err(Other::Algebra));
        assert_eq!(spec("sl2_quadratic").body, Err(Other::Algebra));
    }

    /// Every symmetric J is found in the H that it makes, also with an exact parameter, and a quadratic form of no J is refused.
    #[test]
    fn products_of_inertia_are_found() {
        let of = |hamiltonian: &str| {
            let text = format!(
                r#"{{"format": 1, "name": "Four", "algebra": "so(4)", "state": ["a", "b", "c", "d", "e", "f"],
                    "parameters": {{"k": 2}}, "hamiltonian": "{hamiltonian}"}}"#
            );
            compile_spec(&text).expect("a sound spec")
        };
        // J = diag(1, 1, 1, 1)/2 with J_12 = k/10: planes (1, 3) and (2, 3) are coupled, and (1, 4) and (2, 4)
        let coupled = "(b^2 + d^2 - 2*(k/10)*b*d + c^2 + e^2 - 2*(k/10)*c*e)/(2*(1 - k^2/100))";
        let model = of(&format!("(a^2 + f^2)/2 + {coupled}"));
        let Ok(Body::Many {
            moments, products, ..
        }) = &model.body
        else {
            panic!("{:?}", model.body);
        };
        let value = |graph: &Graph, id| graph.evaluate(id, &|_| 2.0);
        let graph = &model.graph;
        for moment in moments {
            assert!((value(graph, *moment) - 0.5).abs() < 1e-15);
        }
        let [((0, 1), product)] = products[..] else {
            panic!("{products:?}");
        };
        assert!((value(graph, product) - 0.2).abs() < 1e-15);
        let none = of("(a^2 + f^2)/2 + (b^2 + d^2 - b*d/5)/2 + (c^2 + e^2)/2");
        assert_eq!(none.body, Err(Other::NoMoments));
    }
}
