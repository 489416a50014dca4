//! Scenes: each lists what it models, and what it leaves out is neither stored nor computed.
//!
//! A scene is a zero-sized type. An optional group of a player's fields is an associated type that
//! is [`Has`] of the group or [`Absent`]; the kernel asks [`Group::MODELED`], a constant, so the
//! code of an absent feature is not compiled into the scene's kernel.

use crate::real::Real;
use core::fmt::Debug;

/// An optional group of fields.
pub trait Group<V: Copy>: Copy + Debug + Send + Sync + 'static {
    /// Whether the scene models it.
    const MODELED: bool;
    /// The group at its start value.
    fn new(value: V) -> Self;
    /// The value, or `absent` where the scene does not model it.
    fn get(&self, absent: V) -> V;
    /// Overwrites the value; nothing where the scene does not model it.
    fn set(&mut self, value: V);
    /// The value in place, for groups too large to be copied about; none where the scene does not
    /// model it.
    fn as_mut(&mut self) -> Option<&mut V>;
    /// The value in place, to read.
    fn as_ref(&self) -> Option<&V>;
}

/// A group that the scene models.
#[derive(Clone, Copy, Debug)]
pub struct Has<V>(pub V);

/// A group that the scene leaves out: no bytes.
#[derive(Clone, Copy, Debug)]
pub struct Absent;

impl<V: Copy + Debug + Send + Sync + 'static> Group<V> for Has<V> {
    const MODELED: bool = true;
    #[inline(always)]
    fn new(value: V) -> Self {
        Self(value)
    }
    #[inline(always)]
    fn get(&self, _absent: V) -> V {
        self.0
    }
    #[inline(always)]
    fn set(&mut self, value: V) {
        self.0 = value;
    }
    #[inline(always)]
    fn as_mut(&mut self) -> Option<&mut V> {
        Some(&mut self.0)
    }
    #[inline(always)]
    fn as_ref(&self) -> Option<&V> {
        Some(&self.0)
    }
}

impl<V: Copy> Group<V> for Absent {
    const MODELED: bool = false;
    #[inline(always)]
    fn new(_value: V) -> Self {
        Self
    }
    #[inline(always)]
    fn get(&self, absent: V) -> V {
        absent
    }
    #[inline(always)]
    fn set(&mut self, _value: V) {}
    #[inline(always)]
    fn as_mut(&mut self) -> Option<&mut V> {
        None
    }
    #[inline(always)]
    fn as_ref(&self) -> Option<&V> {
        None
    }
}

/// Every feature that a scene may model. `flags` belong to tasks; no scene has them yet.
pub const FEATURES: [&str; 9] =
    ["jump", "jet", "energy", "landing_damage", "discs", "blast", "solids", "flags", "bump_limits"];

/// A scene by name, and its lists.
#[derive(Clone, Debug)]
pub struct Listed {
    /// The public name.
    pub name: &'static str,
    /// See [`Scene::models`].
    pub models: Vec<&'static str>,
    /// See [`Scene::leaves_out`].
    pub leaves_out: Vec<&'static str>,
}

/// Every scene.
#[must_use]
pub fn scenes() -> [Listed; 4] {
    fn listed<S: Scene>() -> Listed {
        Listed { name: S::NAME, models: S::models(), leaves_out: S::leaves_out() }
    }
    [listed::<Ski>(), listed::<Sandbox>(), listed::<DiscJump>(), listed::<Mission>()]
}

