//! Mistakes of the command line itself, as clap finds them, in the form of every other message.

use clap::error::{ContextKind, ContextValue, ErrorKind};
use clap::{CommandFactory as _, Parser as _};
use lie_syntax::diagnostic::Kind;
use lie_syntax::suggest::meant;

use super::BUILT;
use super::args::Cli;
use crate::message::Message;

/// What the command line amounts to.
pub enum Parsed {
    /// A command.
    Command(Box<Cli>),
    /// Help or version, for stdout.
    Text(String),
}

/// Reads the command line.
///
/// # Errors
/// One `option` error that names the flag.
pub fn parse(
    arguments: impl IntoIterator<Item = std::ffi::OsString>,
) -> Result<Parsed, Box<Message>> {
    let arguments: Vec<std::ffi::OsString> = arguments.into_iter().collect();
    let mut words = arguments.iter().skip(1).filter_map(|word| word.to_str());
    let command = words.find(|word| !word.starts_with('-'));
    let command = command.unwrap_or_default().to_owned();
    match Cli::try_parse_from(arguments) {
        Ok(cli) => Ok(Parsed::Command(Box::new(cli))),
        Err(error) => match error.kind() {
            ErrorKind::DisplayHelp | ErrorKind::DisplayVersion => {
                Ok(Parsed::Text(error.to_string()))
            }
            _ => Err(Box::new(message(&error, &command))),
        },
    }
}

fn text(error: &clap::Error, kind: ContextKind) -> Option<String> {
    match error.get(kind)? {
        ContextValue::String(text) => Some(text.clone()),
        ContextValue::Strings(texts) => Some(texts.join(", ")),
        ContextValue::StyledStr(text) => Some(text.to_string()),
        _ => None,
    }
}

/// `--step <H>` -> `--step`; `<SPEC>...` -> `SPEC`.
fn flag(argument: &str) -> String {
    let name = argument.split([' ', '=']).next().unwrap_or(argument);
    name.trim_end_matches('.')
        .trim_matches(['<', '>', '[', ']'])
        .to_owned()
}

/// The long flags of a command.
fn flags(command: &str) -> Vec<String> {
    let cli = Cli::command();
    let Some(command) = cli.find_subcommand(command) else {
        return Vec::new();
    };
    let flags = command.get_arguments().filter_map(clap::Arg::get_long);
    flags.map(str::to_owned).collect()
}

fn message(error: &clap::Error, command: &str) -> Message {
    let usage = text(error, ContextKind::Usage)
        .map(|usage| usage.replace("Usage:", "").trim().to_owned())
        .filter(|usage| !usage.is_empty());
    let argument = text(error, ContextKind::InvalidArg);
    let place = argument
        .as_deref()
        .map(flag)
        .unwrap_or_else(|| "lie".to_owned());
    let value = text(error, ContextKind::InvalidValue).unwrap_or_default();
    let (what, help) = match error.kind() {
        ErrorKind::InvalidValue if value.is_empty() => (format!("`{place}` needs a value"), None),
        ErrorKind::InvalidValue => {
            let possible = text(error, ContextKind::ValidValue);
            (
                format!("`{value}` is not a value of `{place}`"),
                possible.map(|possible| format!("possible values: {possible}")),
            )
        }
        ErrorKind::UnknownArgument => unknown(&place, command),
        ErrorKind::InvalidSubcommand => return unknown_command(error),
        ErrorKind::MissingSubcommand | ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand => {
            let help = format!("the commands are {}; see `lie --help`", BUILT.join(", "));
            return Message::option("lie", "no command given").help(help);
        }
        ErrorKind::MissingRequiredArgument => (format!("`{place}` is missing"), None),
        ErrorKind::ArgumentConflict => match text(error, ContextKind::PriorArg) {
            Some(prior) if flag(&prior) != place => (
                format!("`{place}` cannot be combined with `{}`", flag(&prior)),
                None,
            ),
            _ => (
                format!("`{place}` is given twice"),
                Some("give it once".to_owned()),
            ),
        },
        ErrorKind::TooFewValues | ErrorKind::WrongNumberOfValues => {
            (format!("`{place}` needs a value"), None)
        }
        ErrorKind::TooManyValues => (format!("`{place}` does not take the value `{value}`"), None),
        _ => {
            let rendered = error.to_string();
            let first = rendered.lines().next().unwrap_or_default();
            (first.trim_start_matches("error: ").to_owned(), None)
        }
    };
    let help = help
        .or(usage.map(|usage| format!("usage: {usage}")))
        .unwrap_or_else(|| "see `lie --help`".to_owned());
    Message::option(&place, what).help(help)
}

