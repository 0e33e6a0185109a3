//! Every method of the catalogue is made by `new()`, at the defaults of its id.

use lie_codegen::methods::CATALOGUE;
use lie_runtime::methods::*;

fn id<M: Facts>(_: M) -> &'static str {
    M::ID
}

/// The ids of what `new()` makes of the first type of each id; compositions are made of another method,
/// `Compose4::new(ImplicitMidpoint::new())`.
macro_rules! ids {
    (
        {} choices $choices:tt
        $({ $title:literal $needs:tt $reference:tt
            [$($choice:tt)+] [$name:ident $(<$($argument:ident),+>)?] $value:tt { $($how:tt)* } $($others:tt)*
        })+
    ) => {
        [$(ids!(@new $name [$($how)*])),+]
    };
    (@new $name:ident [compose]) => {
        id($name::new(ImplicitMidpoint::new()))
    };
    (@new $name:ident $how:tt) => {
        id($name::new())
    };
}

#[test]
fn by_new() {
    let made = lie_core::for_each_method!(ids! {});
    let catalogue: Vec<&str> = CATALOGUE.iter().map(|row| row.id).collect();
    assert_eq!(made.as_slice(), catalogue);
}
