//! The `lie` command.
fn main() {}
