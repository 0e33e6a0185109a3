//! The `lie_poisson!` macro: a shell over `lie-codegen`.
