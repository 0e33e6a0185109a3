//! The verdicts against what Gauss steps do.

use super::{Closure, Form, closure};
use lie_symbolic::exact::{Budget, Rational};

type Matrix = Vec<Vec<i64>>;

fn budget() -> Budget {
    Budget::new(50_000_000)
}

/// Seeded small integers (xorshift64*).
struct Random(u64);

impl Random {
    fn integer(&mut self, most: i64) -> i64 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        let bits = self.0.wrapping_mul(0x2545_f491_4f6c_dd1d) >> 33;
        bits as i64 % (2 * most + 1) - most
    }
}

fn rotation(k: usize) -> Matrix {
    let (a, b) = ((k + 1) % 3, (k + 2) % 3);
    let mut matrix = vec![vec![0; 3]; 3];
    (matrix[b][a], matrix[a][b]) = (1, -1);
    matrix
}

/// Twice the spin representation: multiplication of quaternions by a unit, from the left.
fn spinor(k: usize) -> Matrix {
    let [i, j, k_] = [
        [[0, -1, 0, 0], [1, 0, 0, 0], [0, 0, 0, -1], [0, 0, 1, 0]],
        [[0, 0, -1, 0], [0, 0, 0, 1], [1, 0, 0, 0], [0, -1, 0, 0]],
        [[0, 0, 0, -1], [0, 0, -1, 0], [0, 1, 0, 0], [1, 0, 0, 0]],
    ];
    [i, j, k_][k].iter().map(|row| row.to_vec()).collect()
}

/// The action on symmetric matrices, `X -> R X + X R^T`: spin two and spin zero.
fn symmetric(k: usize) -> Matrix {
    let pairs = [(0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2)];
    let r = rotation(k);
    let place = |a: usize, b: usize| {
        let pair = (a.min(b), a.max(b));
        pairs.iter().position(|&p| p == pair).expect("a pair")
    };
    let mut matrix = vec![vec![0; 6]; 6];
    for (row, &(a, b)) in pairs.iter().enumerate() {
        for c in 0..3 {
            matrix[row][place(c, b)] += r[a][c];
            matrix[row][place(a, c)] += r[b][c];
        }
    }
    matrix
}

fn sum(a: &Matrix, b: &Matrix) -> Matrix {
    let (n, m) = (a.len(), b.len());
    let mut matrix = vec![vec![0; n + m]; n + m];
    for (r, row) in a.iter().enumerate() {
        matrix[r][..n].copy_from_slice(row);
    }
    for (r, row) in b.iter().enumerate() {
        matrix[n + r][n..].copy_from_slice(row);
    }
    matrix
}

/// `J = -p rho q` as twice a form in (1, q, p).
fn form(rho: &Matrix, scale: &Rational) -> Form {
    let n = rho.len();
    let mut form = vec![vec![Rational::ZERO; 2 * n + 1]; 2 * n + 1];
    for (r, row) in rho.iter().enumerate() {
        for (c, &value) in row.iter().enumerate() {
            let value = -&(&Rational::from(value) * scale);
            form[1 + n + r][1 + c] = value.clone();
            form[1 + c][1 + n + r] = value;
        }
    }
    form
}

/// Random affine canonical coordinates: `(1, z) -> (1, M z + d)` with M symplectic.
fn canonical(n: usize, random: &mut Random) -> Form {
    let size = 2 * n + 1;
    let unit = || -> Vec<Vec<i64>> {
        let row = |r| (0..size).map(|c| i64::from(r == c)).collect();
        (0..size).map(row).collect()
    };
    let mut product = unit();
    for shear in 0..3 {
        let mut factor = unit();
        for a in 0..n {
            for b in 0..=a {
                let value = random.integer(1);
                let mut set = |r: usize, c: usize, v| factor[1 + r][1 + c] += v;
                match shear {
                    0 => {
                        set(a, n + b, value);
                        if a != b {
                            set(b, n + a, value);
                        }
                    }
                    1 => {
                        set(n + a, b, value);
                        if a != b {
                            set(n + b, a, value);
                        }
                    }
                    // one entry of a triangular matrix, and of its inverse transposed
                    _ if b + 1 == a && a % 2 == 1 => {
                        set(a, b, value);
                        set(n + b, n + a, -value);
                    }
                    _ => {}
                }
            }
        }
        product = times(&product, &factor);
    }
    for row in product.iter_mut().skip(1) {
        row[0] = random.integer(2);
    }
    let exact = |row: &Vec<i64>| row.iter().map(|&v| Rational::from(v)).collect();
    product.iter().map(exact).collect()
}

