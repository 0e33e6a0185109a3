//! `lie schema`: prints the JSON Schema of spec files.

use super::print;
use crate::message::Failure;

/// Prints it.
///
/// # Errors
/// stdout cannot be written.
pub fn run() -> Result<u8, Failure> {
    print(&format!("{:#}\n", lie_syntax::front::schema()))?;
    Ok(0)
}
