//! The processor that a program is built for.

use crate::command::args::Cpu;
use crate::message::Message;

/// Which instructions a program may use.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Processor {
    /// Those that every processor of the architecture has.
    Portable,
    /// All of this machine's: the same operations in the same order, and so the same bits.
    Native,
    /// All of this machine's, and `a * b + c` is rounded once where the compiler sees it: faster, with other bits.
    Fused,
}

impl Processor {
    /// What `--cpu` and `--fma` ask for.
    ///
    /// # Errors
    /// `option`: fused multiply-add is not among the instructions that every processor has.
    pub fn from_options(cpu: Cpu, fma: bool) -> Result<Self, Message> {
        match (cpu, fma) {
            (Cpu::Portable, false) => Ok(Self::Portable),
            (Cpu::Native, false) => Ok(Self::Native),
            (Cpu::Native, true) => Ok(Self::Fused),
            (Cpu::Portable, true) => {
                let text = "fused multiply-add is not an instruction of every processor";
                let help = "leave out `--cpu portable`, or leave out `--fma`";
                Err(Message::option("--fma", text).help(help))
            }
        }
    }

    /// Its name in the key of a program.
    pub fn name(self) -> &'static str {
        match self {
            Self::Portable => "portable",
            Self::Native => "native",
            Self::Fused => "fused",
        }
    }

    /// Whether the program may not run on another machine.
    pub fn is_of_this_machine(self) -> bool {
        self != Self::Portable
    }

    /// The flags of the compiler, as `CARGO_ENCODED_RUSTFLAGS` wants them.
    pub fn flags(self) -> &'static str {
        match self {
            Self::Portable => "",
            Self::Native => "-Ctarget-cpu=native",
            Self::Fused => "-Ctarget-cpu=native\x1f-Cllvm-args=-fp-contract=fast",
        }
    }

    /// Looks whether a machine with these features can do what is asked.
    ///
    /// `features` is what `rustc --print cfg` says.
    ///
    /// # Errors
    /// `option`: an x86 processor without fused multiply-add.
    pub fn check(self, features: &str) -> Result<(), Message> {
        let has = |line: &str| features.lines().any(|found| found == line);
        let x86 = has("target_arch=\"x86_64\"") || has("target_arch=\"x86\"");
        if self == Self::Fused && x86 && !has("target_feature=\"fma\"") {
            let text = "this machine's processor has no fused multiply-add";
            return Err(Message::option("--fma", text).help("leave out `--fma`"));
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_machine_without_the_instruction_is_told_so() {
        let old = "target_arch=\"x86_64\"\ntarget_feature=\"sse2\"\n";
        let new = "target_arch=\"x86_64\"\ntarget_feature=\"fma\"\n";
        assert!(Processor::Fused.check(old).is_err());
        assert!(Processor::Native.check(old).is_ok());
        assert!(Processor::Fused.check(new).is_ok());
        let arm = "target_arch=\"aarch64\"\ntarget_feature=\"neon\"\n";
        assert!(Processor::Fused.check(arm).is_ok());
    }
}
