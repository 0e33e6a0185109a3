//! Reads NumPy's array file: `numpy.save` writes it.
//!
//! Format: <https://numpy.org/doc/stable/reference/generated/numpy.lib.format.html>, versions 1.0 to 3.0.

/// Numbers, the last index fastest.
#[derive(Debug, PartialEq)]
pub struct Array {
    /// The size along each axis.
    pub shape: Vec<usize>,
    /// The numbers.
    pub values: Vec<f64>,
}

/// What is wrong with a file, and the remedy.
#[derive(Debug, PartialEq)]
pub struct Fault {
    /// What is wrong.
    pub text: String,
    /// What to do.
    pub help: &'static str,
}

const SAVE: &str = "write it with `numpy.save(path, array)`";

fn fault<T>(text: impl Into<String>, help: &'static str) -> Result<T, Fault> {
    let text = text.into();
    Err(Fault { text, help })
}

/// The array in the bytes of a file.
///
/// # Errors
/// It is no such file, or one of other numbers than `f8` and `f4`, in another order, cut off or too long.
pub fn parse(bytes: &[u8]) -> Result<Array, Fault> {
    let Some((header, data)) = header(bytes) else {
        return fault("it is no file in NumPy's format", SAVE);
    };
    let width = match text(after(header, "descr")) {
        Some("<f8") => 8,
        Some("<f4") => 4,
        kind => {
            let kind = kind.unwrap_or("a structure");
            return fault(
                format!("its numbers are of type `{kind}`, not `<f8` or `<f4`"),
                "write it with `numpy.save(path, array.astype('<f8'))`",
            );
        }
    };
    let shape = match after(header, "shape").map(shape) {
        Some(Some(shape)) => shape,
        _ => return fault("its header has no shape", SAVE),
    };
    match after(header, "fortran_order") {
        Some(order) if order.starts_with("False") => {}
        Some(order) if order.starts_with("True") => {
            return fault(
                "its numbers are in Fortran order",
                "write it with `numpy.save(path, numpy.ascontiguousarray(array))`",
            );
        }
        _ => return fault("its header does not say the order of its numbers", SAVE),
    }
    let size = shape
        .iter()
        .try_fold(width, |size: usize, n| size.checked_mul(*n));
    if size != Some(data.len()) {
        return fault(
            format!(
                "it has {} bytes of numbers for the shape {shape:?}",
                data.len()
            ),
            "copy it once more, or write it again",
        );
    }
    let double = |bytes: &[u8]| bytes.try_into().map_or(f64::NAN, f64::from_le_bytes);
    let single = |bytes: &[u8]| {
        bytes
            .try_into()
            .map_or(f64::NAN, |b| f32::from_le_bytes(b).into())
    };
    let numbers = data.chunks_exact(width);
    let values = match width {
        8 => numbers.map(double).collect(),
        _ => numbers.map(single).collect(),
    };
    Ok(Array { shape, values })
}

/// The header, and what stands behind it.
fn header(bytes: &[u8]) -> Option<(&str, &[u8])> {
    let rest = bytes.strip_prefix(b"\x93NUMPY")?;
    let (version, rest) = rest.split_at_checked(2)?;
    let (length, rest) = match version[0] {
        1 => {
            let (length, rest) = rest.split_first_chunk::<2>()?;
            (usize::from(u16::from_le_bytes(*length)), rest)
        }
        2 | 3 => {
            let (length, rest) = rest.split_first_chunk::<4>()?;
            (usize::try_from(u32::from_le_bytes(*length)).ok()?, rest)
        }
        _ => return None,
    };
    let (header, data) = rest.split_at_checked(length)?;
    Some((str::from_utf8(header).ok()?, data))
}

/// What stands behind a key of the header, a dictionary in Python.
fn after<'a>(header: &'a str, key: &str) -> Option<&'a str> {
    let quoted = [format!("'{key}'"), format!("\"{key}\"")];
    let rest = quoted
        .iter()
        .find_map(|key| Some(header.split_once(key.as_str())?.1))?;
    Some(rest.trim_start().strip_prefix(':')?.trim_start())
}

