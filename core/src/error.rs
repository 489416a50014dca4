//! The one error of this crate: input that is refused.

use core::fmt;

/// Why input is refused: names the argument, what was expected and what came. Nothing was changed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct InputError(pub String);

impl fmt::Display for InputError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl core::error::Error for InputError {}

/// `Err(InputError(format!(...)))`.
macro_rules! refuse {
    ($($arg:tt)*) => {
        return Err($crate::error::InputError(format!($($arg)*)))
    };
}
pub(crate) use refuse;

impl InputError {
    /// The same of what it is a field of: `velocity: ...` becomes `state[3].velocity: ...`.
    #[must_use]
    pub(crate) fn of(self, what: impl core::fmt::Display) -> Self {
        Self(format!("{what}.{self}"))
    }
}
