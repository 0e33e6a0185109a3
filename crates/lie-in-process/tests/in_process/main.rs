//! Runs within a process: recorded steps, members of ensembles, clocks, what is shown of a run.

mod clock;
mod evidence;
mod members;
mod recording;
mod turns;
