//! Multipliers of first integrals with which the Hessian is definite.

use std::f64::consts::FRAC_PI_2;

use lie_symbolic::exact::Rational;

use crate::arithmetic::{Arithmetic as _, Rationals};
use crate::dense::{Singular, add, norm, restricted, symmetric_eigen};
use crate::proof::{Tangent, inertia};
use crate::stability::{FLAT, Reason};
use crate::system::{Equations, Shape, Sizes};

/// A first integral is stationary where its gradient on the leaf is below this part of it.
const STATIONARY: f64 = 1e-8;
/// A form is positive where its smallest eigenvalue is above this part of its size.
const MARGIN: f64 = 1e-7;
/// Steps towards weights of three or more forms.
const ASCENT: u32 = 300;
/// Bits of the multipliers of a proof.
const BITS: f64 = 1048576.0;
/// Multipliers of first integrals with which the Hessian is definite.
pub fn with_integrals(
    own: &[Vec<f64>],
    equations: &Equations,
    shape: &Shape<f64>,
    family: usize,
) -> Option<Reason> {
    let Sizes { n, m, .. } = equations.sizes;
    if shape.integrals.is_empty() {
        return None;
    }
    let transposed = transposed(&shape.gradients, m, n);
    let fit = (m > 0).then(|| Singular::new(&transposed, n, m)).flatten();
    let (mut forms, mut stationary, mut held) =
        (vec![shape.hessian.clone()], Vec::new(), Vec::new());
    let mut normals = shape.gradients.clone();
    for (place, (gradient, hessian)) in shape.integrals.iter().enumerate() {
        let multipliers = match &fit {
            Some(fit) => fit.shortest(gradient, m),
            None => Vec::new(),
        };
        let (mut rest, mut form) = (gradient.clone(), hessian.clone());
        for (k, kappa) in multipliers.iter().enumerate() {
            add(&mut rest, -kappa, &shape.gradients[k * n..(k + 1) * n]);
            add(&mut form, -kappa, &shape.casimirs[k]);
        }
        if norm(&rest) <= STATIONARY * norm(gradient).max(norm(hessian)) {
            stationary.push(place);
            forms.push(form);
        } else {
            held.push(place);
            normals.extend(gradient);
        }
    }
    let rows = m + held.len();
    let tangent = match held.is_empty() {
        true => own.to_vec(),
        false => {
            let singular = Singular::new(&normals, rows, n)?;
            let rank = singular.rank(STATIONARY);
            singular.kernel(rank).to_vec()
        }
    };
    let r = tangent.len();
    let forms: Vec<Vec<f64>> = forms
        .iter()
        .map(|form| restricted(form, n, &tangent))
        .collect();
    let weights = definite(&forms, r, family)?;
    let name = |place: &usize| equations.system.integrals[*place].name.clone();
    Some(Reason::Integrals {
        energy: weights[0],
        stationary: stationary
            .iter()
            .map(name)
            .zip(weights[1..].iter().copied())
            .collect(),
        held: held.iter().map(name).collect(),
    })
}

