//! A spec that is not there.

use lie_runtime::prelude::*;

lie_poisson! { pub spec = "specs/no_such_file.json"; }

fn main() {}
