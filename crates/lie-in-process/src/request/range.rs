//! `FROM:TO:COUNT`: values at equal distances, both ends among them.

use super::OptionValue;
use crate::message::Message;

/// What is written, read.
pub(super) struct Range {
    /// The first value, as it was given.
    pub(super) from: OptionValue,
    /// The last value, as it was given.
    pub(super) to: OptionValue,
    ends: (f64, f64),
    count: usize,
}

/// What a range is called where it is given.
pub(super) struct Words<'a> {
    /// How it is written.
    pub(super) form: &'a str,
    /// One that is right, as it is written in this place.
    pub(super) example: String,
    /// The values of that.
    pub(super) meaning: &'a str,
    /// What there is one of for each value.
    pub(super) what: &'a str,
    /// How one value is given.
    pub(super) single: String,
    /// So many there may be,
    pub(super) most: usize,
    /// and what is said of more.
    pub(super) too_many: &'a dyn Fn(usize) -> Message,
}

impl Range {
    /// Reads a range.
    ///
    /// # Errors
    /// It is none, a part is no number, or there are too many values.
    pub(super) fn read(given: &OptionValue, words: &Words<'_>) -> Result<Self, Message> {
        let mut parts = Vec::new();
        let mut at = 0;
        for part in given.text.split(':') {
            parts.push(given.part(at..at + part.len()));
            at += part.len() + 1;
        }
        let Words {
            form,
            example,
            meaning,
            ..
        } = words;
        let [from, to, count] = parts.as_slice() else {
            let message = given.wrong(format!("`{}` is not {form}", given.text));
            return Err(message.help(format!("write it like {example}, for {meaning}")));
        };
        let ends = (from.number()?, to.number()?);
        let help = format!(
            "give the number of {}, at least 1, such as {example}",
            words.what
        );
        let number = count.count().map_err(|message| message.help(help))? as usize;
        if number > words.most {
            return Err((words.too_many)(number).at_place(given.wrong("").place));
        }
        if number == 1 && ends.0 != ends.1 {
            let message = given.wrong("one value cannot be both ends");
            let single = &words.single;
            return Err(message.help(format!("take at least 2 values, or give one as {single}")));
        }
        Ok(Self {
            from: from.clone(),
            to: to.clone(),
            ends,
            count: number,
        })
    }

    /// The first and the last value.
    pub(super) fn ends(&self) -> (f64, f64) {
        self.ends
    }

    /// All values.
    pub(super) fn values(&self) -> Vec<f64> {
        let ((from, to), count) = (self.ends, self.count);
        let last = (count - 1).max(1) as f64;
        let value = |k: usize| match k + 1 == count {
            true => to,
            false => from + (to - from) * (k as f64 / last),
        };
        (0..count).map(value).collect()
    }
}
