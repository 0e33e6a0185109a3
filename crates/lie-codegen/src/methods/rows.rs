//! The list of methods as rows: what a choice is in the runtime, and the generic equations that it has.

use std::any::TypeId;
use std::sync::LazyLock;

use lie_core::methods::{self as m, Facts};
use proc_macro2::TokenStream;
use quote::quote;

use super::{Choice, Gradient, Lift, Pieces, Retraction, Scheme, Tensor};

/// A method with its options: a type of the runtime, and its value.
pub struct Row {
    /// The method.
    pub choice: Choice,
    /// Its id, that of a composition without its base.
    pub id: &'static str,
    /// The type in the runtime, as Rust.
    pub(super) path: fn() -> TokenStream,
    /// The value, as Rust; of a method that chooses its steps by the `tolerances` in scope.
    pub(super) value: fn() -> TokenStream,
    of: TypeId,
    equations: Vec<Statement>,
}

/// Which systems have a generic equation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Carrier {
    /// Every system.
    Any,
    /// Those of a Lie algebra.
    Algebra,
    /// Those with a representation that is closed under (abc + cba)/2.
    Closed,
    /// Those with a retraction of their own.
    Retraction,
    /// Those with coordinates in which their bracket is constant, where it is not as it is.
    Canonical,
    /// Those with a representation that is closed up to matrices that commute with it.
    Matrices,
    /// Those with such a representation that is not closed.
    Reductive,
    /// Sums of so(3).
    Spins,
    /// The same, where the time and what is held may be beside it.
    Spheres,
    /// A rigid body in three dimensions.
    Body,
    /// A rigid body in more.
    BodyOfMany,
    /// Those by a Lagrangian.
    Lagrangian,
    /// The same with a closed representation.
    ClosedLagrangian,
    /// The same with a retraction of their own.
    RetractedLagrangian,
    /// Those by a Lagrangian that carry the group element or the time.
    LagrangianOnGroup,
    /// The same with a closed representation.
    ClosedLagrangianOnGroup,
    /// Those by a discrete Lagrangian.
    DiscreteLagrangian,
    /// The same with a closed representation.
    ClosedDiscreteLagrangian,
}

/// What the step of a method solves on systems of a kind.
#[derive(Clone, Debug)]
pub struct Statement {
    /// Its key in `generic_equations!`.
    pub key: &'static str,
    /// The systems.
    pub carrier: Carrier,
    form: Form,
}

#[derive(Clone, Debug)]
enum Form {
    /// An equation of its own.
    Own(GenericEquation),
    /// That of the method of a type.
    Same(TypeId),
}

/// A generic equation of the numeric core.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct GenericEquation {
    /// Its key in `generic_equations!`.
    pub key: &'static str,
    /// The name of its type.
    pub name: &'static str,
    /// The number of stages, where it is a parameter.
    pub stages: Option<usize>,
    /// The discrete gradient.
    pub gradient: Option<&'static str>,
    /// The generating function.
    pub function: Option<&'static str>,
}

impl Row {
    /// Every row, in the order of the catalogue, the defaults of an id first.
    pub fn all() -> &'static [Self] {
        static ROWS: LazyLock<Vec<Row>> = LazyLock::new(rows);
        &ROWS
    }

    /// The row of a choice; of splittings and compositions that of the defaults.
    pub fn find(choice: &Choice) -> &'static Self {
        let same = |row: &&Self| match (&row.choice, choice) {
            // the Cayley map has no order 6, which is for `refusal` to say
            (Choice::Generating(6, _), Choice::Generating(6, _)) => true,
            (Choice::Splitting(row, ..), Choice::Splitting(order, ..))
            | (Choice::Compose(row, ..), Choice::Compose(order, ..)) => row == order,
            (row, choice) => row == choice,
        };
        let found = Self::all().iter().find(same);
        found.unwrap_or_else(|| unreachable!("{choice:?} is not made of the list of methods"))
    }

    /// What its step solves on the systems for which a carrier is true.
    pub fn statement(&self, carries: impl Fn(Carrier) -> bool) -> Option<&Statement> {
        let mut equations = self.equations.iter();
        equations.find(|statement| carries(statement.carrier))
    }

    /// The choice whose generic equation its step solves on such systems, and the equation.
    pub fn equation(
        &'static self,
        carries: &impl Fn(Carrier) -> bool,
    ) -> Option<(&'static Choice, &'static GenericEquation)> {
        match &self.statement(carries)?.form {
            Form::Own(equation) => Some((&self.choice, equation)),
            Form::Same(other) => {
                let other = Self::all().iter().find(|row| row.of == *other)?;
                other.equation(carries)
            }
        }
    }
}

