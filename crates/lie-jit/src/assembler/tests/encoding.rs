//! Every instruction with every class of register and every form of a place, beside the bytes that GNU's assembler has for its text. They
//! are kept in `encoding.txt`; `LIE_UPDATE_GOLDEN=1` has them written anew by `as` and `objdump`.

use crate::assembler::encoding::{Bytes, General, Memory, Read};
use crate::assembler::operation::{Arithmetic, Vector, Width};
use std::fmt::Write as _;
use std::process::Command;

const GENERAL: [General; 15] = [
    General::Rax,
    General::Rcx,
    General::Rdx,
    General::Rbx,
    General::Rsp,
    General::Rbp,
    General::Rsi,
    General::Rdi,
    General::R8,
    General::R9,
    General::R10,
    General::R11,
    General::R12,
    General::R13,
    General::R14,
];

fn name(register: General) -> String {
    format!("{register:?}").to_lowercase()
}

fn vector(width: Width, vector: Vector) -> String {
    let kind = match width {
        Width::Eight => 'z',
        Width::Four => 'y',
        Width::One => 'x',
    };
    format!("{kind}mm{}", vector.0)
}

fn memory(memory: Memory) -> String {
    match memory {
        Memory::At(base, distance) => format!("[{}{distance:+}]", name(base)),
        Memory::Sum(base, index) => format!("[{}+{}]", name(base), name(index)),
        Memory::Constant(_) => "[rip]".to_owned(),
    }
}

fn read(width: Width, read: Read) -> String {
    match (read, width) {
        (Read::Vector(of), _) => vector(width, of),
        (Read::Whole(at), Width::Eight) => format!("zmmword ptr {}", memory(at)),
        (Read::Whole(at), Width::Four) => format!("ymmword ptr {}", memory(at)),
        (Read::Whole(at), Width::One) => format!("qword ptr {}", memory(at)),
        (Read::Single(at), _) => format!("qword ptr {}{{1to8}}", memory(at)),
    }
}

/// Texts with the bytes of ours.
#[derive(Default)]
struct Lines(Vec<(String, Vec<u8>)>);

impl Lines {
    fn add(&mut self, text: String, write: impl FnOnce(&mut Bytes)) {
        let mut bytes = Bytes::default();
        write(&mut bytes);
        self.0.push((text, bytes.all));
    }
}

/// Registers of all classes: those whose number has each bit or not.
fn classes(width: Width) -> impl Iterator<Item = Vector> {
    let all = [0, 3, 7, 8, 15, 16, 20, 24, 31].map(Vector);
    all.into_iter().filter(move |v| v.0 < width.registers())
}

/// Places of all forms.
fn places() -> Vec<Memory> {
    let distances = [
        0,
        8,
        64,
        120,
        128,
        1024,
        8128,
        8192,
        1 << 20,
        -64,
        -128,
        -136,
    ];
    let mut all = Vec::new();
    for base in GENERAL {
        all.push(Memory::At(base, 0));
        all.push(Memory::At(base, 192));
    }
    for base in [General::Rsp, General::R13] {
        all.extend(distances.map(|distance| Memory::At(base, distance)));
    }
    for [base, index] in [
        [General::Rax, General::Rbx],
        [General::Rbp, General::R12],
        [General::R13, General::Rcx],
        [General::R9, General::R11],
    ] {
        all.push(Memory::Sum(base, index));
    }
    all.push(Memory::Constant(0));
    all
}

