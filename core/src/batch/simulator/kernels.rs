//! Which kernel plays a simulator: by scene, tier, precision and lanes.

use super::Bodies;
use super::setup::SimulatorSetup;
use crate::error::{InputError, refuse};
use crate::movement::{Anyway, Engine, Fast, Movement, Sliced, Swept};
#[cfg(target_arch = "x86_64")]
use crate::real::lanes::{F32x8, F32x16, Two};
use crate::real::lanes::{Width, lane_width};
#[cfg(feature = "disc_jump")]
use crate::scene::DiscJump;
#[cfg(feature = "mission")]
use crate::scene::Mission;
#[cfg(feature = "sandbox")]
use crate::scene::Sandbox;
#[cfg(feature = "ski")]
use crate::scene::Ski;
use crate::scene::{NAMES, Scene, scenes};

/// The tier that is float64 by itself.
pub(super) const REFERENCE: &str = "reference";

impl SimulatorSetup<'_> {
    /// Builds the simulator: every player fresh, at the map's centre, on the ground; where several
    /// share a world, in a row eastwards, 4 m apart.
    ///
    /// # Errors
    /// Names the argument that is out of range or unknown, with what was expected.
    pub fn build(&self) -> Result<Box<dyn Bodies>, InputError> {
        match self.scene {
            #[cfg(feature = "ski")]
            "ski" => self.ski(),
            #[cfg(feature = "sandbox")]
            "sandbox" => self.tier::<Sandbox>(),
            #[cfg(feature = "disc_jump")]
            "disc_jump" => self.tier::<DiscJump>(),
            #[cfg(feature = "mission")]
            "mission" => self.tier::<Mission>(),
            left_out if NAMES.contains(&left_out) => refuse!(
                "scene: expected one of this build, which leaves {left_out:?} out: it needs the cargo feature \
                 {left_out:?} of discjump-core"
            ),
            other => {
                let names: Vec<_> = scenes().iter().map(|scene| format!("{:?}", scene.name)).collect();
                refuse!("scene: expected one of {}, got {other:?}", names.join(", "))
            }
        }
    }

    /// Builds the simulator of a scene of one's own in float32 with so many lanes, as [`SimulatorSetup::build`] does;
    /// scene, tier and lanes of the setup are not asked for, only named in snapshots.
    ///
    /// # Errors
    /// Names the argument that is out of range or unknown, with what was expected; lanes are 1, and 8 or 16
    /// where the processor has them.
    pub fn build_own<S: Scene, M: Movement, const LANES: usize>(
        &self,
    ) -> Result<Box<dyn Bodies>, InputError> {
        lane_width(Some(LANES), self.players)?;
        match LANES {
            1 => self.kernel::<S, M, f32>(),
            #[cfg(target_arch = "x86_64")]
            8 => self.kernel::<S, M, F32x8>(),
            #[cfg(target_arch = "x86_64")]
            16 => self.kernel::<S, M, F32x16>(),
            other => refuse!("lanes: expected 1, 8 or 16 for a scene of one's own, got {other}"),
        }
    }

    /// The one scene with a tier that has two registers.
    #[cfg(feature = "ski")]
    fn ski(&self) -> Result<Box<dyn Bodies>, InputError> {
        #[cfg(target_arch = "x86_64")]
        if self.fidelity == "authentic" && !self.double()? && self.width()? == Width::ThirtyTwo {
            return self.kernel::<Ski, Sliced, Two<F32x16>>();
        }
        self.tier::<Ski>()
    }

    fn tier<S: Scene>(&self) -> Result<Box<dyn Bodies>, InputError> {
        let double = self.double()?;
        match self.fidelity {
            REFERENCE => self.kernel::<S, Sliced, f64>(),
            "authentic" if double => self.kernel::<S, Sliced, f64>(),
            "authentic" => self.side_by_side::<S, Sliced>(),
            "swept" if double => self.kernel::<S, Swept, f64>(),
            "swept" => self.side_by_side::<S, Swept>(),
            "fast" if double => self.kernel::<S, Fast, f64>(),
            "fast" => self.side_by_side::<S, Fast>(),
            "engine" if double => self.kernel::<S, Engine, f64>(),
            "engine" => self.kernel::<S, Engine, f32>(),
            "anyway" if double => self.kernel::<S, Anyway, f64>(),
            "anyway" => self.kernel::<S, Anyway, f32>(),
            other => refuse!(
                "fidelity: expected \"reference\", \"authentic\", \"swept\", \"fast\", \"engine\" or \"anyway\", \
                 got {other:?}"
            ),
        }
    }

    /// Whether it computes in float64.
    fn double(&self) -> Result<bool, InputError> {
        match (self.fidelity, self.precision) {
            (REFERENCE, Some("float32")) => {
                refuse!(
                    "precision: expected \"float64\" with fidelity \"reference\", which is \"authentic\" in float64, \
                     got \"float32\""
                )
            }
            (fidelity, None) => Ok(fidelity == REFERENCE),
            (_, Some("float32")) => Ok(false),
            (_, Some("float64")) => Ok(true),
            (_, Some(other)) => refuse!("precision: expected \"float32\" or \"float64\", got {other:?}"),
        }
    }

    /// How many players a tier that has lanes steps side by side.
    fn width(&self) -> Result<Width, InputError> {
        if self.players_per_world > 1 {
            return Ok(Width::One);
        }
        lane_width(self.lanes, self.players)
    }

    /// The kernel of a tier that has lanes.
    fn side_by_side<S: Scene, M: Movement>(&self) -> Result<Box<dyn Bodies>, InputError> {
        match self.width()? {
            Width::One => self.kernel::<S, M, f32>(),
            #[cfg(target_arch = "x86_64")]
            Width::Eight => self.kernel::<S, M, F32x8>(),
            #[cfg(target_arch = "x86_64")]
            Width::Sixteen | Width::ThirtyTwo => self.kernel::<S, M, F32x16>(),
        }
    }
}
