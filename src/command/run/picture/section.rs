//! Where runs pass a surface of section.

use lie_codegen::methods::Choice;
use lie_dynamic::{Dynamic, Tolerances};
use lie_methods::method;
use lie_runtime::newton::NewtonOptions;

/// A surface on which a coordinate has a value, and what is drawn of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Chosen {
    /// Which coordinate.
    pub coordinate: usize,
    /// Its value.
    pub value: f64,
    /// The coordinates that are drawn.
    pub axes: [usize; 2],
}

/// Finds the passages of a run between its rows: from the last row before, `gauss16` goes a part of the way, and the part is
/// the zero of the coordinate on the surface.
pub struct Section {
    chosen: Chosen,
    system: Option<Dynamic<f64>>,
    last: Option<(f64, Vec<f64>)>,
    /// Passages that could not be found.
    lost: usize,
}

impl Section {
    /// Before the first run.
    pub fn new(chosen: Chosen) -> Self {
        Self {
            chosen,
            system: None,
            last: None,
            lost: 0,
        }
    }

    /// Begins a run of a system.
    pub fn begin(&mut self, system: Option<Dynamic<f64>>) {
        self.system = system;
        self.last = None;
    }

    /// Takes a row; the point of a passage since the last one, in the coordinates that are drawn.
    pub fn push(&mut self, time: f64, state: &[f64]) -> Option<(f64, f64)> {
        let Chosen {
            coordinate,
            value,
            axes,
        } = self.chosen;
        let (before, start) = self.last.replace((time, state.to_vec()))?;
        if !(start[coordinate] < value && state[coordinate] >= value) {
            return None;
        }
        let system = self.system.as_ref()?;
        let found = passage(system, &start, time - before, coordinate, value);
        self.lost += usize::from(found.is_none());
        found.map(|point| (point[axes[0]], point[axes[1]]))
    }

    /// `m1 rises through 0.5`, where the coordinate has this name.
    pub fn words(&self, coordinate: &str) -> String {
        format!("{coordinate} rises through {}", self.chosen.value)
    }

    /// Which coordinate has a value.
    pub fn coordinate(&self) -> usize {
        self.chosen.coordinate
    }

    /// What there is to say.
    pub fn note(&self, found: usize) -> Option<String> {
        if self.lost > 0 {
            let lost = self.lost;
            return Some(format!(
                "{lost} passages of the section could not be computed from their rows: take more rows with a smaller `--every`"
            ));
        }
        (found == 0).then(|| {
            "the section is never passed: choose another, such as `--picture section:NAME=VALUE` with a value between the \
             extremes of the coordinate"
                .to_owned()
        })
    }
}

/// The state at which a coordinate rises through a value, within a span of time from a state before; to round-off.
fn passage(
    system: &Dynamic<f64>,
    start: &[f64],
    span: f64,
    coordinate: usize,
    value: f64,
) -> Option<Vec<f64>> {
    let gauss = method(&Choice::Gauss(8), Tolerances::default());
    let after = |part: f64| {
        let mut state = start.to_vec();
        let newton = NewtonOptions::default();
        let mut stepper = gauss.any_stepper(system, part * span, &newton);
        stepper.step(&mut state).ok().map(|_| state)
    };
    let scale = start
        .iter()
        .fold(value.abs(), |scale, x| scale.max(x.abs()));
    let close = 4.0 * f64::EPSILON * scale;
    // the Illinois variant of regula falsi: the end that stays counts half
    let (mut low, mut at_low) = (0.0, start[coordinate] - value);
    let (mut high, mut state) = (1.0, after(1.0)?);
    let mut at_high = state[coordinate] - value;
    if at_high < 0.0 {
        return None;
    }
    let mut side = 0;
    for _ in 0..80 {
        if at_high.abs() <= close {
            break;
        }
        let part = (low * at_high - high * at_low) / (at_high - at_low);
        if !(low < part && part < high) {
            break;
        }
        let next = after(part)?;
        let at = next[coordinate] - value;
        if at >= 0.0 || at.abs() <= close {
            (high, at_high, state) = (part, at, next);
            at_low *= if side == 1 { 0.5 } else { 1.0 };
            side = 1;
        } else {
            (low, at_low) = (part, at);
            at_high *= if side == -1 { 0.5 } else { 1.0 };
            side = -1;
        }
    }
    let off = (state[coordinate] - value).abs();
    (off <= 16.0 * close).then_some(state)
}

#[cfg(test)]
mod tests {
    use super::*;
    use lie_codegen::compile::compile_spec;
    use lie_codegen::plan::plan;
    use lie_dynamic::{Declared, Interpreted};
    use lie_runtime::Poisson as _;

    const TOP: &str = include_str!("../../../../specs/se3_heavy_top.json");

    #[test]
    fn passages_lie_on_the_section_and_on_the_levels() {
        let model = compile_spec(TOP).unwrap();
        let values = model.defaults();
        let declared = Declared::new(plan(&model, &[]), &Interpreted);
        let system = declared.system(&values).unwrap();
        let chosen = Chosen {
            coordinate: 0,
            value: 0.1,
            axes: [1, 2],
        };
        let rk4 = method(&Choice::Rk4, Tolerances::default());
        let mut stepper = rk4.any_stepper(&system, 0.05, &NewtonOptions::default());
        let mut state = system.initial_state().unwrap();
        let mut found = 0;
        let mut crude = 0.0_f64;
        for _ in 0..2000 {
            let before = state.clone();
            stepper.step(&mut state).unwrap();
            if before[0] < chosen.value && state[0] >= chosen.value {
                let point = passage(&system, &before, 0.05, 0, chosen.value).unwrap();
                assert!((point[0] - chosen.value).abs() < 1e-14);
                let (at, on) = (system.hamiltonian(&before), system.hamiltonian(&point));
                assert!((at - on).abs() < 1e-13, "{at} {on}");
                // the control: between the rows by a straight line
                let part = (chosen.value - before[0]) / (state[0] - before[0]);
                let line: Vec<f64> = before
                    .iter()
                    .zip(&state)
                    .map(|(a, b)| a + part * (b - a))
                    .collect();
                crude = crude.max((system.hamiltonian(&line) - at).abs());
                found += 1;
            }
        }
        assert!(found > 5, "{found}");
        assert!(crude > 1e-8, "{crude}");
        assert_eq!(passage(&system, &state, 1e-9, 0, state[0] + 1.0), None);
    }
}