/// An argument that the command does not have, and which of its flags may be meant.
fn unknown(place: &str, command: &str) -> (String, Option<String>) {
    if !place.starts_with('-') {
        return (format!("unexpected argument `{place}`"), None);
    }
    let flags = flags(command);
    let near = meant(
        place.trim_start_matches('-'),
        flags.iter().map(String::as_str),
    );
    let help = near.map(|near| format!("did you mean `--{near}`?"));
    (format!("unknown option `{place}`"), help)
}

fn unknown_command(error: &clap::Error) -> Message {
    let command = text(error, ContextKind::InvalidSubcommand).unwrap_or_default();
    let help = match meant(&command, BUILT) {
        Some(name) => format!("did you mean `{name}`?"),
        None => format!("the commands are {}", BUILT.join(", ")),
    };
    let what = format!("unknown command `{command}`");
    Message::new(Kind::Option, what)
        .at_option(&command)
        .help(help)
}

#[cfg(test)]
mod tests {
    use super::*;
    use lie_in_process::request::{Parameter, Value};

    fn of(arguments: &str) -> Message {
        let arguments = std::iter::once("lie").chain(arguments.split_whitespace());
        match parse(arguments.map(Into::into)) {
            Err(message) => *message,
            Ok(_) => panic!("accepted"),
        }
    }

    #[test]
    fn every_mistake_names_its_flag_and_has_help() {
        for (arguments, place, what) in [
            ("", "lie", "no command"),
            ("rum x", "rum", "unknown command `rum`"),
            ("run", "SPEC", "`SPEC` is missing"),
            ("run x --stepp 1", "--stepp", "unknown option"),
            ("run x --step", "--step", "needs a value"),
            ("run x --step 1 --step 2", "--step", "twice"),
            ("run x --format xml", "--format", "`xml` is not a value"),
            ("run x --cpu=", "--cpu", "needs a value"),
            ("run x --quiet=1", "--quiet", "does not take the value `1`"),
            ("schema more", "more", "unexpected argument"),
            ("expand", "SPEC", "missing"),
            ("check --json", "SPEC", "missing"),
        ] {
            let message = of(arguments);
            let crate::message::Place::Argument { name, .. } = &message.place else {
                panic!("{arguments}: no place")
            };
            assert_eq!(name, place, "{arguments}: {message:?}");
            assert!(message.text.contains(what), "{arguments}: {message:?}");
            assert!(
                message.help.as_deref().is_some_and(|help| !help.is_empty()),
                "{arguments}"
            );
            assert_eq!(message.kind, Kind::Option);
        }
        for (arguments, meant) in [
            ("rum x", "run"),
            ("chekc x", "check"),
            ("integrate x", "run"),
            ("run x --stepp 1", "--step"),
            ("run x --dt 0.1", "--step"),
            ("run x --t-end 5", "--until"),
            ("run x --y0 1,2,3", "--initial"),
            ("run x --params k=1", "--param"),
            ("run x --reltol 1e-9", "--rtol"),
            ("run x -o file.csv", "--out"),
            ("check x --jsno", "--json"),
        ] {
            let expected = format!("did you mean `{meant}`?");
            assert_eq!(of(arguments).help, Some(expected), "{arguments}");
        }
    }

    #[test]
    fn values_may_be_negative() {
        let line =
            "lie run a --step -0.01 --until -1/2 --initial -1/2,0.3 --at -cos(1) --param k=-1";
        let parsed = parse(line.split(' ').map(Into::into));
        let Ok(Parsed::Command(cli)) = parsed else {
            panic!("refused")
        };
        let super::super::args::Command::Run(run) = cli.command else {
            panic!("not run")
        };
        let text = |text: &str| Some(Value::Text(text.to_owned()));
        assert_eq!(run.request.step, text("-0.01"));
        assert_eq!(run.request.initial, text("-1/2,0.3"));
        assert_eq!(run.request.param, [Parameter::Written("k=-1".to_owned())]);
    }

    #[test]
    fn the_spelling_of_calls_is_taken() {
        let run = |line: &str| match parse(line.split(' ').map(Into::into)) {
            Ok(Parsed::Command(cli)) => match cli.command {
                super::super::args::Command::Run(run) => run.request,
                _ => panic!("not run"),
            },
            _ => panic!("refused"),
        };
        assert_eq!(
            run("lie run a --h 0.1 --t -5 --x0 1,2,3"),
            run("lie run a --step 0.1 --until -5 --initial 1,2,3")
        );
    }

    #[test]
    fn definition_is_sound() {
        Cli::command().debug_assert();
    }
}