fn arithmetic(lines: &mut Lines, width: Width) {
    let suffix = if width == Width::One { "sd" } else { "pd" };
    let zero = Vector(0);
    for (what, stem) in [
        (Arithmetic::Add, "vadd"),
        (Arithmetic::Sub, "vsub"),
        (Arithmetic::Mul, "vmul"),
        (Arithmetic::Div, "vdiv"),
        (Arithmetic::Xor, "vxor"),
        (Arithmetic::And, "vand"),
        (Arithmetic::Or, "vor"),
        (Arithmetic::Plus, "vpaddq"),
    ] {
        let mnemonic = match (what, width) {
            (Arithmetic::Plus, _) => stem.to_owned(),
            (_, Width::Eight) if what.is_of_bits() => stem.replacen('v', "vp", 1) + "q",
            _ if what.is_of_bits() => format!("{stem}pd"),
            _ => format!("{stem}{suffix}"),
        };
        let mut each = |to: Vector, left: Vector, right: Read| {
            let (a, b) = (vector(width, to), vector(width, left));
            let right_text = match (width, right) {
                (Width::One, Read::Whole(at)) if what.is_of_bits() => {
                    format!("xmmword ptr {}", memory(at))
                }
                _ => read(width, right),
            };
            lines.add(format!("{mnemonic} {a}, {b}, {right_text}"), |bytes| {
                bytes.arithmetic(width, what, to, left, right);
            });
        };
        for v in classes(width) {
            each(v, zero, Read::Vector(zero));
            each(zero, v, Read::Vector(Vector(1)));
            each(Vector(2), zero, Read::Vector(v));
            each(v, v, Read::Vector(v));
            each(v, v, Read::Whole(Memory::At(General::Rdi, 64)));
        }
        each(Vector(9), Vector(1), Read::Whole(Memory::Constant(0)));
        let places = places();
        // all places for sums
        let some = if what == Arithmetic::Add { 1 } else { 7 };
        for place in places.iter().step_by(some) {
            each(Vector(1), Vector(2), Read::Whole(*place));
            if width == Width::Eight {
                each(Vector(17), Vector(18), Read::Single(*place));
            }
        }
    }
}

fn moves(lines: &mut Lines, width: Width) {
    let mnemonic = if width == Width::One {
        "vmovsd"
    } else {
        "vmovupd"
    };
    let at = Memory::At(General::R8, 256);
    for (v, place) in classes(width)
        .map(|v| (v, at))
        .chain(places().into_iter().map(|place| (Vector(5), place)))
    {
        let (text, place_text) = (vector(width, v), read(width, Read::Whole(place)));
        lines.add(format!("{mnemonic} {text}, {place_text}"), |bytes| {
            bytes.load(width, v, Read::Whole(place));
        });
        lines.add(format!("{mnemonic} {place_text}, {text}"), |bytes| {
            bytes.store(width, place, v);
        });
        if width != Width::One {
            let single = format!("qword ptr {}", memory(place));
            lines.add(format!("vbroadcastsd {text}, {single}"), |bytes| {
                bytes.load(width, v, Read::Single(place));
            });
        }
    }
}

