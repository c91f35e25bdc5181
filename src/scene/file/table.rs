//! Typed access to one table of the file, with a message for whatever is not there.

use std::ops::Range;

use glam::DVec3;
use toml::Spanned;
use toml::de::{DeArray, DeInteger, DeTable, DeValue};

use super::stray::Stray;
use super::{Diagnostic, Invalid, Log};

/// One table of the file, whose unknown keys are already in the log.
pub(super) struct Table<'a> {
    /// What messages call the table, such as `[camera]` in backticks.
    place: String,
    /// The header, or the whole of an inline table.
    span: Range<usize>,
    entries: &'a DeTable<'a>,
    strays: Vec<Stray>,
}

impl<'a> Table<'a> {
    /// A table of which `allowed` are the keys; the log gets a message for each other.
    pub(super) fn new(
        place: String,
        span: Range<usize>,
        entries: &'a DeTable<'a>,
        allowed: &'static [&'static str],
        log: &mut Log,
    ) -> Self {
        let mut strays = Vec::new();
        for key in entries.keys().filter(|key| !allowed.contains(&key.get_ref().as_ref())) {
            let stray = Stray::new(key.get_ref(), allowed);
            log.push(stray.explain(key.get_ref(), key.span(), &place, allowed));
            strays.push(stray);
        }
        Self { place, span, entries, strays }
    }

    /// What messages call the table.
    pub(super) fn place(&self) -> &str {
        &self.place
    }

    /// The place of the table's header.
    pub(super) fn span(&self) -> Range<usize> {
        self.span.clone()
    }

    /// Whether `key` is there under another spelling, so that its absence has been
    /// reported already.
    pub(super) fn mistyped(&self, key: &str) -> bool {
        self.strays.iter().any(|stray| matches!(stray, Stray::Mistyped(meant) if *meant == key))
    }

    /// Whether the table asks for something that candor does not simulate.
    pub(super) fn asks_for_effect(&self) -> bool {
        self.strays.iter().any(|stray| matches!(stray, Stray::Effect(_)))
    }

    /// The entry `key`; `None`, without a message, if the table does not have it.
    pub(super) fn optional(&self, key: &str) -> Option<Field<'a>> {
        let (key, value) = self.entries.get_key_value(key)?;
        Some(Field { key: key.get_ref(), key_span: key.span(), value })
    }

    /// The entry `key`, which the table must have; `what` it is, for the message.
    pub(super) fn required(&self, key: &str, what: &str, log: &mut Log) -> Option<Field<'a>> {
        let field = self.optional(key);
        if field.is_none() && !self.mistyped(key) {
            log.push(
                Diagnostic::new(self.span(), format!("{} has no `{key}`", self.place))
                    .note(format!("`{key}` is {what}")),
            );
        }
        field
    }
}

/// A key and its value.
pub(super) struct Field<'a> {
    key: &'a str,
    key_span: Range<usize>,
    value: &'a Spanned<DeValue<'a>>,
}

impl<'a> Field<'a> {
    /// The key itself.
    pub(super) fn key(&self) -> &'a str {
        self.key
    }

    /// The place of the key.
    pub(super) fn key_span(&self) -> Range<usize> {
        self.key_span.clone()
    }

    /// The value of any type.
    pub(super) fn value(&self) -> &'a Spanned<DeValue<'a>> {
        self.value
    }

    /// A number, whole or not. One too large for an `f64` becomes infinite.
    pub(super) fn number(&self, log: &mut Log) -> Option<f64> {
        let number = number(self.value.get_ref());
        if number.is_none() {
            log.push(self.wrong_type("a number"));
        }
        number
    }

    /// A whole number. What is negative or too large becomes [`u64::MAX`], which no
    /// key of a scene file allows.
    pub(super) fn whole(&self, log: &mut Log) -> Option<u64> {
        if let DeValue::Integer(n) = self.value.get_ref() {
            return Some(integer(n).and_then(|n| u64::try_from(n).ok()).unwrap_or(u64::MAX));
        }
        let wrong = self.wrong_type("a whole number");
        log.push(match self.value.get_ref() {
            DeValue::Float(_) => wrong.note("write it without a decimal point or an exponent"),
            _ => wrong,
        });
        None
    }

    /// A list of three numbers.
    pub(super) fn vector(&self, log: &mut Log) -> Option<DVec3> {
        const EXPECTED: &str = "a list of three numbers";
        let Some(items) = self.value.get_ref().as_array() else {
            log.push(self.wrong_type(EXPECTED));
            return None;
        };
        if items.len() != 3 {
            let has = format!("this list has {}", count(items));
            log.push(self.wrong(EXPECTED).label(has));
            return None;
        }
        let numbers = items.iter().filter_map(|item| {
            let number = number(item.get_ref());
            if number.is_none() {
                let wrong = Diagnostic::new(item.span(), self.must_be(EXPECTED));
                log.push(wrong.label(found(item.get_ref())));
            }
            number
        });
        let numbers: Vec<f64> = numbers.collect();
        numbers.try_into().ok().map(DVec3::from_array)
    }

    /// Text in quotes.
    pub(super) fn text(&self, log: &mut Log) -> Option<&'a str> {
        let text = self.value.get_ref().as_str();
        if text.is_none() {
            log.push(self.wrong_type("text in quotes"));
        }
        text
    }

    /// The value that a constructor made of this entry, or a message with what it
    /// allows.
    pub(super) fn accept<T>(&self, made: Result<T, Invalid>, log: &mut Log) -> Option<T> {
        made.map_err(|Invalid(allowed)| log.push(self.wrong(&allowed))).ok()
    }

    /// A message that the value must be something else, at the value.
    pub(super) fn wrong(&self, expected: &str) -> Diagnostic {
        Diagnostic::new(self.value.span(), self.must_be(expected))
    }

    /// The same, saying what type of value was found.
    pub(super) fn wrong_type(&self, expected: &str) -> Diagnostic {
        self.wrong(expected).label(found(self.value.get_ref()))
    }

    fn must_be(&self, expected: &str) -> String {
        format!("`{}` must be {expected}", self.key)
    }
}

/// A float as it is, and an integer where a number is expected.
fn number(value: &DeValue<'_>) -> Option<f64> {
    match value {
        DeValue::Float(float) => float.as_str().parse().ok(),
        #[expect(clippy::cast_precision_loss, reason = "rounds to nearest, as decimal text does")]
        DeValue::Integer(n) => Some(integer(n).map_or(f64::INFINITY, |n| n as f64)),
        _ => None,
    }
}

/// `None` if there are more digits than any key allows.
fn integer(n: &DeInteger<'_>) -> Option<i128> {
    i128::from_str_radix(n.as_str(), n.radix()).ok()
}

/// What the user wrote, for a label.
pub(super) fn found(value: &DeValue<'_>) -> String {
    let what = match value {
        DeValue::String(_) => "text",
        DeValue::Integer(_) => "a whole number",
        DeValue::Float(_) => "a decimal number",
        DeValue::Boolean(_) => "true or false",
        DeValue::Datetime(_) => "a date or time",
        DeValue::Array(_) => "a list",
        DeValue::Table(_) => "a table",
    };
    format!("this is {what}")
}

fn count(items: &DeArray<'_>) -> String {
    match items.len() {
        0 => "no entries".to_owned(),
        1 => "one entry".to_owned(),
        n => format!("{n} entries"),
    }
}
