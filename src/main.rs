//! The `lie` command: checks, expands and runs Lie–Poisson systems from spec files.

fn main() -> std::process::ExitCode {
    lie_poisson::main()
}
