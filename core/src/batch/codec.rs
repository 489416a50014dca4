//! Players as bytes: field by field, little-endian, NaN canonical, padding lanes left out.

use super::stage::Body;
use crate::arms::{self, Arms};
use crate::player::{Describe, Field, FieldVisitor, Player, fields, visit};
use crate::real::Scalar;
use crate::scene::{Group, Scene};
use crate::terrain::Maps;
use glam::{DVec3, IVec2};

struct Writer<'a>(&'a mut Vec<u8>);

impl<T: Scalar> FieldVisitor<T> for Writer<'_> {
    fn reals(&mut self, _name: &'static str, values: &mut [T]) {
        for &mut x in values {
            if T::DOUBLE {
                let x = x.to_f64();
                let x = if x.is_nan() { f64::NAN } else { x };
                self.0.extend(x.to_le_bytes());
            } else {
                let x = x.to_f64() as f32;
                let x = if x.is_nan() { f32::NAN } else { x };
                self.0.extend(x.to_le_bytes());
            }
        }
    }
    fn int(&mut self, _name: &'static str, value: &mut i32) {
        self.0.extend(value.to_le_bytes());
    }
    fn flag(&mut self, _name: &'static str, value: &mut bool) {
        self.0.push(u8::from(*value));
    }
}

struct Reader<'a>(&'a [u8]);

impl Reader<'_> {
    fn take<const N: usize>(&mut self) -> [u8; N] {
        let (head, rest) = self.0.split_first_chunk::<N>().expect("the caller checked the length");
        self.0 = rest;
        *head
    }
}

impl<T: Scalar> FieldVisitor<T> for Reader<'_> {
    fn reals(&mut self, _name: &'static str, values: &mut [T]) {
        for x in values {
            *x = if T::DOUBLE {
                T::from_f64(f64::from_le_bytes(self.take()))
            } else {
                T::from_f64(f64::from(f32::from_le_bytes(self.take())))
            };
        }
    }
    fn int(&mut self, _name: &'static str, value: &mut i32) {
        *value = i32::from_le_bytes(self.take());
    }
    fn flag(&mut self, _name: &'static str, value: &mut bool) {
        *value = self.take::<1>()[0] != 0;
    }
}

/// Appends a player's fields; see [`visit`] for `place`.
pub(super) fn write_player<S: Scene, T: Scalar>(p: &Player<S, T>, place: bool, out: &mut Vec<u8>) {
    visit(&mut p.clone(), &mut Writer(out), place);
}

/// World position of a player, m.
pub(super) fn place<S: Scene, T: Scalar>(maps: &Maps, p: &Player<S, T>) -> DVec3 {
    let local = DVec3::new(p.position.x.to_f64(), p.position.y.to_f64(), p.position.z.to_f64());
    maps.to_world(local, IVec2::new(p.tile_x, p.tile_y))
}

/// Appends a player's world position: three f64.
pub(super) fn write_place<S: Scene, T: Scalar>(maps: &Maps, p: &Player<S, T>, out: &mut Vec<u8>) {
    place(maps, p).to_array().iter().for_each(|x| out.extend(x.to_le_bytes()));
}

/// The fields of a body: with `whole` everything, as in a snapshot; else the public state without the
/// world position.
pub(super) fn body_fields<S: Scene, T: Scalar>(whole: bool) -> Vec<Field> {
    let mut all = Describe(fields::<S, T>(whole));
    walk_arms::<T>(&mut S::Arms::<T>::new(Arms::empty()), &mut all, whole);
    all.0
}

/// Appends a body's fields; see [`body_fields`].
pub(super) fn write_body<S: Scene, T: Scalar>(body: &Body<S, T>, whole: bool, out: &mut Vec<u8>) {
    write_player(&body.player, whole, out);
    walk_arms::<T>(&mut body.arms.clone(), &mut Writer(out), whole);
}

/// Reads a body's fields over `body`.
///
/// # Panics
/// If there are too few bytes: callers check.
pub(super) fn read_body<S: Scene, T: Scalar>(body: &mut Body<S, T>, whole: bool, bytes: &[u8]) {
    let mut reader = Reader(bytes);
    visit(&mut body.player, &mut reader, whole);
    walk_arms::<T>(&mut body.arms, &mut reader, whole);
}

fn walk_arms<T: Scalar>(group: &mut impl Group<Arms<T>>, v: &mut impl FieldVisitor<T>, whole: bool) {
    match group.as_mut() {
        Some(arms) if whole => arms::visit(arms, v),
        Some(arms) => arms::visit_launcher(arms, v),
        None => {}
    }
}
