//! Systems by a discrete Lagrangian in entries: the declaration, and value and slope written by hand.

use crate::matrices::{Matrix, identity};

/// A system.
pub struct Body {
    pub name: &'static str,
    pub right: bool,
    pub basis: Vec<Matrix>,
    /// As it is declared, in the entries `R11`, `R12`, ...
    pub text: String,
    /// `l_d(f)` for a step h.
    pub value: fn(&Matrix, f64) -> f64,
    /// `dl_d/df_ab`
    pub slope: fn(&Matrix, f64) -> Matrix,
    pub start: Vec<f64>,
}

impl Body {
    pub fn spec(&self) -> String {
        let n = self.basis.len();
        let names = |letter: &str| {
            let names = (1..=n).map(|a| format!("{:?}", format!("{letter}{a}")));
            names.collect::<Vec<String>>().join(", ")
        };
        let matrices = self.basis.iter().enumerate();
        let matrices = matrices.map(|(a, matrix)| format!("\"e{}\": {matrix:?}", a + 1));
        let matrices = matrices.collect::<Vec<String>>().join(", ");
        let invariance = if self.right { "right" } else { "left" };
        format!(
            "{{\"format\": 1, \"name\": {:?}, \"algebra\": {{\"basis\": [{}], \"matrices\": {{{matrices}}}}}, \"group\": \"R\", \
             \"invariance\": {invariance:?}, \"state\": [{}], \"velocity\": [{}], \"discrete_lagrangian\": {:?}, \"initial\": {:?}}}",
            self.name,
            names("e"),
            names("m"),
            names("x"),
            self.text,
            self.start
        )
    }
}

fn unit(size: usize, entries: &[(usize, usize, f64)]) -> Matrix {
    let mut matrix = vec![vec![0.0; size]; size];
    for &(i, j, value) in entries {
        matrix[i][j] = value;
    }
    matrix
}

/// The turn from axis i to axis j.
fn turn(size: usize, i: usize, j: usize) -> Matrix {
    unit(size, &[(i, j, -1.0), (j, i, 1.0)])
}

const MOMENTS: [f64; 5] = [0.5, 1.25, 0.75, 2.0, 1.5];

/// `sum_k J_k (1 - f_kk)/h`
fn turned(f: &Matrix, h: f64) -> f64 {
    let diagonal = MOMENTS.iter().enumerate().take(f.len());
    diagonal.map(|(k, j)| j * (1.0 - f[k][k])).sum::<f64>() / h
}

fn slope_of_turned(f: &Matrix, h: f64) -> Matrix {
    let mut slope = identity(f.len());
    for (k, row) in slope.iter_mut().enumerate() {
        row.iter_mut()
            .for_each(|entry| *entry *= -MOMENTS.get(k).unwrap_or(&0.0) / h);
    }
    slope
}

fn text_of_turned(rows: usize) -> String {
    let terms = (0..rows).map(|k| format!("{}*(1 - R{}{})", MOMENTS[k], k + 1, k + 1));
    format!("({})/h", terms.collect::<Vec<String>>().join(" + "))
}

/// Moser and Veselov's body, with the axes of so(3) in their order.
pub fn turning(right: bool) -> Body {
    Body {
        name: "Turning",
        right,
        basis: vec![turn(3, 1, 2), turn(3, 2, 0), turn(3, 0, 1)],
        text: text_of_turned(3),
        value: turned,
        slope: slope_of_turned,
        start: vec![1.0, 0.6, -1.2],
    }
}

/// All matrices of two rows, with a function of `g - 1` alone.
pub fn general() -> Body {
    let unit = |k: usize| {
        let mut matrix = vec![vec![0.0; 2]; 2];
        matrix[k / 2][k % 2] = 1.0;
        matrix
    };
    Body {
        name: "General",
        right: false,
        basis: (0..4).map(unit).collect(),
        text: "((R11 - 1)^2 + R12^2 + R21^2 + (R22 - 1)^2)/(2*h)".to_owned(),
        value: |f, h| {
            let entries = f.iter().flatten().zip([1.0, 0.0, 0.0, 1.0]);
            entries.map(|(f, one)| (f - one) * (f - one)).sum::<f64>() / (2.0 * h)
        },
        slope: |f, h| {
            let mut slope = f.clone();
            (0..2).for_each(|k| slope[k][k] -= 1.0);
            slope.iter_mut().flatten().for_each(|entry| *entry /= h);
            slope
        },
        start: vec![0.9, -0.6, 1.2, 0.3],
    }
}

/// The same in five dimensions.
pub fn five(right: bool) -> Body {
    let pairs = (0..5).flat_map(|i| (i + 1..5).map(move |j| (i, j)));
    Body {
        name: "Five",
        right,
        basis: pairs.map(|(i, j)| turn(5, i, j)).collect(),
        text: text_of_turned(5),
        value: turned,
        slope: slope_of_turned,
        start: vec![0.9, -0.6, 1.2, 0.3, 1.5, -0.9, 0.6, 1.8, -0.3, 1.05],
    }
}

/// `J_i + J_j` of its axes.
pub fn kinetic(body: &Body) -> Vec<f64> {
    let size = body.basis[0].len();
    let pairs = (0..size).flat_map(|i| (i + 1..size).map(move |j| (i, j)));
    pairs.map(|(i, j)| MOMENTS[i] + MOMENTS[j]).collect()
}

