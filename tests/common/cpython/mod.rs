//! Codes run by CPython, as an engine for systems made at run time: each code is a function in Python's own arithmetic.
//!
//! A process of `python3` is given the functions, and then the numbers of each call. Elementary functions are those of the numeric core,
//! which the process asks for.

use lie_dynamic::{
    BINARY, Bitwise, Code, Engine, Frame, Instruction, Interpreted, Lengths, Machine, Number,
    Source, Targets, UNARY, phi, stumpff,
};
use std::borrow::Cow;
use std::fmt::Write as _;
use std::io::{BufReader, Read as _, Write as _};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};
use std::sync::{Arc, LazyLock, Mutex};

/// What serves calls in the process.
const SERVE: &str = include_str!("serve.py");

/// CPython. Where there is none, codes are interpreted.
#[derive(Clone, Copy, Debug, Default)]
pub struct CPython;

/// Whether there is one, which is told where not.
pub fn there_is_cpython() -> bool {
    static THERE: LazyLock<bool> = LazyLock::new(|| {
        let asked = Command::new("python3").arg("--version").output();
        asked.is_ok_and(|output| output.status.success())
    });
    if !*THERE {
        eprintln!("skipped: no python3");
    }
    *THERE
}

impl Engine for CPython {
    fn name(&self) -> &'static str {
        "cpython"
    }

    fn machine(&self, codes: &Arc<[Code]>) -> Arc<dyn Machine<f64>> {
        match there_is_cpython() {
            true => Arc::new(Process::new(codes)),
            false => Interpreted.machine(codes),
        }
    }
}

/// The two ends of a conversation.
struct Talk {
    child: Child,
    asks: ChildStdin,
    says: BufReader<ChildStdout>,
}

impl Talk {
    /// Sends words, and numbers behind them.
    fn send(&mut self, words: &[u32], numbers: &[&[f64]]) {
        let mut message = Vec::new();
        for word in words {
            message.extend_from_slice(&word.to_ne_bytes());
        }
        for number in numbers.iter().copied().flatten() {
            message.extend_from_slice(&number.to_ne_bytes());
        }
        self.asks.write_all(&message).unwrap();
    }

    /// What is said: a name and numbers.
    fn hear(&mut self) -> (String, Vec<f64>) {
        let [length, count] = [(); 2].map(|()| {
            let mut word = [0; 4];
            self.says.read_exact(&mut word).unwrap();
            u32::from_ne_bytes(word) as usize
        });
        let mut bytes = vec![0; length + 8 * count];
        self.says.read_exact(&mut bytes).unwrap();
        let numbers = bytes.split_off(length);
        let (numbers, _) = numbers.as_chunks();
        let numbers = numbers.iter().map(|bytes| f64::from_ne_bytes(*bytes));
        (String::from_utf8(bytes).unwrap(), numbers.collect())
    }
}

/// A process with the functions of some codes.
struct Process {
    codes: Arc<[Code]>,
    lengths: Vec<Lengths>,
    talk: Mutex<Talk>,
}

impl Process {
    fn new(codes: &Arc<[Code]>) -> Self {
        let mut child = Command::new("python3")
            .args(["-c", SERVE])
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .unwrap();
        let asks = child.stdin.take().unwrap();
        let says = BufReader::new(child.stdout.take().unwrap());
        let expanded: Vec<_> = codes.iter().map(Code::expanded).collect();
        let functions: String = (0..).zip(&expanded).map(function).collect();
        let mut talk = Talk { child, asks, says };
        talk.send(&[functions.len() as u32], &[]);
        talk.asks.write_all(functions.as_bytes()).unwrap();
        Self {
            codes: Arc::clone(codes),
            lengths: codes.iter().map(Lengths::new).collect(),
            talk: Mutex::new(talk),
        }
    }
}

