//! Rational numbers out of their residues modulo several primes.

use num_bigint::BigInt;
use num_integer::Integer;

use super::kernel::Sparse;
use lie_symbolic::exact::Rational;

/// The residues as integers.
pub fn lifted(vectors: &[Sparse<u64>]) -> Vec<Sparse<BigInt>> {
    let lift = |vector: &Sparse<u64>| vector.iter().map(|(c, v)| (*c, BigInt::from(*v))).collect();
    vectors.iter().map(lift).collect()
}

/// Residues modulo a product from those modulo its factors; false where the vectors are no images of the same ones.
pub fn combine(
    residues: &mut [Sparse<BigInt>],
    modulus: &BigInt,
    vectors: &[Sparse<u64>],
    prime: u64,
) -> bool {
    let columns = |vector: &Sparse<BigInt>| vector.iter().map(|(c, _)| *c).collect::<Vec<_>>();
    let same = |(a, b): (&Sparse<BigInt>, &Sparse<u64>)| {
        columns(a).into_iter().eq(b.iter().map(|(c, _)| *c))
    };
    if residues.len() != vectors.len() || !residues.iter().zip(vectors).all(same) {
        return false;
    }
    let prime = BigInt::from(prime);
    let inverse = modulus.modpow(&(&prime - 2u8), &prime);
    for (vector, other) in residues.iter_mut().zip(vectors) {
        for ((_, value), (_, residue)) in vector.iter_mut().zip(other) {
            let step = (BigInt::from(*residue) - &*value) * &inverse % &prime;
            *value += modulus * step;
        }
    }
    true
}

/// The rational number `n/d` with `n, d <= sqrt(M/2)` whose residue modulo M is given, if there is one.
pub fn reconstructed(residue: &BigInt, modulus: &BigInt) -> Option<Rational> {
    let limit = (modulus / 2u8).sqrt();
    let (mut r0, mut r1) = (modulus.clone(), residue.mod_floor(modulus));
    let (mut t0, mut t1) = (BigInt::from(0), BigInt::from(1));
    while r1 > limit {
        let quotient = &r0 / &r1;
        let r2 = &r0 - &quotient * &r1;
        (r0, r1) = (r1, r2);
        let t2 = &t0 - &quotient * &t1;
        (t0, t1) = (t1, t2);
    }
    let small = t1.magnitude() <= limit.magnitude();
    small.then(|| Rational::from_big(r1, t1)).flatten()
}

#[cfg(test)]
mod tests {
    use super::super::field::{PRIMES, Prime};
    use super::*;
    use lie_symbolic::exact::Budget;

    #[test]
    fn rationals_come_back_from_their_residues() {
        let budget = Budget::new(1000);
        for prime in PRIMES {
            let field = Prime {
                prime,
                budget: &budget,
            };
            for (n, d) in [(0, 1), (-7, 3), (1_000_000_007, 999_999_937), (22, -7)] {
                let value = Rational::new(n, d).unwrap();
                let residue = BigInt::from(field.rational(&value).unwrap());
                assert_eq!(reconstructed(&residue, &BigInt::from(prime)), Some(value));
            }
            let seventh = field.rational(&Rational::new(1, 7).unwrap()).unwrap();
            assert_eq!(field.times(seventh, 7), 1);
        }
        // longer numbers than half of the modulus are none
        let long = Rational::new(1 << 40, 3).unwrap();
        let field = Prime {
            prime: PRIMES[0],
            budget: &budget,
        };
        let residue = BigInt::from(field.rational(&long).unwrap());
        assert_ne!(
            reconstructed(&residue, &BigInt::from(PRIMES[0])),
            Some(long)
        );
    }
}
