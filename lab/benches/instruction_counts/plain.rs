//! The heavy top written for f64 alone: no traits, no generics, arrays for vectors and matrices.

/// The constants, in the order of the generated ones: the compiler pairs what stands side by side.
#[repr(C)]
pub struct HeavyTop {
    /// Weight times the centre of mass.
    pub c1: f64,
    pub c2: f64,
    pub c3: f64,
    /// Inverse moments of inertia, halved (in the energy alone).
    pub half_a1: f64,
    pub half_a2: f64,
    pub half_a3: f64,
    /// Inverse moments of inertia.
    pub a1: f64,
    pub a2: f64,
    pub a3: f64,
    /// Their differences.
    pub a3_a2: f64,
    pub a1_a3: f64,
    pub a2_a1: f64,
    /// Negatives.
    pub minus_a2: f64,
    pub minus_a3: f64,
    pub minus_a1: f64,
    pub minus_c2: f64,
    pub minus_c3: f64,
    pub minus_c1: f64,
}

impl HeavyTop {
    pub fn new([i1, i2, i3]: [f64; 3], weight: f64, centre: [f64; 3]) -> Self {
        let [c1, c2, c3] = centre.map(|c| weight * c);
        let [a1, a2, a3] = [1.0 / i1, 1.0 / i2, 1.0 / i3];
        Self {
            c1,
            c2,
            c3,
            half_a1: 0.5 / i1,
            half_a2: 0.5 / i2,
            half_a3: 0.5 / i3,
            a1,
            a2,
            a3,
            a3_a2: a3 - a2,
            a1_a3: a1 - a3,
            a2_a1: a2 - a1,
            minus_a2: -a2,
            minus_a3: -a3,
            minus_a1: -a1,
            minus_c2: -c2,
            minus_c3: -c3,
            minus_c1: -c1,
        }
    }
}

#[inline(never)]
pub fn vector_field(of: &HeavyTop, mu: &[f64; 6], out: &mut [f64; 6]) {
    let [m1, m2, m3, g1, g2, g3] = *mu;
    let w2 = m2 * of.a2;
    let w3 = m3 * of.a3;
    let w1 = m1 * of.a1;
    out[0] = g2 * of.c3 - g3 * of.c2 + m3 * (m2 * of.a3_a2);
    out[1] = g3 * of.c1 - g1 * of.c3 + m3 * (m1 * of.a1_a3);
    out[2] = g1 * of.c2 - g2 * of.c1 + m2 * (m1 * of.a2_a1);
    out[3] = g2 * w3 - g3 * w2;
    out[4] = g3 * w1 - g1 * w3;
    out[5] = g1 * w2 - g2 * w1;
}

/// The field and its Jacobian, column after column.
#[inline(never)]
pub fn linearize(of: &HeavyTop, mu: &[f64; 6], field: &mut [f64; 6], jacobian: &mut [[f64; 6]; 6]) {
    let [m1, m2, m3, g1, g2, g3] = *mu;
    let d2 = m2 * of.a3_a2;
    let d1 = m1 * of.a1_a3;
    let e1 = m1 * of.a2_a1;
    let w2 = m2 * of.a2;
    let w3 = m3 * of.a3;
    let w1 = m1 * of.a1;
    field[0] = g2 * of.c3 - g3 * of.c2 + m3 * d2;
    field[1] = g3 * of.c1 - g1 * of.c3 + m3 * d1;
    field[2] = g1 * of.c2 - g2 * of.c1 + m2 * e1;
    field[3] = g2 * w3 - g3 * w2;
    field[4] = g3 * w1 - g1 * w3;
    field[5] = g1 * w2 - g2 * w1;
    *jacobian = [[0.0; 6]; 6];
    jacobian[1][0] = m3 * of.a3_a2;
    jacobian[2][0] = d2;
    jacobian[4][0] = of.c3;
    jacobian[5][0] = of.minus_c2;
    jacobian[0][1] = m3 * of.a1_a3;
    jacobian[2][1] = d1;
    jacobian[3][1] = of.minus_c3;
    jacobian[5][1] = of.c1;
    jacobian[0][2] = m2 * of.a2_a1;
    jacobian[1][2] = e1;
    jacobian[3][2] = of.c2;
    jacobian[4][2] = of.minus_c1;
    jacobian[1][3] = g3 * of.minus_a2;
    jacobian[2][3] = g2 * of.a3;
    jacobian[4][3] = w3;
    jacobian[5][3] = m2 * of.minus_a2;
    jacobian[0][4] = g3 * of.a1;
    jacobian[2][4] = g1 * of.minus_a3;
    jacobian[3][4] = m3 * of.minus_a3;
    jacobian[5][4] = w1;
    jacobian[0][5] = g2 * of.minus_a1;
    jacobian[1][5] = g1 * of.a2;
    jacobian[3][5] = w2;
    jacobian[4][5] = m1 * of.minus_a1;
}