impl Drop for Talk {
    fn drop(&mut self) {
        // a process that waits for its next call may be ended
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// A number that no arithmetic of ours changes.
fn exact(number: f64) -> String {
    format!("bits({})", number.to_bits())
}

/// A code as a function of the slices of a frame, with a list of what it stores.
fn function((position, code): (usize, &Cow<'_, Code>)) -> String {
    let mut text = format!("def code_{position}(s):\n");
    for (register, source) in code.sources.iter().enumerate() {
        let value = match (source.place(), source) {
            (Some((slice, entry)), _) => format!("s[{slice}][{entry}]"),
            (None, Source::Number(Number::Exact(number) | Number::Parts(number, _))) => {
                exact(*number)
            }
            (None, Source::Number(Number::Ratio(above, below))) => {
                format!("{} / {}", exact(*above), exact(*below))
            }
            (None, other) => unreachable!("{other:?} is in a slice"),
        };
        let _ = writeln!(text, " r{register} = {value}");
    }
    let mut next = code.sources.len();
    for instruction in &code.instructions {
        let value = match *instruction {
            Instruction::Add(a, b) => format!("r{a} + r{b}"),
            Instruction::Sub(a, b) => format!("r{a} - r{b}"),
            Instruction::Mul(a, b) => format!("r{a} * r{b}"),
            Instruction::Div(a, b) => format!("divided(r{a}, r{b})"),
            Instruction::Neg(a) => format!("-r{a}"),
            Instruction::Sqrt(a) => format!("root(r{a})"),
            Instruction::Abs(a) => format!("abs(r{a})"),
            Instruction::Less(a, b) => format!("1.0 if r{a} < r{b} else 0.0"),
            Instruction::LessEqual(a, b) => format!("1.0 if r{a} <= r{b} else 0.0"),
            Instruction::Larger(a, b) => {
                format!("r{b} if r{a} < r{b} or r{b} != r{b} else r{a}")
            }
            // of one lane it is the same number
            Instruction::Exchange(_, a) => format!("r{a}"),
            Instruction::Below(a, b, c) | Instruction::Blend(a, b, c) => {
                format!("r{b} if r{a} < 0.0 else r{c}")
            }
            Instruction::Bits(what, a, b) => {
                let what = match what {
                    Bitwise::And => '&',
                    Bitwise::Or => '|',
                    Bitwise::Xor => '^',
                    Bitwise::Plus => '+',
                };
                format!("bits((word(r{a}) {what} word(r{b})) % 2**64)")
            }
            Instruction::Shift(places, a) => {
                let what = if places < 0 { ">>" } else { "<<" };
                format!("bits((word(r{a}) {what} {}) % 2**64)", places.abs())
            }
            Instruction::Rare(function, a, b, c) => {
                let beyond = format!("asked(b'{}', r{a})[0]", function.name());
                format!("r{c} if r{b} >= 0.0 else {beyond}")
            }
            Instruction::Power(a, b) => format!("asked(b'powf', r{a}, r{b})[0]"),
            Instruction::Atan2(a, b) => format!("asked(b'atan2', r{a}, r{b})[0]"),
            Instruction::Call(function, a) => format!("asked(b'{}', r{a})[0]", function.name()),
            Instruction::Stumpff(count, a) => format!("asked(b'stumpff {count}', r{a})"),
            Instruction::Phi(count, a) => format!("asked(b'phi {count}', r{a})"),
        };
        let width = instruction.width() as usize;
        let places: String = (next..next + width).map(|k| format!("r{k}, ")).collect();
        let _ = match instruction {
            Instruction::Stumpff(..) | Instruction::Phi(..) => {
                writeln!(text, " {places}= {value}")
            }
            _ => writeln!(text, " r{next} = {value}"),
        };
        next += width;
    }
    let stored = code
        .stores
        .iter()
        .map(|store| format!("r{}, ", store.register));
    let _ = writeln!(text, " return [{}]", stored.collect::<String>());
    text
}

/// What an elementary function of the numeric core gives.
fn answer(name: &str, at: &[f64]) -> Vec<f64> {
    if let Some((family, count)) = name.split_once(' ') {
        let count: u8 = count.parse().unwrap();
        let all = match family {
            "stumpff" => stumpff(count, at[0]),
            _ => phi(count, at[0]),
        };
        return all[..usize::from(count)].to_vec();
    }
    let unary = UNARY.iter().find(|(known, _)| *known == name);
    let binary = BINARY.iter().find(|(known, _)| *known == name);
    match (unary, binary) {
        (Some((_, f)), _) => vec![f(at[0])],
        (None, Some((_, f))) => vec![f(at[0], at[1])],
        (None, None) => panic!("CPython asks for `{name}`"),
    }
}

impl Machine<f64> for Process {
    fn run(&self, code: usize, frame: &Frame<'_, f64>, mut targets: Targets<'_, f64>) {
        self.lengths[code].check(frame, &targets);
        let mut talk = self.talk.lock().unwrap();
        let slices = frame.slices();
        let counts = slices.iter().map(|slice| slice.len() as u32);
        let words: Vec<u32> = std::iter::once(code as u32).chain(counts).collect();
        talk.send(&words, slices);
        let stored = loop {
            let (name, values) = talk.hear();
            if name.is_empty() {
                break values;
            }
            let answer = answer(&name, &values);
            talk.send(&[answer.len() as u32], &[&answer]);
        };
        let of = &self.codes[code];
        for (target, clear) in targets.iter_mut().zip(of.clear) {
            target[..clear.unwrap_or(0) as usize].fill(0.0);
        }
        for (store, value) in of.stores.iter().zip(stored) {
            targets[usize::from(store.target)][store.entry as usize] = value;
        }
    }
}