/// Weights with which forms on r directions add up to a positive one but on a kernel of this dimension.
///
/// With an eigenvector v of a sum that is not positive, the weights w that make it so have `sum_i w_i v^T B_i v > 0`: of two forms that leaves half
/// of the directions that are left each time.
fn definite(forms: &[Vec<f64>], r: usize, kernel: usize) -> Option<Vec<f64>> {
    let sizes = forms.iter().map(|form| norm(form).max(f64::MIN_POSITIVE));
    let sizes: Vec<f64> = sizes.collect();
    // the smallest eigenvalue but for those of the kernel, and its slope by the weights
    let least = |weights: &[f64]| {
        let mut sum = vec![0.0; r * r];
        for ((weight, form), size) in weights.iter().zip(forms).zip(&sizes) {
            add(&mut sum, weight / size, form);
        }
        let (values, vectors) = symmetric_eigen(&sum, r)?;
        let place = if values.first()? < &-FLAT { 0 } else { kernel };
        let vector = vectors.get(place)?;
        let slope = forms.iter().zip(&sizes);
        let slope =
            slope.map(|(form, size)| restricted(form, r, std::slice::from_ref(vector))[0] / size);
        Some((values[place], slope.collect::<Vec<f64>>()))
    };
    let found = |weights: Vec<f64>| {
        Some(
            weights
                .iter()
                .zip(&sizes)
                .map(|(w, size)| w / size)
                .collect(),
        )
    };
    let mut first = vec![0.0; forms.len()];
    for sign in [1.0, -1.0] {
        first[0] = sign;
        if least(&first)?.0 > MARGIN {
            return found(first);
        }
    }
    if forms.len() == 2 {
        let turn = |angle: f64| vec![angle.cos(), angle.sin()];
        let (_, slope) = least(&first)?;
        let middle = slope[1].atan2(slope[0]);
        let (mut low, mut high) = (middle - FRAC_PI_2, middle + FRAC_PI_2);
        while high - low > MARGIN {
            let middle = 0.5 * (low + high);
            let (value, slope) = least(&turn(middle))?;
            if value > MARGIN {
                return found(turn(middle));
            }
            match slope[1] * middle.cos() - slope[0] * middle.sin() > 0.0 {
                true => low = middle,
                false => high = middle,
            }
        }
        return None;
    }
    if forms.len() < 2 {
        return None;
    }
    // the smallest eigenvalue is concave in the weights: along its slope upwards
    let mut weights = first;
    for k in 0..ASCENT {
        let (value, slope) = least(&weights)?;
        if value > MARGIN {
            return found(weights);
        }
        add(&mut weights, 1.0 / f64::from(k + 2), &slope);
        let length = norm(&weights).max(f64::MIN_POSITIVE);
        weights.iter_mut().for_each(|weight| *weight /= length);
    }
    None
}
/// The same definite combination in rational numbers.
pub fn definite_exactly(
    equations: &Equations,
    shape: &Shape<Rational>,
    reason: &Reason,
    family: usize,
) -> Option<()> {
    let Reason::Integrals {
        energy,
        stationary,
        held,
    } = reason
    else {
        return None;
    };
    let (n, a) = (equations.sizes.n, &Rationals);
    let round = |x: f64, scale: f64| Rational::from_f64((x / scale * BITS).round() / BITS);
    let scale = stationary
        .iter()
        .map(|(_, w)| w.abs())
        .fold(energy.abs(), f64::max);
    let weight = round(*energy, scale)?;
    let mut form: Vec<Rational> = shape.hessian.iter().map(|x| &weight * x).collect();
    let place = |name: &String| {
        equations
            .system
            .integrals
            .iter()
            .position(|f| f.name == *name)
    };
    for (name, w) in stationary {
        let (gradient, hessian) = &shape.integrals[place(name)?];
        let kappa = multipliers(n, &shape.gradients, gradient)?;
        let weight = round(*w, scale)?;
        for (k, entry) in form.iter_mut().enumerate() {
            let mut own = hessian[k].clone();
            for (kappa, casimir) in kappa.iter().zip(&shape.casimirs) {
                own = &own - &(kappa * &casimir[k]);
            }
            *entry = a.add(entry, &(&weight * &own));
        }
    }
    let mut rows = shape.gradients.clone();
    for name in held {
        rows.extend(shape.integrals[place(name)?].0.iter().cloned());
    }
    let tangent = Tangent::new(a, n, &rows)?;
    inertia(a, tangent.form(a, &form))?
        .is_definite(family)
        .then_some(())
}

/// The multipliers with which rows add up to a vector, exactly.
fn multipliers(n: usize, rows: &[Rational], vector: &[Rational]) -> Option<Vec<Rational>> {
    let m = rows.len() / n.max(1);
    let columns = (0..n).map(|i| (0..m).map(|k| rows[k * n + i].clone()).collect());
    let columns: Vec<Vec<Rational>> = columns.collect();
    let budget = lie_symbolic::exact::Budget::new(1_000_000);
    lie_symbolic::exact::matrix::solve(&columns, vector, &budget).ok()?
}

fn transposed(rows: &[f64], m: usize, n: usize) -> Vec<f64> {
    (0..n)
        .flat_map(|i| (0..m).map(move |k| rows[k * n + i]))
        .collect()
}
