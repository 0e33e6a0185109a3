//! What is computed of all members, as it is asked for.

use lie_in_process::Work;
use lie_in_process::ensemble::Cast;
use lie_in_process::reduce::{Bins, MOST_BINS};
use lie_in_process::request::OptionValue;

use crate::command::args::{self, Reduce};
use crate::message::{Failure, Message};

/// The probabilities where none are given.
pub const QUANTILES: [f64; 5] = [0.05, 0.25, 0.5, 0.75, 0.95];

/// The probabilities of quantiles, in the order in which they are given.
///
/// # Errors
/// `option` for what is none.
pub fn quantiles(flags: &args::Ensemble) -> Result<Vec<f64>, Failure> {
    if !flags.reduce.contains(&Reduce::Quantiles) {
        return Ok(Vec::new());
    }
    let Some(given) = &flags.quantiles else {
        return Ok(QUANTILES.to_vec());
    };
    let given = OptionValue::value("--quantiles", given);
    let number = |part: OptionValue| {
        let number = part.number()?;
        match (0.0..=1.0).contains(&number) {
            true => Ok(number),
            false => {
                let message = part.wrong("a probability is between 0 and 1");
                Err(message.help("give numbers such as 0.05,0.5,0.95"))
            }
        }
    };
    let numbers: Result<_, Message> = given.split().into_iter().map(number).collect();
    Ok(numbers?)
}

/// How many bins a histogram has, if that is said.
///
/// # Errors
/// `option` for what is no such number.
pub fn bins(flags: &args::Ensemble) -> Result<Option<usize>, Failure> {
    let Some(given) = &flags.bins else {
        return Ok(None);
    };
    let given = OptionValue::value("--bins", given);
    let number = given.number()?;
    if !(1.0..=MOST_BINS as f64).contains(&number) || number.fract() != 0.0 {
        let message = given.wrong(format!("bins are a whole number from 1 to {MOST_BINS}"));
        return Err(message.help("give a number such as 50").into());
    }
    Ok(Some(number as usize))
}

/// Where members are counted: by the leaves of the first one whose parameters make a system.
pub fn bins_of(work: &Work, cast: &Cast, count: Option<usize>) -> Bins {
    let mut parameters = cast.parameters.iter();
    let system = parameters.find_map(|values| work.declared().system(values).ok());
    Bins::of(system.as_ref(), count)
}
