//! Euler angles of a rotation.
//!
//! ```math
//! g = R_a(\varphi)\, R_b(\vartheta)\, R_c(\psi)
//! ```
//!
//! `R_a` turns about the axis a, counterclockwise seen from its tip, and g takes body axes to those of space: the body is
//! turned about its own axis a, then about its axis b where that is now, then about c. Such sequences are called intrinsic.
//! Angles are found from the quaternion of g by the formula of E. Bernardes, S. Viollet, "Quaternion to Euler angles
//! conversion: A direct, general and computationally efficient method", PLoS ONE 17 (2022) e0276302,
//! [doi:10.1371/journal.pone.0276302](https://doi.org/10.1371/journal.pone.0276302).

use core::str::FromStr;

use crate::scalar::{Scalar, nearest_branch};

/// Half angles within so many units of round-off of a lock are in it: their quaternion does not tell two of the angles apart.
const LOCKED: f64 = 16.0;

/// Declares the sequences: name in Rust, axes.
macro_rules! sequences {
    ($($variant:ident $name:literal [$a:literal, $b:literal, $c:literal];)*) => {
        /// The axes about which Euler angles turn, in their order: `g = R_a(phi) R_b(theta) R_c(psi)`, see the
        /// [module's text](self).
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum EulerSequence {
            $(
                #[doc = concat!("The sequence `", $name, "`.")]
                $variant,
            )*
        }

        impl EulerSequence {
            /// All sequences.
            pub const ALL: [Self; 12] = [$(Self::$variant),*];

            /// The axes, 0 for x.
            pub const fn axes(self) -> [usize; 3] {
                match self {
                    $(Self::$variant => [$a, $b, $c],)*
                }
            }

            /// The letters of the axes.
            pub const fn name(self) -> &'static str {
                match self {
                    $(Self::$variant => $name,)*
                }
            }
        }
    };
}

sequences! {
    Xyx "xyx" [0, 1, 0];
    Xyz "xyz" [0, 1, 2];
    Xzx "xzx" [0, 2, 0];
    Xzy "xzy" [0, 2, 1];
    Yxy "yxy" [1, 0, 1];
    Yxz "yxz" [1, 0, 2];
    Yzx "yzx" [1, 2, 0];
    Yzy "yzy" [1, 2, 1];
    Zxy "zxy" [2, 0, 1];
    Zxz "zxz" [2, 0, 2];
    Zyx "zyx" [2, 1, 0];
    Zyz "zyz" [2, 1, 2];
}

/// Some letters that are no sequence.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("a sequence of Euler angles has three of the letters x, y, z, neighbours different")]
pub struct NoSequence;

impl FromStr for EulerSequence {
    type Err = NoSequence;

    fn from_str(text: &str) -> Result<Self, NoSequence> {
        let mut all = Self::ALL.into_iter();
        all.find(|sequence| sequence.name() == text)
            .ok_or(NoSequence)
    }
}

/// A rotation by the angles of a sequence whose last axis is the first: `(phi + psi)/2`, `(phi - psi)/2`, `theta`.
#[derive(Clone, Copy)]
struct Halves<S: Scalar> {
    sum: S,
    difference: S,
    tilt: S,
    /// Where `theta` is 0: the difference is not determined.
    level: S::Mask,
    /// Where `theta` is pi: the sum is not determined.
    inverted: S::Mask,
}

impl<S: Scalar> Halves<S> {
    fn angles(self) -> [S; 3] {
        let (sum, difference) = (self.sum, self.difference);
        [sum + difference, self.tilt, sum - difference]
    }
}

impl EulerSequence {
    /// Whether the last axis is the first one. The middle angle is then in [0, pi], else in [-pi/2, pi/2].
    pub const fn is_proper(self) -> bool {
        let [a, _, c] = self.axes();
        a == c
    }

    /// The unit quaternion of angles in radians, the real part first.
    pub fn quaternion<S: Scalar>(self, angles: [S; 3]) -> [S; 4] {
        let zero = S::zero();
        let mut q = [S::one(), zero, zero, zero];
        for (axis, angle) in self.axes().into_iter().zip(angles) {
            let (sine, cosine) = (angle * S::ratio(1.0, 2.0)).sin_cos();
            // q (cosine + sine e_k), e_i e_k = -e_j, e_j e_k = e_i
            let [k, i, j] = [axis, (axis + 1) % 3, (axis + 2) % 3].map(|axis| axis + 1);
            let mut turned = q.map(|entry| cosine * entry);
            turned[0] -= sine * q[k];
            turned[k] += sine * q[0];
            turned[i] += sine * q[j];
            turned[j] -= sine * q[i];
            q = turned;
        }
        q
    }

