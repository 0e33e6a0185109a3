//! What `lie stress` says of the growth of round-off.

use super::table::short;

/// How the claimed invariant of a method that moves most grows with the steps.
#[derive(Clone, Debug)]
pub struct Growth {
    /// The method.
    pub method: String,
    invariant: String,
    exponent: f64,
    /// Standard error of the exponent.
    error: f64,
    /// At the end: root of the mean square over the states, and the largest.
    end: f64,
    largest: f64,
    /// Steps of the first and of the last point.
    from: u64,
    to: u64,
    states: u64,
    step: f64,
    /// The largest over its bound.
    ratio: f64,
}

impl Growth {
    /// Reads the fields of a line; none for a method that claims nothing or whose invariants do not move.
    pub fn read(fields: &[&str]) -> Option<Self> {
        let number = |index: usize| fields.get(index)?.parse::<f64>().ok();
        let count = |index: usize| fields.get(index)?.parse::<u64>().ok();
        Some(Self {
            method: (*fields.get(1)?).to_owned(),
            invariant: (*fields.get(2)?).to_owned(),
            exponent: number(3)?,
            error: number(4)?,
            end: number(5)?,
            largest: number(6)?,
            from: count(7)?,
            to: count(8)?,
            states: count(9)?,
            step: number(10)?,
            ratio: number(11)?,
        })
    }

    /// Whether some state moved further than round-off does.
    pub fn is_lost(&self) -> bool {
        !matches!(self.ratio, ratio if ratio <= 1.0)
    }

    /// `length2 N^0.95 ± 0.03`.
    pub fn cell(&self) -> String {
        format!(
            "{} N^{:.2} ± {:.2}",
            self.invariant, self.exponent, self.error
        )
    }

    /// What happened, in one line.
    pub fn text(&self) -> String {
        format!(
            "{}, {} states near the initial one, step {}: {} beyond {} times its round-off bound after {} steps",
            self.method,
            self.states,
            short(self.step),
            self.invariant,
            short(self.ratio),
            self.to
        )
    }

    /// A line of the table of experiments: the exponent stands as the value.
    pub fn csv(&self) -> String {
        let outcome = if self.is_lost() { "lost" } else { "kept" };
        let (energy, casimir) = match self.invariant.as_str() {
            "energy" => (self.end, f64::NAN),
            _ => (f64::NAN, self.end),
        };
        format!(
            "{},growth,{},{:?},{:?},{outcome},{},NaN,{energy:?},NaN,{casimir:?},NaN,{:?},standard error {:?} from {} steps on; \
             {} states; largest {:?}\n",
            self.method,
            self.invariant,
            self.exponent,
            self.step,
            self.to,
            self.ratio,
            self.error,
            self.from,
            self.states,
            self.largest
        )
    }
}

/// What the column says.
pub fn legend(growths: &[Growth]) -> String {
    let Some(growth) = growths.iter().max_by_key(|growth| growth.states) else {
        return String::new();
    };
    format!(
        "round-off: the claimed invariant that moves most, root of the mean square over {} states near the initial one against \
         the steps N, {} to {};\n  0.5 is a random walk, 1 a bias\n",
        growth.states, growth.from, growth.to
    )
}
