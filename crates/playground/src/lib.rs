//! The compiler and its back end of WebAssembly behind a page: a declaration in, its diagnostics or a system out, and then rows of a run.
//!
//! A page writes a request byte by byte, has it answered, and reads the answer byte by byte, so that no pointer crosses the
//! border; kernels are linked beside that (`linked.rs`). Requests and answers are JSON:
//!
//! - `{"declaration": "…", "method": "lie-midpoint", "step": 0.01, "seed": 1}` is answered by what the system is, or by
//!   `{"diagnostics": [{"line", "column", "kind", "message", "help", "warning"}]}`;
//! - `{"steps": 100, "every": 10, "inputs": {"u": 0.5}}` goes on from where the run is, with inputs held at these values, and is answered by
//!   `{"rows": […], "events": [{"event", "t", "stops"}], "stopped": null}`. A row holds t, the coordinates without those that carry the time,
//!   the energy, what is kept (the energy or its balance with the work, Casimirs, first integrals), the work, integrals, observables and inputs,
//!   and the generator of the motion, without damping the gradient of H.

#![warn(missing_docs)]

mod answer;
#[cfg(target_arch = "wasm32")]
mod linked;
mod run;

pub use answer::Session;

#[cfg(target_arch = "wasm32")]
mod exports {
    use std::cell::RefCell;

    use super::Session;

    thread_local! {
        static REQUEST: RefCell<Vec<u8>> = const { RefCell::new(Vec::new()) };
        static ANSWER: RefCell<Vec<u8>> = const { RefCell::new(Vec::new()) };
        static SESSION: RefCell<Session> = RefCell::new(Session::default());
    }

    /// Adds a byte to the request.
    #[unsafe(no_mangle)]
    pub extern "C" fn put(byte: u32) {
        REQUEST.with_borrow_mut(|request| request.push(byte as u8));
    }

    /// Answers the request; the length of the answer.
    #[unsafe(no_mangle)]
    pub extern "C" fn answer() -> u32 {
        let request = REQUEST.take();
        let text = String::from_utf8_lossy(&request);
        let answer = SESSION.with_borrow_mut(|session| session.answer(&text));
        let length = answer.len() as u32;
        ANSWER.set(answer.into_bytes());
        length
    }

    /// A byte of the answer.
    #[unsafe(no_mangle)]
    pub extern "C" fn get(index: u32) -> u32 {
        ANSWER.with_borrow(|answer| {
            answer
                .get(index as usize)
                .map_or(0, |byte| u32::from(*byte))
        })
    }
}
