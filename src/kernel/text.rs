//! The text of a kernel while it grows.

use std::borrow::Cow;

/// A file of `shaders/`.
macro_rules! fragment {
    ($name:literal) => {
        include_str!(concat!("../../shaders/", $name, ".wgsl"))
    };
}

pub(super) use fragment;

/// Fragments one after the other.
#[derive(Debug, Default)]
pub(super) struct Text(Vec<Cow<'static, str>>);

impl Text {
    pub(super) fn add(&mut self, fragment: &'static str) -> &mut Self {
        self.0.push(Cow::Borrowed(fragment));
        self
    }

    pub(super) fn push(&mut self, text: String) {
        self.0.push(Cow::Owned(text));
    }

    pub(super) fn into_wgsl(self) -> String {
        self.0.join("\n")
    }
}
