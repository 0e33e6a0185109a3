//! The work of a run in this program, without a compiler of Rust.

use lie_codegen::methods::Choice;
use lie_codegen::model::Model;
use lie_codegen::plan::plan;
use lie_dynamic::{Declared, Dynamic, method};
use lie_jit::Jit;
use lie_program::protocol::Tolerances;
use lie_program::{Program, protocol::End, session::Session};

use super::talk::Worker;

/// What runs a method on a system in this program; none where that has to be built.
pub fn here(model: &Model, choice: &Choice) -> Option<Worker> {
    let plan = plan(model, std::slice::from_ref(choice));
    let made = |tolerances: &Tolerances| {
        let (rtol, atol) = (tolerances.rtol, tolerances.atol);
        method(choice, lie_dynamic::Tolerances { rtol, atol })
    };
    if !Dynamic::supports(&plan) || made(&Tolerances::default()).is_none() {
        return None;
    }
    let parameters = model.parameters.iter();
    let parameters = parameters.map(|p| (p.name.clone(), p.default_value));
    let parameters: Vec<(String, f64)> = parameters.collect();
    let (choice, label) = (choice.clone(), choice.label());
    let work = move |line: &str, session: &mut Session<'_>| -> Result<(), End> {
        let declared = Declared::new(plan.clone(), &Jit);
        let parameters = parameters
            .iter()
            .map(|(name, value)| (name.as_str(), *value));
        let parameters: Vec<(&str, f64)> = parameters.collect();
        let program = Program::new(&parameters, move |values| declared.system(values));
        let choice = choice.clone();
        let make = move |tolerances: &Tolerances| {
            let (rtol, atol) = (tolerances.rtol, tolerances.atol);
            let made = method(&choice, lie_dynamic::Tolerances { rtol, atol });
            made.unwrap_or_else(|| {
                unreachable!("whether there is the method does not depend on tolerances")
            })
        };
        program.any_method(&label, make).run(line, session)
    };
    Some(Worker::Here(Box::new(work)))
}