fn choices(lines: &mut Lines, width: Width) {
    let suffix = if width == Width::One { "sd" } else { "pd" };
    for v in classes(width) {
        for (to, [test, then, otherwise]) in [
            (v, [Vector(1), Vector(2), Vector(3)]),
            (Vector(1), [v, Vector(2), Vector(4)]),
            (Vector(1), [Vector(2), v, Vector(4)]),
            (Vector(1), [Vector(2), Vector(4), v]),
        ] {
            let text = |of| vector(width, of);
            let [a, b, c, d] = [to, test, then, otherwise].map(text);
            let constant = Memory::Constant(0);
            let zero = match width {
                Width::Eight => Read::Single(constant),
                _ => Read::Whole(constant),
            };
            let zero_text = read(width, zero);
            let line = match width {
                Width::Eight => {
                    format!("vcmppd k1, {b}, {zero_text}, 0x11; vblendmpd {a}{{k1}}, {d}, {c}")
                }
                Width::Four => {
                    format!("vcmppd {a}, {b}, {zero_text}, 0x11; vblendvpd {a}, {d}, {c}, {a}")
                }
                Width::One => format!(
                    "vxorpd {a}, {a}, {a}; vucomisd {a}, {b}; vmovapd {a}, {c}; ja 1f; vmovapd {a}, {d}; 1:"
                ),
            };
            lines.add(line, |bytes| {
                bytes.below(width, true, to, [test, then, otherwise], zero);
            });
            if width == Width::One {
                let line =
                    format!("vcmpsd {a}, {b}, {zero_text}, 0x11; vblendvpd {a}, {d}, {c}, {a}");
                lines.add(line, |bytes| {
                    bytes.below(width, false, to, [test, then, otherwise], zero);
                });
            }
            let line = match width {
                Width::Eight => {
                    format!(
                        "vcmppd k1, {b}, {zero_text}, 0x19; kortestw k1, k1; {{disp32}} jne .+6"
                    )
                }
                Width::Four => {
                    format!(
                        "vcmppd {a}, {b}, {zero_text}, 0x19; vptest {a}, {a}; {{disp32}} jne .+6"
                    )
                }
                Width::One => format!("vucomisd {b}, {zero_text}; {{disp32}} jb .+6"),
            };
            lines.add(line, |bytes| {
                bytes.jump_unless_all_above(width, test, zero, to);
            });
        }
        let (of, suffixes) = (vector(width, v), ["vpsllq", "vpsrlq"]);
        for (places, shift) in [(52, suffixes[0]), (63, suffixes[0]), (-52, suffixes[1])] {
            let [one, two] = [1, 2].map(|of| vector(width, Vector(of)));
            let by = i8::abs(places);
            let line = format!("{shift} {one}, {of}, {by}; {shift} {of}, {two}, {by}");
            lines.add(line, |bytes| {
                bytes.shift(width, Vector(1), v, places);
                bytes.shift(width, v, Vector(2), places);
            });
        }
        for (equal, (to, [left, right])) in [false, true]
            .into_iter()
            .zip([(v, [Vector(1), Vector(2)]), (Vector(1), [v, Vector(2)])])
        {
            let [a, b, c] = [to, left, right].map(|of| vector(width, of));
            let constant = Memory::Constant(0);
            let (one, kind) = match width {
                Width::Eight => (Read::Single(constant), "qword"),
                Width::Four => (Read::Whole(constant), "ymmword"),
                Width::One => (Read::Whole(constant), "xmmword"),
            };
            let one_text = format!("{kind} ptr {}", memory(constant));
            let number = if equal { "0x12" } else { "0x11" };
            let line = match width {
                Width::Eight => format!(
                    "vcmppd k1, {b}, {c}, {number}; vbroadcastsd {a}{{k1}}{{z}}, {one_text}"
                ),
                _ => format!("vcmp{suffix} {a}, {b}, {c}, {number}; vandpd {a}, {a}, {one_text}"),
            };
            lines.add(line, |bytes| {
                bytes.compare_numbers(width, to, [left, right], equal, one);
            });
        }
        for (to, operands) in [
            (v, [Vector(1), Vector(2)]),
            (Vector(1), [v, Vector(2)]),
            (Vector(2), [Vector(1), v]),
        ] {
            let [left, right] = operands;
            let [a, b, c] = [to, left, right].map(|of| vector(width, of));
            let chosen = match width {
                Width::Eight => format!("vcmppd k1, {c}, {c}, 3; vblendmpd {a}{{k1}}, {b}, {c}"),
                _ => format!("vcmp{suffix} {a}, {c}, {c}, 3; vblendvpd {a}, {b}, {c}, {a}"),
            };
            lines.add(format!("{chosen}; vmax{suffix} {a}, {c}, {a}"), |bytes| {
                bytes.larger(width, to, operands);
            });
        }
        let (text, suffix) = (vector(width, v), format!("vsqrt{suffix}"));
        let root = match width {
            Width::One => format!("{suffix} xmm1, {text}, {text}; {suffix} {text}, xmm2, xmm2"),
            _ => {
                let [one, two] = [1, 2].map(|of| vector(width, Vector(of)));
                format!("{suffix} {one}, {text}; {suffix} {text}, {two}")
            }
        };
        lines.add(root, |bytes| {
            bytes.sqrt(width, Vector(1), v);
            bytes.sqrt(width, v, Vector(2));
        });
    }
}