fn times(a: &Matrix, b: &Matrix) -> Matrix {
    let entry = |row: &Vec<i64>, c: usize| row.iter().zip(b).map(|(x, y)| x * y[c]).sum();
    let row = |row: &Vec<i64>| (0..b.len()).map(|c| entry(row, c)).collect();
    a.iter().map(row).collect()
}

/// `M^T F M`
fn pulled_back(form: &Form, by: &Form) -> Form {
    let size = form.len();
    let mut out = vec![vec![Rational::ZERO; size]; size];
    for (i, row) in form.iter().enumerate() {
        for (j, value) in row.iter().enumerate().filter(|(_, v)| !v.is_zero()) {
            for (a, out) in out.iter_mut().enumerate() {
                let left = value * &by[i][a];
                for (b, out) in out.iter_mut().enumerate().filter(|_| !left.is_zero()) {
                    *out = &*out + &(&left * &by[j][b]);
                }
            }
        }
    }
    out
}

/// The functions in double precision, and the midpoint rule for `x^2/2 + y^2/3 + z^2/5 + x y z/2` of them.
struct Over(Vec<Vec<Vec<f64>>>);

impl Over {
    fn slope(&self, k: usize, z: &[f64]) -> Vec<f64> {
        let row = |row: &Vec<f64>| {
            let inner = row[1..].iter().zip(z).map(|(a, b)| a * b);
            row[0] + inner.sum::<f64>()
        };
        self.0[k][1..].iter().map(row).collect()
    }

    fn momenta(&self, z: &[f64]) -> [f64; 3] {
        [0, 1, 2].map(|k| {
            let form = &self.0[k];
            let twice = self.slope(k, z);
            let linear: f64 = form[0][1..].iter().zip(z).map(|(a, b)| a * b).sum();
            let inner: f64 = twice.iter().zip(z).map(|(a, b)| a * b).sum();
            0.5 * (form[0][0] + linear + inner)
        })
    }

    fn field(&self, z: &[f64]) -> Vec<f64> {
        let [x, y, w] = self.momenta(z);
        let xi = [
            x + y * w / 2.0,
            2.0 * y / 3.0 + x * w / 2.0,
            2.0 * w / 5.0 + x * y / 2.0,
        ];
        let half = z.len() / 2;
        let mut out = vec![0.0; z.len()];
        for (k, xi) in xi.iter().enumerate() {
            let slope = self.slope(k, z);
            for i in 0..half {
                out[i] += xi * slope[half + i];
                out[half + i] -= xi * slope[i];
            }
        }
        out
    }

    /// The largest relative change of the Casimir in some steps.
    fn casimir_drift(&self, start: &[f64]) -> f64 {
        let casimir = |z: &[f64]| self.momenta(z).iter().map(|m| m * m).sum::<f64>();
        let mut z = start.to_vec();
        let size = self
            .momenta(&z)
            .iter()
            .fold(0.0, |m: f64, x| m.max(x.abs()));
        let h = 0.2 / size.max(1.0).powi(2);
        let mut worst = 0.0_f64;
        for _ in 0..10 {
            let mut middle = z.clone();
            for _ in 0..200 {
                let field = self.field(&middle);
                middle = z.iter().zip(&field).map(|(z, f)| z + 0.5 * h * f).collect();
            }
            z = z.iter().zip(&middle).map(|(z, m)| 2.0 * m - z).collect();
            worst = worst.max((casimir(&z) / casimir(start) - 1.0).abs());
        }
        worst
    }
}

