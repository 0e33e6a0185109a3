//! The lines of a request.

use crate::driver::{Options, Save};
use crate::newton::NewtonOptions;
use std::io::BufRead;

/// Tolerances of adaptive methods; others ignore them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tolerances {
    /// Relative tolerance.
    pub rtol: f64,
    /// Absolute tolerance.
    pub atol: f64,
}

impl Default for Tolerances {
    fn default() -> Self {
        Self {
            rtol: 1e-6,
            atol: 1e-9,
        }
    }
}

/// What is asked for.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Request {
    pub(super) method: String,
    pub(super) tolerances: Tolerances,
    pub(super) parameters: Vec<f64>,
    pub(super) initial: Vec<f64>,
    step: f64,
    until: Option<f64>,
    at: Vec<f64>,
    every: u64,
}

/// Why there is no request.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum RequestError {
    /// The input ended before `run`.
    Ended,
    /// A line that is not understood, or missing.
    Wrong(String),
}

impl Request {
    /// Reads the lines up to `run`.
    pub(super) fn read(input: &mut impl BufRead, defaults: &[f64]) -> Result<Self, RequestError> {
        let mut request = Self {
            method: String::new(),
            tolerances: Tolerances::default(),
            parameters: defaults.to_vec(),
            initial: Vec::new(),
            step: f64::NAN,
            until: None,
            at: Vec::new(),
            every: 1,
        };
        let mut line = String::new();
        loop {
            line.clear();
            let length = input.read_line(&mut line);
            let length = length.map_err(|error| RequestError::Wrong(error.to_string()))?;
            if length == 0 {
                return Err(RequestError::Ended);
            }
            if line.trim() == "run" {
                return request.complete();
            }
            request
                .take(&line)
                .ok_or_else(|| RequestError::Wrong(line.trim().to_owned()))?;
        }
    }

    /// Takes one line; none if it is not understood.
    fn take(&mut self, line: &str) -> Option<()> {
        let (key, rest) = line.trim().split_once(' ')?;
        match key {
            "method" => self.method = rest.to_owned(),
            "step" => self.step = rest.parse().ok()?,
            "until" => self.until = Some(rest.parse().ok()?),
            "at" => self.at.push(rest.parse().ok()?),
            "every" => self.every = rest.parse().ok()?,
            "rtol" => self.tolerances.rtol = rest.parse().ok()?,
            "atol" => self.tolerances.atol = rest.parse().ok()?,
            "initial" => {
                self.initial = rest
                    .split_whitespace()
                    .map(str::parse)
                    .collect::<Result<_, _>>()
                    .ok()?;
            }
            "parameter" => {
                let (index, value) = rest.split_once(' ')?;
                *self.parameters.get_mut(index.parse::<usize>().ok()?)? = value.parse().ok()?;
            }
            _ => return None,
        }
        Some(())
    }

    fn complete(self) -> Result<Self, RequestError> {
        let missing = |what: &str| Err(RequestError::Wrong(format!("no `{what}` was given")));
        if self.method.is_empty() {
            missing("method")
        } else if self.step.is_nan() {
            missing("step")
        } else if self.until.is_none() && self.at.is_empty() {
            missing("until")
        } else {
            Ok(self)
        }
    }

    /// The end of the run: as asked, or the saved time farthest from 0.
    pub(super) fn end(&self) -> f64 {
        let farther = |a: f64, b: f64| if b.abs() > a.abs() { b } else { a };
        self.until
            .unwrap_or_else(|| self.at.iter().copied().fold(0.0, farther))
    }

    pub(super) fn options(&self) -> Options {
        let save = if self.at.is_empty() {
            Save::Every(self.every)
        } else {
            Save::At(self.at.clone())
        };
        Options {
            step: self.step,
            save,
            newton: NewtonOptions::default(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<Request, RequestError> {
        Request::read(&mut text.as_bytes(), &[1.0, 2.0])
    }

    #[test]
    fn a_full_request() {
        let request = read(
            "method dopri5\nstep 0.1\nat 1.5\nat 0.25\nparameter 1 3e-2\ninitial 1 -0.5 2e3\nrtol 1e-8\nrun\n",
        )
        .unwrap();
        assert_eq!(request.method, "dopri5");
        assert_eq!(request.parameters, [1.0, 0.03]);
        assert_eq!(request.initial, [1.0, -0.5, 2000.0]);
        assert_eq!(
            request.tolerances,
            Tolerances {
                rtol: 1e-8,
                atol: 1e-9
            }
        );
        assert_eq!(request.end(), 1.5);
        assert_eq!(request.options().save, Save::At(vec![1.5, 0.25]));
        let request = read("method rk4\nstep -0.1\nuntil -2\nevery 5\nrun\n").unwrap();
        assert_eq!(
            (request.end(), request.options().save),
            (-2.0, Save::Every(5))
        );
    }

    #[test]
    fn wrong_lines_are_named() {
        for line in [
            "step x",
            "parameter 2 1",
            "every -1",
            "speed 3",
            "until",
            "initial 1 a",
        ] {
            let text = format!("method rk4\n{line}\nrun\n");
            assert_eq!(
                read(&text),
                Err(RequestError::Wrong(line.to_owned())),
                "{line}"
            );
        }
        assert_eq!(read("method rk4\nstep 1\n"), Err(RequestError::Ended));
        for text in ["run\n", "method rk4\nrun\n", "method rk4\nstep 1\nrun\n"] {
            assert!(
                matches!(read(text), Err(RequestError::Wrong(text)) if text.starts_with("no `"))
            );
        }
    }
}