/// A body in the plane with two masses: se(2), translations in the last column.
pub fn euclidean(right: bool) -> Body {
    Body {
        name: "Euclidean",
        right,
        basis: vec![
            turn(3, 0, 1),
            unit(3, &[(0, 2, 1.0)]),
            unit(3, &[(1, 2, 1.0)]),
        ],
        text: "((2 - R11 - R22)*0.75 + R13^2/2 + R23^2*1.25)/h".into(),
        value: |f, h| {
            let turn = 0.75 * (2.0 - f[0][0] - f[1][1]);
            (turn + f[0][2].powi(2) / 2.0 + 1.25 * f[1][2].powi(2)) / h
        },
        slope: |f, h| {
            unit(
                3,
                &[
                    (0, 0, -0.75 / h),
                    (1, 1, -0.75 / h),
                    (0, 2, f[0][2] / h),
                    (1, 2, 2.5 * f[1][2] / h),
                ],
            )
        },
        start: vec![0.8, 0.7, -0.9],
    }
}

/// Screws: se(3) as it acts on itself, blocks `(R, 0; V, R)`, with a term that couples both.
pub fn screws(right: bool) -> Body {
    let axes = [turn(3, 1, 2), turn(3, 2, 0), turn(3, 0, 1)];
    let blocks = |places: &[(usize, usize)], block: &Matrix| {
        let mut whole = vec![vec![0.0; 6]; 6];
        for (down, across) in places {
            for i in 0..3 {
                for j in 0..3 {
                    whole[down + i][across + j] = block[i][j];
                }
            }
        }
        whole
    };
    let turns = axes.iter().map(|block| blocks(&[(0, 0), (3, 3)], block));
    let shifts = axes.iter().map(|block| blocks(&[(3, 0)], block));
    let squares = (4..7).flat_map(|i| (1..4).map(move |j| format!("R{i}{j}^2*{}", i + j)));
    Body {
        name: "Screws",
        right,
        basis: turns.chain(shifts).collect(),
        text: format!(
            "(0.5*(1 - R11) + 1.25*(1 - R22) + 0.75*(1 - R33) + ({})/16 + R41*(1 - R55)/4)/h",
            squares.collect::<Vec<String>>().join(" + ")
        ),
        value: |_, _| 0.0,
        slope: |f, h| {
            let mut slope = vec![vec![0.0; 6]; 6];
            for k in 0..3 {
                slope[k][k] = -MOMENTS[k] / h;
                for j in 0..3 {
                    slope[3 + k][j] = (k + j + 5) as f64 * f[3 + k][j] / (8.0 * h);
                }
            }
            slope[3][0] += (1.0 - f[4][4]) / (4.0 * h);
            slope[4][4] -= f[3][0] / (4.0 * h);
            slope
        },
        start: vec![1.0, 0.6, -1.2, 0.4, -0.3, 0.7],
    }
}

/// sl(2) and so(3) along the diagonal of five rows.
pub fn squeezed() -> Body {
    let mut basis = vec![
        unit(5, &[(0, 0, 1.0), (1, 1, -1.0)]),
        unit(5, &[(0, 1, 1.0)]),
        unit(5, &[(1, 0, 1.0)]),
    ];
    basis.extend([turn(5, 3, 4), turn(5, 4, 2), turn(5, 2, 3)]);
    Body {
        name: "Squeezed",
        right: false,
        basis,
        text: "((R11 - 1)^2 + R12^2 + R21^2*3 + R12*R34/4 + 3 - R33 - R44 - R55)/h".into(),
        value: |f, h| {
            let squares = (f[0][0] - 1.0).powi(2) + f[0][1].powi(2) + 3.0 * f[1][0].powi(2);
            (squares + f[0][1] * f[2][3] / 4.0 + 3.0 - f[2][2] - f[3][3] - f[4][4]) / h
        },
        slope: |f, h| {
            let one = 1.0 / h;
            unit(
                5,
                &[
                    (0, 0, 2.0 * (f[0][0] - 1.0) / h),
                    (0, 1, (2.0 * f[0][1] + f[2][3] / 4.0) / h),
                    (1, 0, 6.0 * f[1][0] / h),
                    (2, 2, -one),
                    (2, 3, f[0][1] / (4.0 * h)),
                    (3, 3, -one),
                    (4, 4, -one),
                ],
            )
        },
        start: vec![0.3, 0.2, -0.1, 0.4, 0.5, 0.6],
    }
}

/// The flow of `<mu', e> = +-<mu, [xi, e]>`, plus of a left-invariant system, by small steps of the classical method.
pub fn flow(body: &Body, right: bool, end: f64) -> Vec<f64> {
    let sign = if right { -1.0 } else { 1.0 };
    let rate = |m: &[f64]| -> Vec<f64> {
        let field = match body.name {
            // <m, [w, e]> = <m x w, e>
            "Turning" => {
                let [j1, j2, j3, ..] = MOMENTS;
                let w = [m[0] / (j2 + j3), m[1] / (j1 + j3), m[2] / (j1 + j2)];
                [
                    m[1] * w[2] - m[2] * w[1],
                    m[2] * w[0] - m[0] * w[2],
                    m[0] * w[1] - m[1] * w[0],
                ]
            }
            // [e1, e2] = e3, [e1, e3] = -e2
            _ => {
                let xi = [m[0] / 1.5, m[1], m[2] / 2.5];
                [xi[2] * m[1] - xi[1] * m[2], xi[0] * m[2], -xi[0] * m[1]]
            }
        };
        field.iter().map(|f| sign * f).collect()
    };
    let steps = 2000;
    let h = end / f64::from(steps);
    let along = |m: &[f64], k: &[f64], c: f64| -> Vec<f64> {
        m.iter().zip(k).map(|(m, k)| m + c * h * k).collect()
    };
    let mut m = body.start.clone();
    for _ in 0..steps {
        let a = rate(&m);
        let b = rate(&along(&m, &a, 0.5));
        let c = rate(&along(&m, &b, 0.5));
        let d = rate(&along(&m, &c, 1.0));
        for (i, m) in m.iter_mut().enumerate() {
            *m += h / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]);
        }
    }
    m
}
