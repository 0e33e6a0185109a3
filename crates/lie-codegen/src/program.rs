//! The programs that the command builds: the system and one entry per method.

pub use lie_core::structure::Chart;
use proc_macro2::{Ident, Span, TokenStream};
use quote::{format_ident, quote};

use crate::compile::generate;
use crate::methods::{Choice, Lift, Scheme, Tensor};
use crate::print::format;
use crate::structure::Structure;
use lie_core::methods::{Keep, Tolerances};

/// What a program is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Purpose {
    /// `lie run`: one trajectory.
    Run,
    /// `lie run --group`: one trajectory with the group element.
    OnGroup(Chart),
    /// `lie verify`: everything that the methods claim, also over dual numbers.
    Verify,
    /// `lie bench`: errors and times.
    Bench,
    /// `lie stress`: the limits of each method.
    Stress,
}

/// The names of the columns of the group element.
pub fn columns(chart: Chart, size: usize) -> Vec<String> {
    match chart {
        Chart::Matrix => crate::model::configuration::entries_of("g", size),
        Chart::Quaternion => (0..4).map(|k| format!("q{k}")).collect(),
        Chart::Euler(_) => ["phi", "theta", "psi"].map(str::to_owned).into(),
    }
}

/// A chart as a path in generated code.
fn path(chart: Chart) -> TokenStream {
    let name = match chart {
        Chart::Matrix => quote! { Matrix },
        Chart::Quaternion => quote! { Quaternion },
        Chart::Euler(sequence) => {
            let name = format_ident!("{sequence:?}");
            quote! { Euler(::lie_runtime::driver::EulerSequence::#name) }
        }
    };
    quote! { ::lie_runtime::driver::Chart::#name }
}

/// The method that confirms the reference solution of `lie bench`: one that needs no matrix for a family.
pub fn confirming(model: &Structure) -> Choice {
    match model.family {
        Some(_) => Choice::Gauss(8),
        None => Choice::Gauss(3),
    }
}

/// The text of a program for these methods. The entries bear the labels of the choices.
///
/// Programs for [`Purpose::Bench`] contain the modules `clock` and `controls`, which the build adds.
pub fn program(structure: &Structure, choices: &[Choice], purpose: Purpose) -> String {
    let system = generate(structure, choices);
    let name = Ident::new(&structure.name, Span::call_site());
    let entries = choices.iter().map(|choice| entry(choice, purpose));
    let dimension = structure.dimension();
    let count = structure.parameters.len();
    let defaults = structure.parameters.iter().map(|parameter| {
        let (name, value) = (&parameter.name, parameter.default_value);
        quote! { (#name, #value) }
    });
    let (kind, modules, end) = match purpose {
        Purpose::Run | Purpose::OnGroup(_) => (quote! { lie_program::Program }, None, None),
        Purpose::Verify => {
            let plain = plain(structure, choices);
            let (module, entries) = plain.map_or((None, None), |(m, e)| (Some(m), Some(e)));
            let (evidence, beside) = (evidence(structure), beside(choices));
            (
                quote! { lie_measure::Verify },
                module,
                Some(quote! { #entries #evidence #(.beside(#beside))* }),
            )
        }
        Purpose::Bench => (
            quote! { lie_measure::Bench },
            Some(quote! { mod clock; mod controls; }),
            Some(quote! { .controls(controls::all::<_, #dimension>()).clock(clock::processor) }),
        ),
        Purpose::Stress => (quote! { lie_measure::Stress }, None, None),
    };
    let confirming = (purpose == Purpose::Bench).then(|| {
        let method = confirming(structure).constructor();
        quote! { , #method }
    });
    let main = quote! {
        #[allow(dead_code)]
        mod system { #system }
        #modules

        fn main() -> ::std::process::ExitCode {
            ::#kind::new(&[#(#defaults),*], |values: &[f64]| {
                let values: &[f64; #count] = values.try_into().unwrap_or(&[f64::NAN; #count]);
                system::#name::from_values(values).system()
            } #confirming)
            #(#entries)*
            #end
            .main()
        }
    };
    format(main)
}

/// What a program integrates.
#[derive(Clone, Copy, Debug)]
pub struct Numbers<'n> {
    /// The values of the parameters, in order.
    pub parameters: &'n [f64],
    /// The initial state.
    pub initial: &'n [f64],
    /// Start and end.
    pub span: (f64, f64),
    /// The step, or the tolerance.
    pub pace: f64,
    /// Whether it is a tolerance.
    pub by_tolerance: bool,
    /// Those of a method that chooses its own steps.
    pub tolerances: Tolerances,
    /// What a projection behind each step keeps.
    pub keep: Keep,
    /// Whether steps follow the motion by a reversible density.
    pub reversible: bool,
}

/// The text of a program that integrates the system of its module `system` by a method and writes the rows as CSV: for people
/// to go on from.
pub fn integrates(structure: &Structure, choice: &Choice, numbers: &Numbers<'_>) -> String {
    let Numbers {
        parameters,
        initial,
        span: (start, end),
        pace,
        by_tolerance,
        tolerances,
        keep: Keep { energy, casimirs },
        reversible,
    } = *numbers;
    let name = &structure.name;
    let title = choice.title();
    let method = choice.at_defaults().to_string();
    let close = [
        (" :: ", "::"),
        (":: ", "::"),
        (" ::<", "::<"),
        ("< ", "<"),
        (" >", ">"),
        (" (", "("),
    ];
    let method = close
        .iter()
        .fold(method, |text, (loose, close)| text.replace(loose, close));
    let method = method.replace("::lie_runtime::methods::", "");
    let method = method.replace(" as::", " as ::");
    let own_steps = match choice {
        _ if tolerances == Tolerances::default() => None,
        Choice::Dopri5 => Some("Dopri5"),
        Choice::Taylor => Some("Taylor"),
        Choice::LieTaylor => Some("LieTaylor"),
        _ => None,
    };
    let Tolerances { rtol, atol } = tolerances;
    let method = own_steps.map_or(method, |name| {
        format!("{name}::from(Tolerances {{ rtol: {rtol:?}, atol: {atol:?} }})")
    });
    let paced = if by_tolerance { "tolerance" } else { "new" };
    let kept = match energy || casimirs {
        true => format!(".keep(Keep {{ energy: {energy}, casimirs: {casimirs} }})"),
        false => String::new(),
    };
    let density = if reversible { ".reversible()" } else { "" };
    format!(
        "//! {name}, {title}: writes rows of t, state and invariants as CSV.

use std::error::Error;

use lie_runtime::driver::{{Options, Problem, solve}};
use lie_runtime::methods::*;

#[allow(dead_code)]
mod system;

/// In the order of the declaration.
const PARAMETERS: [f64; {parameter_count}] = {parameters:?};
const START: [f64; {dimension}] = {initial:?};
const SPAN: (f64, f64) = ({start:?}, {end:?});

fn main() -> Result<(), Box<dyn Error>> {{
    let system = system::{name}::from_values(&PARAMETERS).system()?;
    let problem = Problem::new(system, START, SPAN);
    let solution = solve(&problem, {method}, &Options::{paced}({pace:?}){kept}{density})?;
    solution.write_csv(std::io::stdout().lock())?;
    Ok(())
}}
",
        parameter_count = parameters.len(),
        dimension = initial.len(),
    )
}

/// The same system without fused equations, and the methods that are compared on it: those that are fused, once each.
fn plain(structure: &Structure, choices: &[Choice]) -> Option<(TokenStream, TokenStream)> {
    let fused = compared(structure, choices);
    if fused.is_empty() {
        return None;
    }
    let system = generate(structure, &[]);
    let name = Ident::new(&structure.name, Span::call_site());
    let system_name = format_ident!("{}System", structure.name);
    let count = structure.parameters.len();
    let entries = fused.iter().map(|choice| {
        let (label, constructor) = (choice.label(), choice.constructor());
        quote! { .plain(#label, plain_system, |_| #constructor) }
    });
    let module = quote! {
        #[allow(dead_code)]
        mod plain { #system }

        fn plain_system(
            values: &[f64],
        ) -> ::core::result::Result<plain::#system_name, ::lie_runtime::ParameterError> {
            let values: &[f64; #count] = values.try_into().unwrap_or(&[f64::NAN; #count]);
            plain::#name::from_values(values).system()
        }
    };
    let entries = quote! { #(#entries)* };
    Some((module, entries))
}

/// The methods whose steps are compared with those of their generic equations.
pub fn compared<'a>(structure: &Structure, choices: &'a [Choice]) -> Vec<&'a Choice> {
    if structure.energy.expression().is_none() || structure.family.is_some() {
        return Vec::new();
    }
    // on a bracket by entries the flows of pieces are those that were found, and there are no others
    let alone =
        |choice: &Choice| !structure.is_lie_poisson() && matches!(choice, Choice::Splitting(..));
    let compared = choices
        .iter()
        .filter(|choice| is_fused(choice) && !alone(choice));
    compared.collect()
}

/// Whether the steps of a method are compared: those with fused code of their own, one number of stages of each. Generic
/// generating functions differentiate several times over, which takes long to build.
fn is_fused(choice: &Choice) -> bool {
    match choice {
        Choice::Midpoint
        | Choice::LieMidpoint(_)
        | Choice::MoserVeselov
        | Choice::GeneratingSecondKind2
        | Choice::SphericalMidpoint
        | Choice::Splitting(2, Scheme::Strang, _)
        | Choice::DiscreteGradient(_, Tensor::Midpoint)
        | Choice::OrbitEnergy(_) => true,
        Choice::Gauss(stages) => *stages == 2,
        Choice::CohenHairer(order) | Choice::Isospectral(order) => *order == 4,
        Choice::Collective(order, lift) => *lift == Lift::Hopf && *order == 2,
        _ => false,
    }
}

/// What a judge may look at beyond the kernels of every system.
fn evidence(structure: &Structure) -> TokenStream {
    let lie = structure.is_lie_poisson();
    let lagrangian = structure.energy.reduced();
    let mut calls = TokenStream::new();
    let mut add = |wanted: bool, call: TokenStream| {
        if wanted {
            calls.extend(call);
        }
    };
    add(lie, quote! { .with_orbits() });
    if structure.family.is_some() {
        // what else is known is known of a site
        return calls;
    }
    add(structure.group.is_some(), quote! { .with_group() });
    add(
        lie && structure.bracket.triple().is_some(),
        quote! { .with_cayley() },
    );
    add(lagrangian.is_some(), quote! { .with_lagrangian() });
    add(
        lagrangian.is_some_and(|l| l.discrete.is_some()),
        quote! { .with_discrete() },
    );
    add(
        structure.realization.is_some(),
        quote! { .with_realization() },
    );
    calls
}

/// The methods whose group element only goes along with their steps, to their order: what those over a declared realization act on
/// are its points, and from order 8 on those over spinors and quaternions are Gauss methods there, while the element is one of the
/// same velocities in the declared matrices.
pub fn beside(choices: &[Choice]) -> impl Iterator<Item = String> {
    let elsewhere = |choice: &&Choice| match choice.solved() {
        Choice::Collective(_, Lift::Spec) => true,
        Choice::Collective(order, lift) => *order > 6 && *lift != Lift::Representation,
        _ => false,
    };
    choices.iter().filter(elsewhere).map(Choice::label)
}

fn entry(choice: &Choice, purpose: Purpose) -> TokenStream {
    let label = choice.label();
    let series = matches!(choice, Choice::Taylor | Choice::LieTaylor);
    // at their default tolerance series are exact on every grid, which is what they claim
    let fixed = series && matches!(purpose, Purpose::Verify);
    let constructor = match fixed {
        true => choice.at_defaults(),
        false => choice.constructor(),
    };
    let adaptive = choice.is_adaptive() && !fixed;
    let argument = if adaptive {
        quote! { tolerances }
    } else {
        quote! { _ }
    };
    if let Purpose::OnGroup(chart) = purpose {
        let chart = path(chart);
        return quote! {
            .on_group(#label, #chart, |#argument| #constructor)
        };
    }
    let function = match purpose {
        Purpose::Verify if choice.is_composed() => format_ident!("composed"),
        Purpose::Run => format_ident!("method"),
        _ if adaptive => format_ident!("adaptive"),
        _ => format_ident!("method"),
    };
    quote! { .#function(#label, |#argument| #constructor) }
}