macro_rules! list {
    (
        {} choices $choices:tt
        $({ $title:literal $needs:tt $reference:tt
            $($choice:tt $type:tt $value:tt { $($particular:ident)? $([$($equation:tt)+])* })+
        })+
    ) => {
        fn rows() -> Vec<Row> {
            vec![$($(
                list!($choice $type $value [$($particular)?] vec![$(list!(@equation $($equation)+)),*]),
            )+)+]
        }
    };
    (
        [$($choice:tt)+] [$name:ident $(<$($argument:ident),+>)?] [$($value:tt)+] [$($particular:ident)?]
        $equations:expr
    ) => {
        Row {
            choice: Choice::$($choice)+,
            id: <m::$name $(<$(m::$argument),+>)? as Facts>::ID,
            of: TypeId::of::<m::$name $(<$(m::$argument),+>)?>(),
            path: || quote! {
                ::lie_runtime::methods::$name $(<$(::lie_runtime::methods::$argument),+>)?
            },
            value: || list!(@value $($particular)? $($value)+),
            equations: $equations,
        }
    };
    (@value tolerances $name:ident) => {
        quote! { <::lie_runtime::methods::$name as ::core::convert::From<_>>::from(*tolerances) }
    };
    (@value $particular:ident $name:ident $($rest:tt)*) => {
        list!(@value $name $($rest)*)
    };
    (@value $name:ident $(::$maker:ident($($given:ident),*))?) => {
        quote! { ::lie_runtime::methods::$name $(::$maker($(::lie_runtime::methods::$given),*))? }
    };
    (@equation $key:ident $carrier:ident same $name:ident $(<$($argument:ident),+>)?) => {
        Statement {
            key: stringify!($key),
            carrier: Carrier::$carrier,
            form: Form::Same(TypeId::of::<m::$name $(<$(m::$argument),+>)?>()),
        }
    };
    (
        @equation $key:ident $carrier:ident
        $name:ident $($stages:literal)? $(of $gradient:ident)? $(along $function:ident)?
    ) => {
        Statement {
            key: stringify!($key),
            carrier: Carrier::$carrier,
            form: Form::Own(GenericEquation {
                key: stringify!($key),
                name: stringify!($name),
                stages: None $(.or(Some($stages)))?,
                gradient: None $(.or(Some(stringify!($gradient))))?,
                function: None $(.or(Some(stringify!($function))))?,
            }),
        }
    };
}
lie_core::for_each_method!(list! {});

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;

    /// A second row of the same choice or key would never be found.
    #[test]
    fn each_row_is_found_by_its_choice_and_each_equation_by_its_key() {
        let mut keys = BTreeSet::new();
        for row in Row::all() {
            let found = Row::find(&row.choice);
            assert!(std::ptr::eq(found, row), "{:?}", row.choice);
            for statement in &row.equations {
                assert!(keys.insert(statement.key), "{} twice", statement.key);
            }
        }
        assert!(keys.len() > 30, "{keys:?}");
    }

    /// What options make of a method is a row with its id.
    #[test]
    fn each_variant_of_a_method_is_in_the_list() {
        let mut variants = 0;
        for row in Row::all() {
            for choice in row.choice.variants() {
                assert_eq!(Row::find(&choice).id, row.id, "{choice:?}");
                variants += 1;
            }
        }
        assert!(variants > 150, "{variants}");
    }
}