/// A string in quotes.
fn text(value: Option<&str>) -> Option<&str> {
    let value = value?;
    let quote = value.chars().next().filter(|c| matches!(c, '\'' | '"'))?;
    Some(value[1..].split_once(quote)?.0)
}

/// `(1000, 3)`
fn shape(value: &str) -> Option<Vec<usize>> {
    let (inside, _) = value.strip_prefix('(')?.split_once(')')?;
    let sizes = inside
        .split(',')
        .map(str::trim)
        .filter(|size| !size.is_empty());
    sizes.map(|size| size.parse().ok()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn file(header: &str, data: &[u8]) -> Vec<u8> {
        let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
        bytes.extend((header.len() as u16).to_le_bytes());
        bytes.extend(header.as_bytes());
        bytes.extend(data);
        bytes
    }

    fn header(kind: &str, order: &str, shape: &str) -> String {
        format!("{{'descr': {kind}, 'fortran_order': {order}, 'shape': {shape}, }}  \n")
    }

    #[test]
    fn both_widths_are_read() {
        let values = [0.1, -2.5, 1e300, 4.0, 5.0, 6.0];
        let double: Vec<u8> = values.iter().flat_map(|x: &f64| x.to_le_bytes()).collect();
        let array = parse(&file(&header("'<f8'", "False", "(2, 3)"), &double)).unwrap();
        assert_eq!((array.shape, array.values), (vec![2, 3], values.to_vec()));
        let single: Vec<u8> = [1.5_f32, 0.1]
            .iter()
            .flat_map(|x| x.to_le_bytes())
            .collect();
        let array = parse(&file(&header("\"<f4\"", "False", "(2,)"), &single)).unwrap();
        assert_eq!(
            (array.shape, array.values),
            (vec![2], vec![1.5, f64::from(0.1_f32)])
        );
        let mut second = b"\x93NUMPY\x02\x00".to_vec();
        let text = header("'<f8'", "False", "()");
        second.extend((text.len() as u32).to_le_bytes());
        second.extend(text.as_bytes());
        second.extend(7.0_f64.to_le_bytes());
        assert_eq!(parse(&second).unwrap().values, [7.0]);
    }

    #[test]
    fn what_is_no_such_array_is_refused() {
        let eight = [0; 8];
        for (bytes, expected) in [
            (b"PK\x03\x04".to_vec(), "no file in NumPy's format"),
            (b"\x93NUMPY\x01".to_vec(), "no file in NumPy's format"),
            (
                b"\x93NUMPY\x01\x00\xff\xff{".to_vec(),
                "no file in NumPy's format",
            ),
            (file(&header("'>f8'", "False", "(1,)"), &eight), "`>f8`"),
            (file(&header("'<i8'", "False", "(1,)"), &eight), "`<i8`"),
            (
                file(&header("[('x', '<f8')]", "False", "(1,)"), &eight),
                "a structure",
            ),
            (
                file(&header("'<f8'", "True", "(1, 1)"), &eight),
                "Fortran order",
            ),
            (
                file(&header("'<f8'", "no", "(1,)"), &eight),
                "order of its numbers",
            ),
            (file(&header("'<f8'", "False", "1"), &eight), "no shape"),
            (file(&header("'<f8'", "False", "(x,)"), &eight), "no shape"),
            (
                file(&header("'<f8'", "False", "(2,)"), &eight),
                "8 bytes of numbers",
            ),
            (
                file(
                    &header("'<f8'", "False", "(4294967296, 4294967296)"),
                    &eight,
                ),
                "8 bytes of numbers",
            ),
            (file("{}", &eight), "a structure"),
        ] {
            let found = parse(&bytes).expect_err(expected);
            assert!(found.text.contains(expected), "{expected}: {found:?}");
        }
    }
}