    /// The angles of a quaternion of any length: phi and psi in [-pi, pi]. In a gimbal lock, where the middle angle is at an end
    /// of its range, psi is 0.
    pub fn angles<S: Scalar>(self, quaternion: [S; 4]) -> [S; 3] {
        let mut halves = self.halves(quaternion);
        halves.difference = S::select(halves.level, halves.sum, halves.difference);
        halves.sum = S::select(halves.inverted, halves.difference, halves.sum);
        let [first, tilt, last] = halves.angles();
        let [first, last] = [first, last].map(|angle| nearest_branch(angle, S::zero()));
        self.outward([first, tilt, last])
    }

    /// Of all angles of a quaternion those that are nearest to others: from one quaternion to the next along a motion they are
    /// continuous, through a gimbal lock too, and the middle angle then leaves its range. In a lock the combination of
    /// phi and psi that is not determined stays.
    pub fn angles_near<S: Scalar>(self, quaternion: [S; 4], others: [S; 3]) -> [S; 3] {
        let near = self.inward(others);
        let half = S::ratio(1.0, 2.0);
        let mut halves = self.halves(quaternion);
        let difference = (near[0] - near[2]) * half;
        let sum = (near[0] + near[2]) * half;
        halves.difference = S::select(halves.level, difference, halves.difference);
        halves.sum = S::select(halves.inverted, sum, halves.sum);
        let pi = S::constant(core::f64::consts::PI, 1.224_646_799_147_353_2e-16);
        let [first, tilt, last] = halves.angles();
        let [one, other] = [[first, tilt, last], [first + pi, -tilt, last + pi]].map(|angles| {
            let branch: [S; 3] = core::array::from_fn(|k| nearest_branch(angles[k], near[k]));
            let steps = branch.iter().zip(near);
            let distance = steps.fold(S::zero(), |sum, (&angle, near)| {
                sum + (angle - near) * (angle - near)
            });
            (branch, distance)
        });
        let closer = other.1.less(one.1);
        self.outward(core::array::from_fn(|k| {
            S::select(closer, other.0[k], one.0[k])
        }))
    }

    /// 1 where the three axes, the third one being that which the first two leave, are a right-handed frame, else -1.
    fn sign(self) -> f64 {
        let [a, b, _] = self.axes();
        if (a + 1) % 3 == b { 1.0 } else { -1.0 }
    }

    /// Angles of a sequence whose last axis is the first, of `g R_b(pi/2)` where this one has three axes: `R_c(psi) R_b(pi/2)` is
    /// `R_b(pi/2) R_a(-sign psi)`.
    fn inward<S: Scalar>(self, [first, middle, last]: [S; 3]) -> [S; 3] {
        match self.is_proper() {
            true => [first, middle, last],
            false => [
                first,
                middle + quarter_turn::<S>(),
                last * S::from_f64(-self.sign()),
            ],
        }
    }

    /// The angles of which these are the inward ones.
    fn outward<S: Scalar>(self, [first, middle, last]: [S; 3]) -> [S; 3] {
        match self.is_proper() {
            true => [first, middle, last],
            false => [
                first,
                middle - quarter_turn::<S>(),
                last * S::from_f64(-self.sign()),
            ],
        }
    }

    fn halves<S: Scalar>(self, q: [S; 4]) -> Halves<S> {
        let [a, b, _] = self.axes();
        let [real, x, y, z] = [q[0], q[1 + a], q[1 + b], q[1 + (3 - a - b)]];
        let z = z * S::from_f64(self.sign());
        let [real, x, y, z] = match self.is_proper() {
            true => [real, x, y, z],
            // times 1 + e_b
            false => [real - y, x - z, y + real, z + x],
        };
        let upright = real * real + x * x;
        let tilted = y * y + z * z;
        let locked = S::epsilon() * S::from_f64(LOCKED);
        let locked = locked * locked * (upright + tilted);
        Halves {
            sum: x.atan2(real),
            difference: z.atan2(y),
            tilt: S::from_f64(2.0) * tilted.sqrt().atan2(upright.sqrt()),
            level: tilted.less_equal(locked),
            inverted: upright.less_equal(locked),
        }
    }
}

fn quarter_turn<S: Scalar>() -> S {
    S::constant(core::f64::consts::FRAC_PI_2, 6.123_233_995_736_766e-17)
}

#[cfg(test)]
mod tests;
