//! The compiler from outside: what it derives, as numbers; what it says; what its code costs.

mod constructors;
mod derivation;
mod digits;
mod fused;
mod generating_size;
mod imports;
mod no_waste;
mod operation_counts;
mod properties;
mod random;
mod table_files;
mod vector_grammar;
mod verdicts;