fn exchanges(lines: &mut Lines, width: Width) {
    let all: &[(u8, &str, u8)] = match width {
        Width::Eight => &[
            (1, "vpermilpd", 0x55),
            (2, "vshuff64x2", 0xB1),
            (4, "vshuff64x2", 0x4E),
            (6, "vshuff64x2", 0x1B),
        ],
        Width::Four => &[(1, "vpermilpd", 5), (2, "vperm2f128", 1)],
        Width::One => &[],
    };
    for (distance, mnemonic, number) in all {
        for v in classes(width) {
            for (to, of) in [(v, Vector(1)), (Vector(2), v), (v, v)] {
                let [to_text, of_text] = [to, of].map(|v| vector(width, v));
                let twice = if *distance == 1 {
                    of_text
                } else {
                    format!("{of_text}, {of_text}")
                };
                let line = format!("{mnemonic} {to_text}, {twice}, {number}");
                lines.add(line, |bytes| {
                    bytes.exchange(width, to, of, *distance).unwrap();
                });
            }
        }
    }
    for distance in [0, 3, 8] {
        assert!(
            Bytes::default()
                .exchange(width, Vector(0), Vector(1), distance)
                .is_none()
        );
    }
}

fn general(lines: &mut Lines) {
    for register in GENERAL {
        let text = name(register);
        let other = General::Rdx;
        for place in [
            Memory::At(register, 8),
            Memory::At(General::Rsp, 4096),
            Memory::Sum(General::Rax, General::Rbx),
        ] {
            let at = memory(place);
            lines.add(format!("mov {text}, {at}"), |bytes| {
                bytes.load_word(register, place);
            });
            lines.add(format!("mov {at}, {text}"), |bytes| {
                bytes.store_word(place, register);
            });
            lines.add(format!("and {text}, {at}; or {text}, {at}"), |bytes| {
                bytes.and_word(register, place);
                bytes.or_word(register, place);
            });
        }
        lines.add(format!("mov {text}, rdx; mov rdx, {text}"), |bytes| {
            bytes.copy_word(register, other);
            bytes.copy_word(other, register);
        });
        lines.add(format!("movabs {text}, 0x123456789abcdef0"), |bytes| {
            bytes.word_constant(register, 0x1234_5678_9abc_def0);
        });
        lines.add(format!("push {text}; pop {text}"), |bytes| {
            bytes.push(register);
            bytes.pop(register);
        });
        lines.add(format!("and {text}, -64"), |bytes| bytes.align(register));
        for number in [64, 128, 4096] {
            lines.add(
                format!("add {text}, {number}; sub {text}, {number}"),
                |bytes| {
                    bytes.add(register, number);
                    bytes.subtract(register, number);
                },
            );
        }
        lines.add(format!("or qword ptr [{text}], 0"), |bytes| {
            bytes.touch(register);
        });
        let short = match register {
            General::R8 | General::R9 | General::R10 | General::R11 => format!("{text}d"),
            General::R12 | General::R13 | General::R14 => format!("{text}d"),
            _ => text.replacen('r', "e", 1),
        };
        lines.add(format!("xor {short}, {short}"), |bytes| {
            bytes.zero(register)
        });
        lines.add(format!("call {text}"), |bytes| bytes.call(register));
        lines.add(format!("jmp {text}"), |bytes| bytes.jump(register));
        let line = format!("test {text}, {text}; {{disp32}} je .+6");
        lines.add(line, |bytes| {
            bytes.jump_if_zero(register);
        });
        lines.add(format!("cmp {text}, rdx; cmp rdx, {text}"), |bytes| {
            bytes.compare(register, other);
            bytes.compare(other, register);
        });
        lines.add(format!("lea {text}, [rbp-32]"), |bytes| {
            bytes.address_below(register, General::Rbp, 32);
        });
    }
    lines.add("vzeroupper; ret".to_owned(), |bytes| {
        bytes.clear_upper_halves();
        bytes.return_();
    });
    lines.add("vzeroupper; {disp32} jb .-3".to_owned(), |bytes| {
        bytes.clear_upper_halves();
        bytes.jump_if_below(0);
    });
    lines.add("vzeroupper; {disp32} jmp .-3".to_owned(), |bytes| {
        bytes.clear_upper_halves();
        bytes.jump_back(0);
    });
}

