//! Processor time of this thread, so that a busy machine does not count.

use std::time::Instant;

/// A running measurement.
pub struct Clock {
    wall: Instant,
    processor: Option<u64>,
}

impl Clock {
    /// Starts.
    pub fn start() -> Self {
        Self {
            wall: Instant::now(),
            processor: nanoseconds(),
        }
    }

    /// Seconds since the start; wall time where the system does not tell the processor time.
    pub fn seconds(&self) -> f64 {
        match (self.processor, nanoseconds()) {
            (Some(start), Some(end)) => (end - start) as f64 / 1e9,
            _ => self.wall.elapsed().as_secs_f64(),
        }
    }
}

/// Time on a processor so far (Linux).
fn nanoseconds() -> Option<u64> {
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").ok()?;
    text.split_whitespace().next()?.parse().ok()
}
