//! Time of this thread on a processor, and time that passes.

use rustix::time::{ClockId, clock_gettime};
use std::time::Instant;

/// A sample lasts about so many seconds.
const SAMPLE: f64 = 1.5e-3;

/// Seconds that this thread had a processor.
fn processor() -> f64 {
    let time = clock_gettime(ClockId::ThreadCPUTime);
    time.tv_sec as f64 + 1e-9 * time.tv_nsec as f64
}

/// What one run of something took: seconds of the processor, and seconds that passed.
#[derive(Clone, Copy, Debug)]
pub struct Spent {
    pub processor: f64,
    pub wall: f64,
}

/// Does something so often and says what it took each time.
pub fn spent(times: u32, mut work: impl FnMut()) -> Spent {
    let (start, before) = (Instant::now(), processor());
    for _ in 0..times {
        work();
    }
    let (wall, after) = (start.elapsed().as_secs_f64(), processor());
    let times = f64::from(times);
    Spent {
        processor: (after - before) / times,
        wall: wall / times,
    }
}

/// How often something that takes so many seconds is done in a sample.
pub fn times(seconds: f64) -> u32 {
    (SAMPLE / seconds).ceil().clamp(1.0, 1e5) as u32
}