/// The list of what a scene models.
pub trait Scene: Copy + Debug + Send + Sync + 'static {
    /// The public name.
    const NAME: &'static str;
    /// Whether the jump key does anything.
    const JUMP: bool;
    /// Memory of the last jumpable contact: needed by jumps and by jets.
    type Contact<R: Real>: Group<crate::player::Contact<R>>;
    /// Whether the jets burn.
    type Jet<R: Real>: Group<R::Mask>;
    /// Jet energy. A scene with jets and without energy burns them for ever.
    type Energy<R: Real>: Group<R>;
    /// Damage taken by landings.
    type Damage<R: Real>: Group<R>;
    /// Count of the ticks that ended at the bump limit, for those who measure the movement.
    type BumpLimits<R: Real>: Group<R::Int>;
    /// A launcher and its projectiles. They lie beside the player, in the same block.
    type Arms<R: Real>: Group<crate::arms::Arms<R>>;
    /// Whether explosions push and hurt.
    const BLAST: bool;
    /// Whether solids stand in the way.
    const SOLIDS: bool;

    /// The features that the scene models.
    #[must_use]
    fn models() -> Vec<&'static str> {
        [
            (Self::JUMP, "jump"),
            (Self::Jet::<f32>::MODELED, "jet"),
            (Self::Energy::<f32>::MODELED, "energy"),
            (Self::Damage::<f32>::MODELED, "landing_damage"),
            (Self::Arms::<f32>::MODELED, "discs"),
            (Self::BLAST, "blast"),
            (Self::SOLIDS, "solids"),
            (Self::BumpLimits::<f32>::MODELED, "bump_limits"),
        ]
        .into_iter()
        .filter_map(|(modeled, name)| modeled.then_some(name))
        .collect()
    }

    /// The features that it leaves out: not stored, not computed, not observed.
    #[must_use]
    fn leaves_out() -> Vec<&'static str> {
        let models = Self::models();
        FEATURES.into_iter().filter(|feature| !models.contains(feature)).collect()
    }
}

/// Skiing over bare terrain: jump, jets with energy, landing damage.
#[derive(Clone, Copy, Debug)]
pub struct Ski;

impl Scene for Ski {
    const NAME: &'static str = "ski";
    const JUMP: bool = true;
    type Contact<R: Real> = Has<crate::player::Contact<R>>;
    type Jet<R: Real> = Has<R::Mask>;
    type Energy<R: Real> = Has<R>;
    type Damage<R: Real> = Has<R>;
    type BumpLimits<R: Real> = Absent;
    type Arms<R: Real> = Absent;
    const BLAST: bool = false;
    const SOLIDS: bool = false;
}

/// Physics tests and notebooks: everything that moves a player on bare terrain, and no task.
#[derive(Clone, Copy, Debug)]
pub struct Sandbox;

impl Scene for Sandbox {
    const NAME: &'static str = "sandbox";
    const JUMP: bool = true;
    type Contact<R: Real> = Has<crate::player::Contact<R>>;
    type Jet<R: Real> = Has<R::Mask>;
    type Energy<R: Real> = Has<R>;
    type Damage<R: Real> = Has<R>;
    type BumpLimits<R: Real> = Has<R::Int>;
    type Arms<R: Real> = Absent;
    const BLAST: bool = true;
    const SOLIDS: bool = false;
}

/// Disc jumping over bare terrain: everything that moves a player, and his launcher.
#[derive(Clone, Copy, Debug)]
pub struct DiscJump;

impl Scene for DiscJump {
    const NAME: &'static str = "disc_jump";
    const JUMP: bool = true;
    type Contact<R: Real> = Has<crate::player::Contact<R>>;
    type Jet<R: Real> = Has<R::Mask>;
    type Energy<R: Real> = Has<R>;
    type Damage<R: Real> = Has<R>;
    type BumpLimits<R: Real> = Has<R::Int>;
    type Arms<R: Real> = Has<crate::arms::Arms<R>>;
    const BLAST: bool = true;
    const SOLIDS: bool = false;
}

/// The whole game's movement: as [`DiscJump`], with solids.
#[derive(Clone, Copy, Debug)]
pub struct Mission;

impl Scene for Mission {
    const NAME: &'static str = "mission";
    const JUMP: bool = true;
    type Contact<R: Real> = Has<crate::player::Contact<R>>;
    type Jet<R: Real> = Has<R::Mask>;
    type Energy<R: Real> = Has<R>;
    type Damage<R: Real> = Has<R>;
    type BumpLimits<R: Real> = Has<R::Int>;
    type Arms<R: Real> = Has<crate::arms::Arms<R>>;
    const BLAST: bool = true;
    const SOLIDS: bool = true;
}
