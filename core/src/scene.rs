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

/// The public names, those of scenes included that this build leaves out: each is its cargo feature as well.
pub const NAMES: [&str; 4] = ["ski", "sandbox", "disc_jump", "mission"];

/// Every scene of this build.
#[must_use]
pub fn scenes() -> Vec<Listed> {
    fn listed<S: Scene>() -> Listed {
        Listed { name: S::NAME, models: S::models(), leaves_out: S::leaves_out() }
    }
    vec![
        #[cfg(feature = "ski")]
        listed::<Ski>(),
        #[cfg(feature = "sandbox")]
        listed::<Sandbox>(),
        #[cfg(feature = "disc_jump")]
        listed::<DiscJump>(),
        #[cfg(feature = "mission")]
        listed::<Mission>(),
    ]
}

/// That a feature is in the build if a scene models it.
macro_rules! built {
    ($modeled:expr, $feature:literal) => {
        assert!(
            cfg!(feature = $feature) || !$modeled,
            concat!("the scene models ", $feature, ", and the cargo feature of that name is off")
        )
    };
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

    /// Does not compile where the scene models what this build leaves out.
    const BUILT: () = {
        built!(Self::JUMP, "jump");
        built!(Self::Jet::<f32>::MODELED, "jet");
        built!(Self::Energy::<f32>::MODELED, "energy");
        built!(Self::Damage::<f32>::MODELED, "landing_damage");
        built!(Self::Arms::<f32>::MODELED, "discs");
        built!(Self::BLAST, "blast");
        built!(Self::SOLIDS, "solids");
        built!(Self::BumpLimits::<f32>::MODELED, "bump_limits");
    };

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

/// The type of a group: [`Has`] of its fields, or [`Absent`].
macro_rules! group {
    (has, $fields:ty) => { Has<$fields> };
    (no, $fields:ty) => { Absent };
}

/// A constant of a feature without fields.
macro_rules! modeled {
    (has) => {
        true
    };
    (no) => {
        false
    };
}

/// Turns a row of features into a [`Scene`].
macro_rules! scene {
    ($(#[$doc:meta])* $scene:ident = $name:literal {
        jump: $jump:tt, contact: $contact:tt, jet: $jet:tt, energy: $energy:tt, landing_damage: $damage:tt,
        discs: $discs:tt, blast: $blast:tt, solids: $solids:tt, bump_limits: $limits:tt
    }) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug)]
        pub struct $scene;

        impl Scene for $scene {
            const NAME: &'static str = $name;
            const JUMP: bool = modeled!($jump);
            type Contact<R: Real> = group!($contact, crate::player::Contact<R>);
            type Jet<R: Real> = group!($jet, R::Mask);
            type Energy<R: Real> = group!($energy, R);
            type Damage<R: Real> = group!($damage, R);
            type Arms<R: Real> = group!($discs, crate::arms::Arms<R>);
            type BumpLimits<R: Real> = group!($limits, R::Int);
            const BLAST: bool = modeled!($blast);
            const SOLIDS: bool = modeled!($solids);
        }
    };
}

#[cfg(feature = "ski")]
scene! {
    /// Skiing over bare terrain.
    Ski = "ski" {
        jump: has, contact: has, jet: has, energy: has, landing_damage: has,
        discs: no, blast: no, solids: no, bump_limits: no
    }
}

#[cfg(feature = "sandbox")]
scene! {
    /// Physics tests and notebooks: everything that moves a player on bare terrain, and no task.
    Sandbox = "sandbox" {
        jump: has, contact: has, jet: has, energy: has, landing_damage: has,
        discs: no, blast: has, solids: no, bump_limits: has
    }
}

#[cfg(feature = "disc_jump")]
scene! {
    /// Disc jumping over bare terrain: everything that moves a player, and his launcher.
    DiscJump = "disc_jump" {
        jump: has, contact: has, jet: has, energy: has, landing_damage: has,
        discs: has, blast: has, solids: no, bump_limits: has
    }
}

#[cfg(feature = "mission")]
scene! {
    /// The whole game's movement: as [`DiscJump`], with solids.
    Mission = "mission" {
        jump: has, contact: has, jet: has, energy: has, landing_damage: has,
        discs: has, blast: has, solids: has, bump_limits: has
    }
}
