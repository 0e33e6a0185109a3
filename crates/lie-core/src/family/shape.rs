//! How many numbers there are of a kind: known to generated code, or found at run time.

use core::array::from_fn;

/// So many things of one type.
pub trait Shape {
    /// That many things of a type.
    type Of<T>: AsRef<[T]> + AsMut<[T]>;

    /// One for each index below the count. A shape that knows its count is asked for no other.
    fn make<T>(count: usize, one: impl FnMut(usize) -> T) -> Self::Of<T>;
}

/// So many things of a type, as a shape says.
pub type Of<A, T> = <A as Shape>::Of<T>;

/// As many as the type says: an array.
#[derive(Clone, Copy, Debug)]
pub struct Fixed<const N: usize>;

impl<const N: usize> Shape for Fixed<N> {
    type Of<T> = [T; N];

    #[inline(always)]
    fn make<T>(count: usize, one: impl FnMut(usize) -> T) -> [T; N] {
        debug_assert_eq!(count, N, "the kernels of a site have one length");
        from_fn(one)
    }
}
