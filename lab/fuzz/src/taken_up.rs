//! What `lie resume` reads, and the run that goes on from it.

use std::sync::LazyLock;

use lie_codegen::compile::compile_spec;
use lie_codegen::methods::Choice;
use lie_codegen::program::Purpose;
use lie_in_process::checkpoint::{Checkpoint, Unread, signed};
use lie_in_process::{Question as _, Work};
use lie_program::protocol::{End, Message, Milestone, Run};
use lie_program::session::Session;

const VERSION: &str = "0";

/// A body, by a method of each kind: explicit, implicit, adaptive.
static WORK: LazyLock<Work> = LazyLock::new(|| {
    let text = include_str!("../../../specs/so3_free_rigid_body.json");
    let model = compile_spec(text).expect("a spec that is right");
    let choices = METHODS.map(|id| Choice::from_id(id).expect("a method"));
    Work::new(&model, &choices, Purpose::Run, || None).expect("H without functions of Rust")
});

const METHODS: [&str; 3] = ["rk4", "gauss4", "dopri5"];

/// A run of 1010 steps, which has one milestone behind its start.
const RUN: &str = r#"{
    "method": "", "start": { "parameters": { "I1": 2, "I2": 1, "I3": 0.5 }, "initial": [0.5, 0, 1] },
    "pace": { "step": 0.0009765625 }, "from": 0, "times": { "until": { "end": 0.986328125, "every": 1 } },
    "tolerances": { "rtol": 1e-6, "atol": 1e-9 },
    "newton": { "iteration": "automatic", "tolerance": 1e-3, "max_iterations": 50, "convergence": "map" }
}"#;

/// A file as it is, and a file with this content. Whether the content is that of a checkpoint.
pub fn checkpoint(bytes: &[u8]) -> bool {
    if let Ok(read) = Checkpoint::read(bytes, VERSION) {
        came_back(&read);
    }
    let Ok(content) = std::str::from_utf8(bytes) else {
        return false;
    };
    let read = match Checkpoint::read(signed(content, VERSION).as_bytes(), VERSION) {
        Ok(read) => read,
        Err(Unread::Damaged(what)) => {
            assert!(!what.is_empty());
            return false;
        }
        Err(other) => panic!("{other:?}"),
    };
    came_back(&read);
    if let Some(place) = read.place {
        for method in METHODS {
            go_on(method, &place.milestone);
        }
    }
    true
}

/// What is written of it is read as the same.
fn came_back(checkpoint: &Checkpoint) {
    let text = |checkpoint: &Checkpoint| checkpoint.text(VERSION).expect("numbers");
    let written = text(checkpoint);
    let read = Checkpoint::read(written.as_bytes(), VERSION).expect("what was written");
    assert_eq!(text(&read), written);
}

/// The run from there comes to its end, or says why not. It has no milestones of its own, for which machine code would be made.
fn go_on(method: &str, milestone: &Milestone) {
    let mut run: Run = serde_json::from_str(RUN).expect("a run");
    run.method = method.to_owned();
    run.from_milestone = Some(milestone.clone());
    let mut said = Vec::new();
    let ended = run.put(&WORK, &mut Session::undisturbed(&mut said));
    match ended {
        Ok(()) => assert!(said.iter().any(|said| matches!(said, Message::Found(_)))),
        Err(End::Stopped(stop)) => assert!(!stop.remedy.is_empty()),
        Err(End::Refused { .. }) => {}
        Err(_) => panic!("nobody interrupts it"),
    }
}
