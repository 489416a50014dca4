//! How the ground fills a square between its four heights.

use crate::error::InputError;

/// The surface between the vertices of a heightfield (docs/physics.md, section 8).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SurfaceKind {
    /// Two triangles a square, cut in a checkerboard: the game's.
    #[default]
    Triangles,
    /// The bilinear interpolation of the four corners: no cut, and no jump of the slope within a square.
    Bilinear,
}

impl SurfaceKind {
    /// Its public name.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Triangles => "triangles",
            Self::Bilinear => "bilinear",
        }
    }
}

impl core::str::FromStr for SurfaceKind {
    type Err = InputError;
    fn from_str(name: &str) -> Result<Self, InputError> {
        match name {
            "triangles" => Ok(Self::Triangles),
            "bilinear" => Ok(Self::Bilinear),
            _ => Err(InputError(format!("surface: expected \"triangles\" or \"bilinear\", got {name:?}"))),
        }
    }
}
