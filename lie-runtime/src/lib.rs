//! Runtime of lie-poisson.
#![cfg_attr(not(feature = "std"), no_std)]