#[test]
fn the_verdict_is_what_gauss_steps_show() {
    let half = &Rational::ONE / &Rational::from(2);
    let one = Rational::ONE;
    let zero = |_| vec![vec![0; 2]; 2];
    type Made = Box<dyn Fn(usize) -> Matrix>;
    let cases: Vec<(&str, Made, &Rational, bool)> = vec![
        ("1", Box::new(rotation), &one, true),
        ("1/2", Box::new(spinor), &half, true),
        (
            "1 + 0",
            Box::new(move |k| sum(&rotation(k), &zero(k))),
            &one,
            true,
        ),
        (
            "1 + 1",
            Box::new(|k| sum(&rotation(k), &rotation(k))),
            &one,
            true,
        ),
        ("2 + 0", Box::new(symmetric), &one, false),
        // the matrices of spin 1 have to be doubled to be those of twice the spinors
        (
            "1 + 1/2",
            Box::new(|k| {
                let mut doubled = rotation(k);
                doubled.iter_mut().flatten().for_each(|entry| *entry *= 2);
                sum(&doubled, &spinor(k))
            }),
            &half,
            false,
        ),
    ];
    let mut random = Random(2018);
    for (name, rho, scale, closed) in cases {
        for _ in 0..4 {
            let n = rho(0).len();
            let coordinates = canonical(n, &mut random);
            let forms: Vec<Form> = (0..3)
                .map(|k| pulled_back(&form(&rho(k), scale), &coordinates))
                .collect();
            let verdict = closure(&forms, &budget()).expect("little work");
            let expected = if closed {
                Closure::Nothing
            } else {
                Closure::Others
            };
            assert_eq!(verdict, expected, "spin {name}");
            let number = |row: &Vec<Rational>| row.iter().map(Rational::to_f64).collect();
            let over = Over(
                forms
                    .iter()
                    .map(|f| f.iter().map(number).collect())
                    .collect(),
            );
            let start: Vec<f64> = (0..2 * n).map(|i| (1.7 * i as f64 + 0.4).sin()).collect();
            let drift = over.casimir_drift(&start);
            assert!(
                if closed { drift < 1e-11 } else { drift > 1e-7 },
                "spin {name}: {drift:e}"
            );
        }
    }
}

/// sl(3) on T*R^3: the closure adds the unit matrix, whose form is `-p q`.
#[test]
fn what_commutes_is_told_from_what_does_not() {
    let mut forms = Vec::new();
    let one = Rational::ONE;
    for r in 0..3 {
        for c in 0..3 {
            let mut matrix = vec![vec![0; 3]; 3];
            matrix[r][c] = 1;
            if r == c {
                matrix[(r + 1) % 3][(r + 1) % 3] = -1;
            }
            if (r, c) != (2, 2) {
                forms.push(form(&matrix, &one));
            }
        }
    }
    let verdict = closure(&forms, &budget()).expect("little work");
    assert_eq!(verdict, Closure::Commuting);
    // with the unit matrix nothing is missing, and dependent functions add nothing
    forms.push(form(
        &vec![vec![1, 0, 0], vec![0, 1, 0], vec![0, 0, 1]],
        &one,
    ));
    forms.push(forms[0].clone());
    let verdict = closure(&forms, &budget()).expect("little work");
    assert_eq!(verdict, Closure::Nothing);
}

/// Linear functions, whose brackets are constants: the Heisenberg algebra over T*R.
#[test]
fn constants_are_known() {
    let linear = |values: [i64; 3]| -> Form {
        let mut form = vec![vec![Rational::ZERO; 3]; 3];
        for (k, value) in values.into_iter().enumerate() {
            form[0][k] = Rational::from(value);
            form[k][0] = Rational::from(value);
        }
        form
    };
    for forms in [
        vec![linear([0, 1, 0]), linear([0, 0, 1]), linear([2, 0, 0])],
        vec![linear([3, 1, 0]), linear([0, 2, 1])],
    ] {
        let verdict = closure(&forms, &budget()).expect("little work");
        assert_eq!(verdict, Closure::Nothing);
    }
}
