//! NumPy's array file, version 1.0: float64, little-endian, rows one behind the other.

use super::form::{Form, Header, Run};

/// Length of the header. The row count has room for 20 digits, so that it can be patched.
pub const LENGTH: usize = 128;

/// An array that grows along its first axis.
pub struct Npy {
    /// The size along the others.
    shape: Vec<usize>,
    /// What tells the run apart: its number and the values of its parameters.
    prefix: Vec<f64>,
}

impl Npy {
    /// An array with the columns of numbers that the header names.
    pub fn new(header: &Header) -> Self {
        let labels = header.labels.as_ref();
        let before = labels.map_or(0, |labels| 1 + labels.parameters.len());
        Self::of_shape(vec![before + header.columns.len()])
    }

    /// An array with this shape behind its first axis.
    pub fn of_shape(shape: Vec<usize>) -> Self {
        let prefix = Vec::new();
        Self { shape, prefix }
    }
}

/// The first bytes of an array with so many rows of a shape.
pub fn header(rows: u64, shape: &[usize]) -> Vec<u8> {
    let mut header = b"\x93NUMPY\x01\x00".to_vec();
    header.extend_from_slice(&((LENGTH - 10) as u16).to_le_bytes());
    let sizes = shape.iter().map(|size| format!(", {size}"));
    // one number in parentheses is no tuple
    let comma = if shape.is_empty() { "," } else { "" };
    let shape = format!("({rows}{}{comma})", sizes.collect::<String>());
    let text = format!("{{'descr': '<f8', 'fortran_order': False, 'shape': {shape}, }}");
    header.extend_from_slice(text.as_bytes());
    header.resize(LENGTH - 1, b' ');
    header.push(b'\n');
    header
}

/// The bytes of a whole array.
pub fn array(shape: &[usize], numbers: &[f64]) -> Vec<u8> {
    let (first, rest) = shape.split_first().unwrap_or((&1, &[]));
    let mut bytes = header(*first as u64, rest);
    bytes.extend(numbers.iter().flat_map(|number| number.to_le_bytes()));
    bytes
}

impl Form for Npy {
    fn begin(&mut self, _header: &Header, out: &mut Vec<u8>) {
        out.extend_from_slice(&header(0, &self.shape));
    }

    fn open(&mut self, header: &Header, run: &Run, _out: &mut Vec<u8>) {
        self.prefix.clear();
        if header.labels.is_some() {
            self.prefix.push(run.number as f64);
            self.prefix.extend_from_slice(&run.parameters);
        }
    }

    fn row(&mut self, row: &[f64], out: &mut Vec<u8>) {
        let numbers = self.prefix.iter().chain(row);
        out.reserve((self.prefix.len() + row.len()) * size_of::<f64>());
        numbers.for_each(|value| out.extend_from_slice(&value.to_le_bytes()));
    }

    fn start(&self, rows: u64) -> Option<Vec<u8>> {
        Some(header(rows, &self.shape))
    }

    fn patches_its_start(&self) -> bool {
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_shape_is_a_tuple_of_python() {
        let shape = |sizes: &[usize]| {
            let bytes = array(sizes, &vec![0.0; sizes.iter().product()]);
            let header = String::from_utf8_lossy(&bytes[10..LENGTH]).into_owned();
            let shape = header.split("'shape': ").nth(1);
            shape.map(|rest| rest.trim_end().to_owned())
        };
        assert_eq!(shape(&[3]).as_deref(), Some("(3,), }"));
        assert_eq!(shape(&[2, 3]).as_deref(), Some("(2, 3), }"));
    }
}
