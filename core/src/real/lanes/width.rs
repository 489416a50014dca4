//! How many players are stepped side by side on this processor.

use crate::error::{InputError, refuse};

/// A lane width that this processor has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Width {
    /// Plain scalars.
    One,
    /// [`super::F32x8`].
    #[cfg(target_arch = "x86_64")]
    Eight,
    /// [`super::F32x16`].
    #[cfg(target_arch = "x86_64")]
    Sixteen,
    /// [`super::Two`] registers of [`super::F32x16`].
    #[cfg(target_arch = "x86_64")]
    ThirtyTwo,
}

/// The environment variable that stands for an absent `lanes`.
const VARIABLE: &str = "DISCJUMP_LANES";

/// Players from which on two registers side by side gain time: fewer leave too many of their lanes idle.
#[cfg(target_arch = "x86_64")]
const WORTH_TWO: usize = 1024;

impl Width {
    /// Widest first.
    #[cfg(target_arch = "x86_64")]
    const ALL: [Self; 4] = [Self::ThirtyTwo, Self::Sixteen, Self::Eight, Self::One];
    /// No lanes but on x86-64.
    #[cfg(not(target_arch = "x86_64"))]
    const ALL: [Self; 1] = [Self::One];

    /// Players side by side.
    pub(crate) fn lanes(self) -> usize {
        match self {
            Self::One => 1,
            #[cfg(target_arch = "x86_64")]
            Self::Eight => 8,
            #[cfg(target_arch = "x86_64")]
            Self::Sixteen => 16,
            #[cfg(target_arch = "x86_64")]
            Self::ThirtyTwo => 32,
        }
    }

    fn supported(self) -> bool {
        match self {
            Self::One => true,
            #[cfg(target_arch = "x86_64")]
            Self::Eight => is_x86_feature_detected!("avx2"),
            #[cfg(target_arch = "x86_64")]
            Self::Sixteen | Self::ThirtyTwo => {
                is_x86_feature_detected!("avx512f")
                    && is_x86_feature_detected!("avx512vl")
                    && is_x86_feature_detected!("avx512dq")
                    && is_x86_feature_detected!("avx512bw")
            }
        }
    }

    /// Whether so many players are worth the width, measured.
    fn fits(self, players: usize) -> bool {
        match self {
            #[cfg(target_arch = "x86_64")]
            Self::ThirtyTwo => players >= WORTH_TWO,
            _ => self.lanes() <= 2 * players,
        }
    }

    /// All that this processor has, widest first.
    pub(crate) fn available() -> impl Iterator<Item = Self> {
        Self::ALL.into_iter().filter(|width| width.supported())
    }
}

/// The width asked for, else the one that the environment variable names, else the widest that the
/// processor has and so many players are worth. The choice never changes a bit of the results.
///
/// Two registers of 8 are no choice: by their number nobody could tell them from one of 16.
///
/// # Errors
/// If it is not 1, 8, 16 or 32, or the processor lacks the instructions.
pub(crate) fn lane_width(asked: Option<usize>, players: usize) -> Result<Width, InputError> {
    let (argument, lanes) = match (asked, std::env::var_os(VARIABLE)) {
        (Some(lanes), _) => ("lanes", lanes.to_string()),
        (None, Some(value)) => (VARIABLE, value.to_string_lossy().into_owned()),
        (None, None) => {
            let fitting = Width::available().find(|width| width.fits(players));
            return Ok(fitting.unwrap_or(Width::One));
        }
    };
    let known = Width::available().map(|width| width.lanes().to_string());
    match Width::available().find(|width| width.lanes().to_string() == lanes) {
        Some(width) => Ok(width),
        None => refuse!(
            "{argument}: expected one of {}, the widths this processor has, got {lanes}",
            known.collect::<Vec<_>>().join(", ")
        ),
    }
}
