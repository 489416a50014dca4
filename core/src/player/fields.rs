//! The list of a player's fields, once: snapshots, digests and structured arrays walk it.

use super::{Contact, Player};
use crate::real::{Int, Scalar, V3};
use crate::rules::{Model, Rules};
use crate::scene::{Group, Scene};

/// How a field is stored, little-endian.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FieldKind {
    /// 4 or 8 bytes, by tier.
    Real {
        /// Whether it is 8 bytes.
        double: bool,
    },
    /// 4 bytes, signed.
    Int,
    /// One byte, 0 or 1.
    Flag,
}

impl FieldKind {
    /// Bytes of one element.
    #[must_use]
    pub fn bytes(self) -> usize {
        match self {
            Self::Real { double: true } => 8,
            Self::Real { double: false } | Self::Int => 4,
            Self::Flag => 1,
        }
    }

    /// numpy's code for it, packed and little-endian.
    #[must_use]
    pub fn numpy_code(self) -> &'static str {
        match self {
            Self::Real { double: true } => "<f8",
            Self::Real { double: false } => "<f4",
            Self::Int => "<i4",
            Self::Flag => "?",
        }
    }
}

/// One field of a player.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Field {
    /// Its public name.
    pub name: &'static str,
    /// Its type.
    pub kind: FieldKind,
    /// 1, or 3 for a vector.
    pub count: usize,
}

/// Receives every field in order, and may change it.
pub trait FieldVisitor<T: Scalar> {
    /// One or three reals.
    fn reals(&mut self, name: &'static str, values: &mut [T]);
    /// An integer.
    fn int(&mut self, name: &'static str, value: &mut i32);
    /// A flag.
    fn flag(&mut self, name: &'static str, value: &mut bool);
}

/// Shows a vector to a visitor.
pub fn visit_vector<T: Scalar>(v: &mut impl FieldVisitor<T>, name: &'static str, x: &mut V3<T>) {
    let mut a = [x.x, x.y, x.z];
    v.reals(name, &mut a);
    [x.x, x.y, x.z] = a;
}

fn real<T: Scalar>(v: &mut impl FieldVisitor<T>, name: &'static str, x: &mut T) {
    v.reals(name, core::slice::from_mut(x));
}

/// Walks a player's fields. `place` is where he is (local position, tile, map): callers that give
/// positions another form leave it out.
pub fn visit<S: Scene, T: Scalar>(p: &mut Player<S, T>, v: &mut impl FieldVisitor<T>, place: bool) {
    if place {
        visit_vector(v, "local_position", &mut p.position);
        v.int("tile_x", &mut p.tile_x);
        v.int("tile_y", &mut p.tile_y);
        v.int("map", &mut p.map);
    }
    visit_vector(v, "velocity", &mut p.velocity);
    real(v, "yaw", &mut p.yaw);
    real(v, "pitch", &mut p.pitch);
    if S::Energy::<T>::MODELED {
        let mut energy = p.energy.get(T::zero());
        real(v, "energy", &mut energy);
        p.energy.set(energy);
    }
    if S::Damage::<T>::MODELED {
        let mut damage = p.damage.get(T::zero());
        real(v, "damage", &mut damage);
        p.damage.set(damage);
    }
    if S::Jet::<T>::MODELED {
        let mut jetting = p.jetting.get(false);
        v.flag("jetting", &mut jetting);
        p.jetting.set(jetting);
    }
    v.flag("touched", &mut p.touched);
    v.flag("crawled", &mut p.crawled);
    real(v, "friction", &mut p.friction);
    if S::Contact::<T>::MODELED {
        let mut contact = p.contact.get(Contact { normal: V3::up(), age: Int::splat(0) });
        visit_vector(v, "jump_normal", &mut contact.normal);
        v.int("jump_age", &mut contact.age);
        p.contact.set(contact);
    }
    if S::BumpLimits::<T>::MODELED {
        let mut count = p.bump_limits.get(0);
        v.int("bump_limits", &mut count);
        p.bump_limits.set(count);
    }
}

/// Lists the fields that it visits.
#[derive(Debug, Default)]
pub struct Describe(pub Vec<Field>);

impl<T: Scalar> FieldVisitor<T> for Describe {
    fn reals(&mut self, name: &'static str, values: &mut [T]) {
        let kind = FieldKind::Real { double: T::DOUBLE };
        self.0.push(Field { name, kind, count: values.len() });
    }
    fn int(&mut self, name: &'static str, _value: &mut i32) {
        self.0.push(Field { name, kind: FieldKind::Int, count: 1 });
    }
    fn flag(&mut self, name: &'static str, _value: &mut bool) {
        self.0.push(Field { name, kind: FieldKind::Flag, count: 1 });
    }
}

/// The fields of a scene's players, in order; see [`visit`] for `place`.
#[must_use]
pub fn fields<S: Scene, T: Scalar>(place: bool) -> Vec<Field> {
    let rules =
        Rules::<T>::new(Model::Article, &crate::armor::LIGHT, false, 32, crate::rules::Physics::default());
    let mut describe = Describe::default();
    visit(&mut Player::<S, T>::new(&rules, V3::zero(), 0), &mut describe, place);
    describe.0
}

/// Bytes of one player's fields, packed.
#[must_use]
pub fn packed_bytes(fields: &[Field]) -> usize {
    fields.iter().map(|f| f.kind.bytes() * f.count).sum()
}
