//! Systems of one declaration side by side, each in a lane.

use super::{has_equation, is_compiled_for_lanes};
use crate::compiled::Values;
use crate::system::Dynamic;
use crate::system::family::FamilySite;
use lie_codegen::methods::Choice;
use lie_runtime::Scalar;
use lie_runtime::family::Family;
use std::sync::Arc;

impl<S: Scalar> Dynamic<S> {
    /// Whether systems of this declaration can be side by side by a method of `lie_methods::method_in_lanes`.
    ///
    /// Where a velocity is followed along its branch they cannot: each becomes another system. By a method that is not compiled for
    /// lanes they can where its step is a program.
    pub fn takes_lanes(&self, choice: &Choice) -> bool {
        let traced = || has_equation(choice) && self.is_traced();
        !self.is_by_legendre()
            && (is_compiled_for_lanes(choice) || traced() || self.step_program(choice).is_some())
    }
}

impl Dynamic<f64> {
    /// Up to eight systems of one declaration as one system over lanes, with the parameters of each. The first fills the lanes
    /// that are left.
    ///
    /// Every lane gives the bits of its system alone.
    ///
    /// # Panics
    /// There is none, there are more than eight, they are of different declarations, families of different sizes, or they do not
    /// take lanes ([`Dynamic::takes_lanes`]).
    pub fn in_lanes(systems: &[&Self]) -> Dynamic<<f64 as Scalar>::Wide> {
        let first = systems[0];
        let one_declaration = systems.iter().all(|system| {
            Arc::ptr_eq(&system.values.compiled, &first.values.compiled)
                && system.sizes() == first.sizes()
        });
        assert!(systems.len() <= 8, "there are eight lanes");
        assert!(one_declaration, "the systems are of different declarations");
        assert!(!first.is_by_legendre(), "the system does not take lanes");
        let compiled = &first.values.compiled;
        let gather = |values: fn(&Self) -> &[f64]| -> Vec<<f64 as Scalar>::Wide> {
            let of_lane = |lane: usize| values(systems.get(lane).copied().unwrap_or(first));
            let lanes: [&[f64]; 8] = std::array::from_fn(of_lane);
            let entries = 0..lanes[0].len();
            entries
                .map(|entry| f64::gather(lanes.map(|values| values[entry])))
                .collect()
        };
        let values = Values {
            compiled: Arc::clone(compiled),
            machine: match first.values.machine.wide() {
                Some(machine) => machine,
                None => first.values.interpreter(),
            },
            parameters: gather(|system| &system.values.parameters),
            constants: gather(|system| &system.values.constants),
            // the same of all: declarations alone give them
            data: widened(&first.values.data),
            hurry: first.values.hurry,
        };
        let family = first.sizes();
        let family = family.map(|sizes| Family::new(FamilySite::new(values.clone()), sizes));
        Dynamic {
            values,
            branch: None,
            family,
            members: systems.iter().map(|system| (*system).clone()).collect(),
        }
    }
}

/// Values of sites, the same in every lane.
fn widened(data: &[Vec<f64>]) -> Arc<[Vec<<f64 as Scalar>::Wide>]> {
    let columns = data.iter();
    let columns = columns.map(|values| values.iter().map(|value| value.widen()).collect());
    columns.collect()
}
