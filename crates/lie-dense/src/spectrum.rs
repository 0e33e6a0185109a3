//! The spectrum: all that an isospectral flow keeps.

use crate::skew::SkewHermitian;
use crate::stream::StreamMap;
use crate::system::MatrixFlow;
use core::ops::ControlFlow;
use lie_runtime::State;
use lie_runtime::driver::{Observer, Progress};
use nalgebra::{Complex, DMatrix};

/// The eigenvalues of the Hermitian matrix `-i W`, in increasing order; not numbers where W is not finite.
///
/// They determine every Casimir of u(N), `tr (-i W)^k` for all k.
pub fn spectrum(w: &SkewHermitian) -> Vec<f64> {
    if !w.as_slice().iter().all(|entry| entry.is_finite()) {
        return vec![f64::NAN; w.size()];
    }
    let matrix = DMatrix::from_fn(w.size(), w.size(), |row, column| {
        let (re, im) = w.entry(row, column);
        Complex::new(im, -re)
    });
    let mut values = matrix.symmetric_eigenvalues().as_slice().to_vec();
    values.sort_by(f64::total_cmp);
    values
}

/// An observer that compares the spectrum of each saved state with that of the first.
#[derive(Clone, Debug, Default)]
pub struct SpectrumMonitor {
    first: Vec<f64>,
    /// The largest change of an eigenvalue that was seen.
    pub change: f64,
}

impl SpectrumMonitor {
    /// A monitor that has seen nothing yet.
    pub fn new() -> Self {
        Self::default()
    }

    /// The largest absolute eigenvalue at the start.
    pub fn radius(&self) -> f64 {
        self.first.iter().fold(0.0, |a, &b| a.max(b.abs()))
    }
}

impl<M: StreamMap> Observer<f64, MatrixFlow<M>> for SpectrumMonitor {
    fn start(&mut self, _system: &MatrixFlow<M>, _progress: Progress, mu: &SkewHermitian) {
        self.first = spectrum(mu);
        self.change = 0.0;
    }

    fn row(&mut self, _system: &MatrixFlow<M>, _time: f64, mu: &SkewHermitian) -> ControlFlow<()> {
        for (&now, &first) in spectrum(mu).iter().zip(&self.first) {
            let change = (now - first).abs();
            // not a number is a change too
            if change > self.change || change.is_nan() {
                self.change = change;
            }
        }
        ControlFlow::Continue(())
    }
}
