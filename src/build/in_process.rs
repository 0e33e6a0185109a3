//! The work of a command in this program, without a compiler of Rust.

use lie_codegen::methods::Choice;
use lie_codegen::program::Purpose;
use lie_codegen::structure::Structure;
use lie_in_process::Work;

use super::talk::Worker;
use lie_in_process::clock;

/// What serves requests for methods on a system in this program; none where a program has to be built.
pub fn in_process_worker(
    model: &Structure,
    choices: &[Choice],
    purpose: Purpose,
) -> Option<Worker> {
    let work = Work::new(model, choices, purpose, clock::processor);
    work.map(|work| Worker::InProcess(work.into()))
}
