//! `--shard`: which share of the members is run.

use std::env;

use lie_in_process::request::OptionValue;
use lie_in_process::share::Share;

use crate::message::{Failure, Message};

/// The share that is asked for; all members where none is.
///
/// # Errors
/// `option` for what is none, or for an array job that does not say it.
pub fn of(text: Option<&str>) -> Result<Share, Failure> {
    let variable = |name: &str| env::var(name).ok();
    Ok(text.map_or(Ok(Share::WHOLE), |text| read(text, &variable))?)
}

fn read(text: &str, variable: &dyn Fn(&str) -> Option<String>) -> Result<Share, Message> {
    let given = OptionValue::flag("--shard", text);
    let wrong = |what: String, help: &str| given.wrong(what).help(help);
    let number = |name: &str| -> Result<u64, Message> {
        let value = variable(name).ok_or_else(|| {
            wrong(
                format!("this is no array job of Slurm: {name} is not set"),
                "submit it by `sbatch --array=1-N`, or give the share, such as `--shard 3/8`",
            )
        })?;
        value.trim().parse().map_err(|_| {
            wrong(
                format!("{name} is `{value}`, which is no number"),
                "give the share, such as `--shard 3/8`",
            )
        })
    };
    let text = text.trim();
    if text == "slurm" {
        let (task, count) = (
            number("SLURM_ARRAY_TASK_ID")?,
            number("SLURM_ARRAY_TASK_COUNT")?,
        );
        let (first, last) = (
            number("SLURM_ARRAY_TASK_MIN")?,
            number("SLURM_ARRAY_TASK_MAX")?,
        );
        // tasks that are far apart by the same number
        let apart = last.saturating_sub(first) / (count.max(2) - 1);
        let apart = apart.max(1);
        let (place, rest) = (
            task.saturating_sub(first) / apart,
            task.saturating_sub(first) % apart,
        );
        let even = last.checked_sub(first) == Some(apart * (count.max(1) - 1));
        if task < first || rest > 0 || place >= count || !even {
            return Err(wrong(
                format!(
                    "the array has {count} tasks between {first} and {last}, not at equal distances"
                ),
                "submit an array such as 1-8, and lost tasks of it with `--shard slurm/8`",
            ));
        }
        return Ok(Share {
            number: place + 1,
            of: count,
        });
    }
    if let Some(of) = text.strip_prefix("slurm/") {
        let task = number("SLURM_ARRAY_TASK_ID")?;
        return Share::read(&format!("{task}/{of}")).ok_or_else(|| {
            wrong(
                format!("the task {task} is not one of `{of}` shares"),
                "with `--shard slurm/N` the array is 1-N, or some of these numbers",
            )
        });
    }
    Share::read(text).ok_or_else(|| {
        wrong(
            format!("`{text}` is no share"),
            "give its number from 1 on and how many there are, such as `--shard 3/8`; or `slurm`",
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The share in an array job: the task, how many, from where to where.
    fn task(text: &str, numbers: [u64; 4]) -> Result<(u64, u64), String> {
        let names = ["ID", "COUNT", "MIN", "MAX"];
        let variable = |name: &str| {
            let found = names
                .iter()
                .position(|end| name == format!("SLURM_ARRAY_TASK_{end}"));
            found.map(|place| numbers[place].to_string())
        };
        match read(text, &variable) {
            Ok(share) => Ok((share.number, share.of)),
            Err(message) => {
                assert!(message.help.is_some());
                Err(message.text)
            }
        }
    }

    #[test]
    fn tasks_of_an_array_are_shares() {
        assert_eq!(task("slurm", [1, 8, 1, 8]), Ok((1, 8)));
        assert_eq!(task("slurm", [7, 8, 0, 7]), Ok((8, 8)));
        assert_eq!(task("slurm", [14, 5, 10, 18]), Ok((3, 5)));
        assert_eq!(task("slurm", [4, 1, 4, 4]), Ok((1, 1)));
        for odd in [[3, 3, 1, 7], [3, 3, 1, 17], [2, 5, 10, 18]] {
            assert!(
                task("slurm", odd).unwrap_err().contains("equal distances"),
                "{odd:?}"
            );
        }
        // a task that is submitted again
        assert_eq!(task("slurm/8", [4, 1, 4, 4]), Ok((4, 8)));
        assert!(task("slurm/8", [0, 1, 0, 0]).is_err());
        assert_eq!(task("2/3", [0; 4]), Ok((2, 3)));
        for text in ["3/2", "0/2", "third", "slurm8", ""] {
            assert!(
                task(text, [0; 4]).unwrap_err().contains("is no share"),
                "{text}"
            );
        }
        let none = read("slurm", &|_| None).unwrap_err();
        assert!(none.text.contains("SLURM_ARRAY_TASK_ID is not set"));
    }
}