fn hexadecimal(bytes: &[u8]) -> String {
    bytes.iter().fold(String::new(), |mut text, byte| {
        let _ = write!(text, "{byte:02x}");
        text
    })
}

/// The bytes that GNU's assembler has for these texts.
fn by_gnu(texts: &[String]) -> Vec<String> {
    let folder = tempfile::tempdir().unwrap();
    let [source, object, binary] = ["a.s", "a.o", "a.bin"].map(|file| folder.path().join(file));
    // every text ends at the next multiple of 64, so that its bytes are those before what fills up
    let mut text = ".intel_syntax noprefix\n".to_owned();
    for (number, line) in texts.iter().enumerate() {
        let end = 64 * (number + 1);
        let _ = write!(text, "{line}\n.byte 0xf4\n.org {end}, 0\n");
    }
    std::fs::write(&source, text).unwrap();
    let run = |program: &str, arguments: &[&std::ffi::OsStr]| {
        let status = Command::new(program).args(arguments).status();
        assert!(status.unwrap().success(), "{program}");
    };
    run("as", &["-o".as_ref(), object.as_ref(), source.as_ref()]);
    let section = ["-O", "binary", "-j", ".text"].map(std::ffi::OsStr::new);
    run(
        "objcopy",
        &[&section[..], &[object.as_ref(), binary.as_ref()]].concat(),
    );
    let bytes = std::fs::read(binary).unwrap();
    let blocks = bytes.chunks(64);
    let ended = blocks.map(|block| {
        let end = block.iter().rposition(|byte| *byte == 0xf4).unwrap();
        hexadecimal(&block[..end])
    });
    ended.collect()
}

#[test]
fn instructions_have_the_bytes_of_gnus_assembler() {
    let mut lines = Lines::default();
    for width in [Width::Eight, Width::Four, Width::One] {
        arithmetic(&mut lines, width);
        moves(&mut lines, width);
        choices(&mut lines, width);
        exchanges(&mut lines, width);
    }
    general(&mut lines);
    let path = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/src/assembler/tests/encoding.txt"
    );
    if std::env::var_os("LIE_UPDATE_GOLDEN").is_some() {
        let texts: Vec<String> = lines.0.iter().map(|(text, _)| text.clone()).collect();
        let bytes = by_gnu(&texts).into_iter().zip(&texts);
        let all: String = bytes
            .map(|(bytes, text)| format!("{bytes} {text}\n"))
            .collect();
        std::fs::write(path, all).unwrap();
    }
    let expected = std::fs::read_to_string(path).unwrap();
    let found = lines
        .0
        .iter()
        .map(|(text, bytes)| format!("{} {text}", hexadecimal(bytes)));
    let found: Vec<String> = found.collect();
    let expected: Vec<&str> = expected.lines().collect();
    assert!(found.len() > 500, "{} instructions", found.len());
    assert_eq!(found.len(), expected.len());
    let differ: Vec<String> = found
        .iter()
        .zip(&expected)
        .filter(|(found, expected)| found != *expected)
        .map(|(found, expected)| format!("ours {found}\ngnu  {expected}"))
        .collect();
    assert!(differ.is_empty(), "{}", differ.join("\n"));
}
