//! Kernels at many states.

use crate::errors::of_system;
use lie_dynamic::Dynamic;
use lie_in_process::memory;
use lie_runtime::{Poisson, SquareMatrix};
use numpy::{IntoPyArray, PyArray2, PyArrayMethods, PyReadonlyArray2};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use std::io;
use std::time::{Duration, Instant};

/// Between two looks for Ctrl-C.
const PAUSE: Duration = Duration::from_millis(50);
/// States between two looks at the clock.
const STRIDE: usize = 256;

/// A function of the state.
#[derive(Clone, Copy)]
enum Kernel {
    Hamiltonian,
    Casimirs,
    VectorField,
    Gradient,
    Jacobian,
    Hessian,
    PoissonMatrix,
}

impl Kernel {
    fn of(name: &str) -> PyResult<Self> {
        Ok(match name {
            "hamiltonian" => Self::Hamiltonian,
            "casimirs" => Self::Casimirs,
            "vector_field" => Self::VectorField,
            "gradient" => Self::Gradient,
            "jacobian" => Self::Jacobian,
            "hessian" => Self::Hessian,
            "poisson_matrix" => Self::PoissonMatrix,
            other => return Err(PyValueError::new_err(format!("no function `{other}`"))),
        })
    }
}

/// A kernel at one state after the other, with the memory that it needs; of coordinates, those `shown`.
struct Evaluation<'a> {
    kernel: Kernel,
    system: &'a Dynamic<f64>,
    shown: &'a [usize],
    out: Vec<f64>,
    matrix: <Dynamic<f64> as Poisson<f64>>::Jacobian,
    casimirs: Vec<f64>,
}

impl<'a> Evaluation<'a> {
    fn new(kernel: Kernel, system: &'a Dynamic<f64>, shown: &'a [usize]) -> Self {
        Self {
            kernel,
            system,
            shown,
            out: system.zero_state(),
            matrix: system.zero_jacobian(),
            casimirs: vec![0.0; system.casimir_count()],
        }
    }

    /// Numbers for each state.
    fn width(&self) -> usize {
        let n = self.shown.len();
        match self.kernel {
            Kernel::Hamiltonian => 1,
            Kernel::Casimirs => self.casimirs.len(),
            Kernel::VectorField | Kernel::Gradient => n,
            Kernel::Jacobian | Kernel::Hessian | Kernel::PoissonMatrix => n * n,
        }
    }

    fn at(&mut self, mu: &Vec<f64>, values: &mut Vec<f64>) {
        let (system, matrix) = (self.system, &mut self.matrix);
        match self.kernel {
            Kernel::Hamiltonian => return values.push(system.hamiltonian(mu)),
            Kernel::Casimirs => {
                system.casimirs(mu, &mut self.casimirs);
                return values.extend_from_slice(&self.casimirs);
            }
            Kernel::VectorField => system.vector_field(mu, &mut self.out),
            Kernel::Gradient => system.gradient(mu, &mut self.out),
            Kernel::Jacobian => system.jacobian(mu, matrix),
            Kernel::Hessian => system.hessian(mu, matrix),
            Kernel::PoissonMatrix => system.poisson_matrix(mu, matrix),
        }
        match self.kernel {
            Kernel::VectorField | Kernel::Gradient => {
                values.extend(self.shown.iter().map(|&i| self.out[i]));
            }
            _ => {
                for &i in self.shown {
                    values.extend(self.shown.iter().map(|&j| self.matrix.get(i, j)));
                }
            }
        }
    }
}

/// A kernel at states, one in each row; Ctrl-C ends it.
pub fn evaluate<'py>(
    py: Python<'py>,
    name: &str,
    system: &Dynamic<f64>,
    shown: &[usize],
    states: &PyReadonlyArray2<'py, f64>,
) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let mut evaluation = Evaluation::new(Kernel::of(name)?, system, shown);
    let (states, width) = (states.as_array(), evaluation.width());
    let count = states.nrows();
    let values = py.detach(|| {
        let mut values = Vec::new();
        memory::fits((count * width) as f64 * memory::NUMBER)
            .map_err(io::Error::from)
            .and_then(|()| memory::reserve(&mut values, count * width))
            .map_err(of_system)?;
        let mut looked = Instant::now();
        for (number, row) in states.rows().into_iter().enumerate() {
            if number % STRIDE == 0 && looked.elapsed() > PAUSE {
                Python::attach(|py| py.check_signals())?;
                looked = Instant::now();
            }
            evaluation.at(&system.completed(row.to_vec()), &mut values);
        }
        Ok::<_, PyErr>(values)
    })?;
    values.into_pyarray(py).reshape([count, width])
}
